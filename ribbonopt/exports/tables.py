"""CSV for colleagues: rows along s, what acts and reacts, and what the columns are (JSON).

Names of columns are plain words, as pandas and pgfplots want them; units stand in the third file.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ribbonopt.output.table import table_text
from ribbonopt.plain import Row, json_text
from ribbonopt.solution.acting import at_places, reactions, resultants
from ribbonopt.solution.solution import Solution

from .carried import Carried
from .quantities import AXES, MIRRORED, PIECE, ROWS, known_of

FORCE = tuple(f"F{axis}" for axis in AXES)
MOMENT = tuple(f"M{axis}" for axis in AXES)
LOADS = ("name", "kind", "s", *FORCE, *MOMENT)


def write(carried: Carried) -> dict[str, bytes]:
    """Return rows along s, loads and reactions, and meanings and units of the columns of both."""
    shape, columns = carried.shape, dict[str, list[float]]()
    known = known_of(shape, ROWS)
    for quantity in (quantity for quantity in ROWS if quantity.name in known):
        whole = quantity in (MIRRORED, PIECE)
        values = known[quantity.name].astype(np.int64 if whole else float).reshape(len(shape.s), -1)
        columns |= dict(zip(quantity.columns, values.T.tolist(), strict=True))
    rows: list[Row] = [
        dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)
    ]
    loads = list(loads_of(carried.solution))
    return {
        ".csv": table_text(list(columns), rows).encode(),
        "-loads.csv": table_text(LOADS, loads).encode(),
        "-columns.json": json_text(_meanings(carried, list(columns))).encode(),
    }


def loads_of(solution: Solution) -> Iterator[Row]:
    """Yield what acts on the piece that was solved, lab frame, in the units of the scene.

    `kind` is reaction (what holds it; at an end, what acts there), load (at a place), or along (a
    load along the ribbon in all, without moments of its force). They add up to no force.
    """
    places = [("reaction", place) for place in reactions(solution)]
    places += [("load", place) for place in at_places(solution) if not place.support]
    for kind, place in sorted(places, key=lambda item: item[1].at):
        yield _row(place.path, kind, place.at, [*place.force, *place.moment])
    for name, (force, couple) in resultants(solution).items():
        yield _row(name, "along", None, [*force, *couple])


def _row(name: str, kind: str, s: float | None, values: list[float]) -> Row:
    numbers = dict(zip((*FORCE, *MOMENT), map(float, values), strict=True))
    return {"name": name, "kind": kind, "s": s} | numbers


def _meanings(carried: Carried, columns: list[str]) -> Row:
    units = carried.shape.units
    rows = {
        column: {"means": quantity.means, "unit": quantity.unit(units)}
        for quantity in ROWS
        for column in quantity.columns
        if column in columns
    }
    named = {quantity.name: quantity.unit(units) for quantity in ROWS}
    loads = {
        "name": {"means": "what acts, by its place in the scene", "unit": ""},
        "kind": {"means": "reaction, load (at a place), or along (a load along it, in all)"},
        "s": {"means": "arclength; empty for what acts along the ribbon", "unit": named["s"]},
        **{name: {"means": "force on the ribbon, lab frame", "unit": named["n"]} for name in FORCE},
        **{name: {"means": "moment, lab frame", "unit": named["m"]} for name in MOMENT},
    }
    about = {**carried.remarks, "numbers": dict(carried.numbers)}
    return {"about": about, "columns": rows, "loads": loads}
