"""Special points of the branches of a study: a list in each row, columns and a table of their own.

A row holds under SPECIALS what the branch recorded of each, in order, as `branch.csv` has it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ribbonopt.plain import SPECIALS, Row, Rows

POINTS = "points"  # how many points all its branches have
LISTED = 6  # special points that have columns in the table of rows
NAME = "special{}"
PARTS = ("", "_kind", "_error")  # the value, which kind it is, the bound of its relative error
BRANCH_COLUMNS = (
    POINTS,
    *(NAME.format(i) + part for i in range(1, LISTED + 1) for part in PARTS),
)


def with_columns(row: Row) -> Row:
    """Return a row with its first special points in columns of their own."""
    found = dict(row)
    for i, point in enumerate(row.get(SPECIALS, [])[:LISTED], start=1):
        values = point.get(point["parameter"]), point["kind"], point["error"]
        name = NAME.format(i)
        found |= {name + part: value for part, value in zip(PARTS, values, strict=True)}
    return found


def special_rows(rows: Rows, inputs: Sequence[str]) -> Iterator[Row]:
    """Yield a row for each special point: that of its branch behind the number and the inputs.

    The number of the point on its branch is `point`, that of the ribbon `number`.
    """
    for row in rows:
        given = {key: row.get(key) for key in ("number", "scene", *inputs)}
        for point in row.get(SPECIALS, []):
            recorded = {k: v for k, v in point.items() if k not in given}
            yield {**given, "point": point["number"], **recorded}
