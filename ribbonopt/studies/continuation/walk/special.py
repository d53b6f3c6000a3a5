"""Folds and branch points between two points of a branch, located to rounding."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Generic

import numpy as np

from .beside import Beside, Probe
from .points import BRANCH_POINT, FOLD, Point, S
from .protocol import Equations

ONE = 1e-6  # arclength within which a fold and a branch point are one: a pitchfork from its side
FROM_THE_SIDE = "pitchfork, met from its side branch"


@dataclass(frozen=True, eq=False)
class Special(Generic[S]):
    """What was found between two points.

    Special points by arclength, what was not resolved, and how many test functions have changed
    their sign: two at a pitchfork that is met from its side.
    """

    points: list[Point[S]]
    unresolved: tuple[str, ...] = ()
    changes: int = 0


def special_points(equations: Equations[S], a: Point[S], b: Point[S]) -> Special[S]:
    """Return folds and branch points between two points of one layout.

    A test function that changes its sign without a root that is found is named in `unresolved`.
    """
    turns, crosses = a.tangent[-1] * b.tangent[-1] < 0, a.sign * b.sign < 0
    if not (turns or crosses):
        return Special([])
    try:
        beside = Beside(equations, a, b)
    except np.linalg.LinAlgError:
        changed = tuple(k for k, is_ in ((FOLD, turns), (BRANCH_POINT, crosses)) if is_)
        return Special([], changed, len(changed))
    origin = beside.ends[0].near.log

    def determinant(probe: Probe[S]) -> float:
        return probe.near.sign * float(np.exp(probe.near.log - origin))

    arcs, unresolved = {}, []
    if turns:
        arcs[FOLD] = beside.root(lambda probe: float(probe.tangent[-1]))
    if crosses:
        arcs[BRANCH_POINT] = beside.root(determinant)
    found = {}
    for kind, root in arcs.items():
        if root is None:
            unresolved.append(kind)
        else:
            found[kind] = root[0]
    note = ""
    if len(found) == 2 and abs(found[FOLD] - found[BRANCH_POINT]) < ONE:
        del found[FOLD]
        note = FROM_THE_SIDE
    ordered = sorted(found.items(), key=lambda item: item[1])
    points = [_point(beside, kind, arc, note) for kind, arc in ordered]
    return Special(points, tuple(unresolved), len(arcs))


def _point(beside: Beside[S], kind: str, arc: float, note: str) -> Point[S]:
    unknowns = beside.unknowns(arc)
    return replace(
        beside.a,
        solution=beside.equations.restored(beside.a.solution, unknowns),
        unknowns=unknowns,
        tangent=beside.tangent(arc),
        kind=kind,
        note=note,
    )
