"""Diagram of a branch for a page: columns to choose from, curves to draw, special points.

Plain data: `page/diagram.js` draws them. What a curve goes through and where it is cut is decided
here, as for the figures (`ribbonopt.views.branch_rows`).
"""

from __future__ import annotations

from collections import Counter

from ribbonopt.plain import Row
from ribbonopt.scene.quantities import ANSWERS
from ribbonopt.text import printable
from ribbonopt.views.branch_axes import COUNTS, LABELS, unit_of
from ribbonopt.views.branch_rows import KINK, VALUE, BranchFigure, Plane
from ribbonopt.views.branch_style import marks_of
from ribbonopt.views.columns import COSTS, columns, is_missing, is_numeric, varied
from ribbonopt.views.locus_style import locus_of

#: columns that say where a point belongs: nothing to draw
PLACES = ("stage", "branch", "origin")
DIGITS = 9  # of a number: more than can be seen or read
USUAL = ("u2", "energy", "H0", "u3")  # along y, the first that varies

Data = dict[str, object]
"""Plain data, as JSON has them."""


def diagram_of(figure: BranchFigure) -> Data:
    """Return what `page/diagram.js` draws.

    Parameters
    ----------
    figure
        Rows of a branch; its first pair, if it has one, is shown first.

    Returns
    -------
    Data
        `names`, `labels` (with units), `log`, `rough` (nothing is between points) and `columns`
        (values of all rows, None where there are none) for each column; `number`, `stage`,
        `branch`, `negative` (unstable directions, None unknown), `kind`, `locus` (what it is a
        point of, "" of a branch), `mark` ("" for none) and `note` for each row; `pieces`, each with
        `branch` and, as indices of rows, those it goes through (`rows`) and those that decide how
        it begins (`beyond`); `corners`, indices of rows
        where the direction may change at once; `moved`, by stage, the column of what it moves;
        `x`, `y`, the columns shown first.
    """
    rows = figure.rows
    names = _names(figure)
    # Every row has a number and its parameter: this plane leaves none out.
    plane = Plane(figure, (VALUE, "number"))
    places = {row["number"]: i for i, row in enumerate(rows)}
    marks = {row["number"]: name for name, own in marks_of(plane).items() for row in own}
    x, y = _first(figure, names)
    return {
        "names": names,
        "labels": [_label(name, figure.si) for name in names],
        "log": [name == "error" or name in figure.log for name in names],
        "rough": [name in (*COUNTS, "error") for name in names],
        "columns": [[_value(row, name) for row in rows] for name in names],
        **{key: [row[key] for row in rows] for key in ("number", "stage", "branch", "negative")},
        "kind": [row["kind"] for row in rows],
        "locus": [locus_of(row) for row in rows],
        "mark": [marks.get(row["number"], "") for row in rows],
        "note": [printable(row.get("note") or "") for row in rows],
        "pieces": [
            {
                "branch": piece.rows[-1]["branch"],
                "rows": [places[row["number"]] for row in piece.rows],
                "beyond": [places[row["number"]] for row in piece.beyond],
            }
            for piece in plane.pieces
        ],
        "corners": [i for i, row in enumerate(rows) if row["kind"] == KINK],
        "moved": {str(row["stage"]): names.index(row["parameter"]) for row in rows},
        "x": names.index(x) if x in names else 0,
        "y": names.index(y) if y in names else 0,
    }


def _names(figure: BranchFigure) -> list[str]:
    """Return the columns to choose from: parameters, what is recorded, answers, costs."""
    rows, parameters = figure.rows, figure.parameters
    asked = [name for pair in figure.pairs for name in pair if name != VALUE]
    found = [name for name in columns(rows) if name not in PLACES and is_numeric(rows, name)]
    last = ("error", "number", *COUNTS, *COSTS)
    own = [name for name in found if name not in (*ANSWERS, *last)]
    answers = [name for name in ANSWERS if name in found and varied(rows, name)]
    order = (*parameters, *own, *answers, *(name for name in last if name in found))
    return [name for name in dict.fromkeys((*order, *asked)) if name in found]


def _first(figure: BranchFigure, names: list[str]) -> tuple[str, str]:
    """Return the columns that are shown first."""
    moved = Counter(row["parameter"] for row in figure.rows).most_common(1)
    parameter = moved[0][0] if moved else ""
    if figure.pairs:
        x, y = (parameter if name == VALUE else name for name in figure.pairs[0])
        return x, y
    others = [name for name in names if name not in figure.parameters]
    chosen = [name for name in USUAL if name in others]
    return parameter, (chosen or others or [parameter])[0]


def _label(name: str, si: bool) -> str:
    unit = unit_of(name, si)
    return LABELS.get(name, printable(name)) + (f" ({unit})" if unit else "")


def _value(row: Row, name: str) -> float | int | None:
    value = row.get(name)
    if value is None or is_missing(value):
        return None
    return value if isinstance(value, int) else float(f"{value:.{DIGITS}g}")
