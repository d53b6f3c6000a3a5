"""Rows of a batch for a page: plain columns that its scatter and its table are made of.

`page/scatter.js` and `page/table.js` draw them.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from ribbonopt.plain import Row, Rows
from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.text import printable
from ribbonopt.views.columns import (
    as_text,
    columns,
    is_logarithmic,
    is_missing,
    is_numeric,
    numbers,
    varied,
    words,
)

#: colours of statuses, as variables of the style sheet
GOOD, BAD = "--good", ("--bad", "--branch3", "--branch4", "--branch6", "--faint")
LONG = ("message", "note")  # not for axes
HIDDEN = ("path", "verified")  # in no table
MINOR = (  # not on paper, which has no room for them
    *("potential", "H0"),
    *(part for vector in START_VECTORS for part in vector),
    *("start", "note", "message"),
)

Data = dict[str, object]
"""Plain data, as JSON has them."""


def table_of(rows: Rows, inputs: Sequence[str], links: Mapping[int, str] | None = None) -> Data:
    """Return what `page/scatter.js` and `page/table.js` draw.

    Parameters
    ----------
    rows
        What came out, in order.
    inputs
        Columns that were swept.
    links
        Where something more lies, by the numbers of rows.

    Returns
    -------
    Data
        `names`, `numeric` (numbers and gaps only), `log` (better seen by powers), `axis` (may stand
        along one), `minor` for each column; `rows` (values by column, None for a gap; words as
        text) and `verified` for each row; `colours` by status; `inputs`; `links`; `x`, `y`, `c`,
        the columns shown first.
    """
    alike = {"scene"} if len(words(rows, "scene")) < 2 else set()
    names = [name for name in columns(rows, inputs) if name not in (*HIDDEN, *alike)]
    kinds = {name: is_numeric(rows, name) for name in names}
    x, y, shade = _first(rows, inputs, kinds)
    return {
        "names": names,
        "numeric": [kinds[name] for name in names],
        "log": [
            kinds[name] and name != "number" and is_logarithmic(numbers(rows, name))
            for name in names
        ],
        "axis": [name not in LONG for name in names],
        "minor": [name in MINOR for name in names],
        "rows": [[_plain(row, name, kinds[name]) for name in names] for row in rows],
        "verified": [bool(row["verified"]) for row in rows],
        "colours": status_colours(rows),
        "inputs": list(inputs),
        "links": {str(number): link for number, link in (links or {}).items()},
        "x": x,
        "y": y,
        "c": shade,
    }


def status_colours(rows: Rows) -> dict[str, str]:
    """Return the colours of statuses as variables, those that are good and frequent first.

    A status is good if all its rows are verified.
    """
    counts = Counter(str(row["status"]) for row in rows)
    failed = {str(row["status"]) for row in rows if not row["verified"]}
    statuses = sorted(counts, key=lambda status: (status in failed, -counts[status]))
    bad = [status for status in statuses if status in failed]
    colours = {status: BAD[i % len(BAD)] for i, status in enumerate(bad)}
    return {status: colours.get(status, GOOD) for status in statuses}


def _first(rows: Rows, inputs: Sequence[str], kinds: Mapping[str, bool]) -> tuple[str, str, str]:
    """Return the columns shown first along x and y, and as colour."""
    swept = [key for key in inputs if kinds.get(key) and varied(rows, key)]
    given = [key for key in inputs if len(words(rows, key)) > 1]
    x, *others = [*swept, *(key for key in given if key not in swept)] or ["number"]
    y = "energy" if kinds.get("energy") else (others or ["status"])[0]
    shades = [key for key in others if key != y] or ["status"]
    return x, y, shades[0]


def _plain(row: Row, name: str, numeric: bool) -> float | int | str | None:
    value = row.get(name)
    if is_missing(value) or value is None:
        return None
    return value if numeric else printable(as_text(value))
