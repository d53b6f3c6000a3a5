"""Phases between stations: where something acts or holds at single places between the ends.

Equations are written once, with a symbol for each station that says whether it is passed
(`Ribbon.marked`); a phase is those with numbers put in.
"""

from __future__ import annotations

from dataclasses import fields, replace
from itertools import pairwise

import casadi as ca

from ribbonopt.errors import ModelError

from .contract import Phase
from .ribbon import Ribbon

Kinds = tuple[int, ...]


def between_stations(phase: Phase, marked: Ribbon) -> tuple[Phase, ...]:
    """Return the phases of known lengths between the stations of a ribbon; the one if none."""
    if not marked.stations:
        return (phase,)
    start, end = marked.interval
    places = [start, *(st.place(marked.theta.__getitem__) for st in marked.stations), end]
    lengths = [b - a for a, b in pairwise(places)]
    return tuple(
        replace(passing(phase, marked, count), length=length)
        for count, length in enumerate(lengths)
    )


def passing(phase: Phase, marked: Ribbon, count: int) -> Phase:
    """Return a phase behind so many stations of a marked ribbon."""
    if not marked.stations:
        return phase
    total = len(marked.stations)
    values = ca.SX(ca.DM([1.0] * count + [0.0] * (total - count)))
    names = [f.name for f in fields(phase) if isinstance(getattr(phase, f.name), ca.SX)]
    parts = [getattr(phase, name) for name in names]
    every = [*parts, *phase.outputs.values()]
    found: list[ca.SX] = ca.substitute(every, [marked.passed], [values])
    outputs = dict(zip(phase.outputs, found[len(parts) :], strict=True))
    return replace(phase, outputs=outputs, **dict(zip(names, found, strict=False)))


def stations_among(kinds: Kinds, count: int) -> tuple[int, ...]:
    """Return at which of the meeting points 1, 2, ... of phases of these kinds the stations are.

    Phases of one kind meet at stations only. What is left of them is where kinds differ, the
    first such points: there a couple takes the law from one side to the other.

    Raises
    ------
    ModelError
        If there are too few meeting points, or phases of one kind meet elsewhere.
    """
    meets = range(1, len(kinds))
    same = [i for i in meets if kinds[i] == kinds[i - 1]]
    other = [i for i in meets if kinds[i] != kinds[i - 1]][: max(count - len(same), 0)]
    found = tuple(sorted((*same, *other)))
    if len(found) != count:
        raise ModelError(
            f"phases {kinds}: {len(found)} of their meeting points may be stations, expected "
            f"{count}"
        )
    return found
