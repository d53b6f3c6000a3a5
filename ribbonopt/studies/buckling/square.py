"""The square problem of a buckling load and its mode, in phases.

Unknowns: states [x, xi], constants [gamma, p, lengths of phases]: see `infinitesimal`. Phases meet
at the stations of the ribbon, where something acts or holds, and where m2 of the mode changes sign.
"""

from __future__ import annotations

from itertools import pairwise

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.problem.pieces import Kinds, passing

from .infinitesimal import Deflected, Strain


@dataclass(frozen=True)
class Pieces:
    """Kinds of phases, +1 or -1, and which of their meeting points 1, 2, ... are stations."""

    kinds: Kinds
    stations: tuple[int, ...] = ()


def square(
    deflected: Deflected,
    numbers: ca.SX,
    strain: Strain,
    law: ConstitutiveLaw,
    pieces: Pieces | None = None,
) -> BoundaryValueProblem:
    """Return the square problem of a buckling load and its mode.

    Parameters
    ----------
    deflected
        The ribbon.
    numbers
        Further symbols (k,) that the strains contain; the last parameters.
    strain
        The law, as strains (3,) at a stress, unless phases are given.
    law
        The law whose sides hold in phases.
    pieces
        The phases, which meet at stations and where m2 vanishes; None for one between stations.
    """
    parts, (nx, nc, _) = deflected.parts, deflected.sizes
    row = ca.SX.sym("row", 2 * nx + nc)
    places, count = deflected.places, len(deflected.ribbon.stations)
    stations = tuple(range(1, count + 1)) if pieces is None else pieces.stations
    lengths = ca.SX.sym("length", 0 if pieces is None else len(pieces.kinds) - 1)
    if pieces is None:
        sides, each = [strain] * (count + 1), [b - a for a, b in pairwise(places)]
    else:
        sides = [law.branch(kind).strain for kind in pieces.kinds]
        each = [*ca.vertsplit(lengths), places[-1] - places[0] - ca.sum1(lengths)]
    outputs = {"m": deflected.stress.m}
    phases = tuple(
        passing(
            Phase(deflected.dynamics(side), length, outputs),
            deflected.marked,
            sum(j <= i for j in stations),
        )
        for i, (side, length) in enumerate(zip(sides, each, strict=True))
    )
    points = tuple(ca.SX.sym(f"point{i}", 2 * nx) for i in range(len(phases) + 1))
    conditions = deflected.conditions([points[i] for i in (0, *stations, len(phases))])
    at, state = places[0], ca.vertcat(parts["x"], parts["xi"])
    for i, length in enumerate(each[:-1] if pieces else (), start=1):
        at = at + length
        if i in stations:
            conditions[f"station {i}: its place"] = at - places[stations.index(i) + 1]
            continue
        here = [state, deflected.ribbon.position], [points[i], at]
        m2 = deflected.before(deflected.stress.m[1], sum(j <= i for j in stations))
        (conditions[f"switch {i}: m2 = 0"],) = ca.substitute([m2], *here)
    mode = ca.vertcat(points[0][nx:], points[-1][nx:], parts["gamma"])
    conditions["size of the deflection"] = ca.dot(row, mode) - 1
    parameters = {"a": parts["a"], "b": parts["b"], "row": row, "numbers": numbers}
    names = [f"{name} {i}" for name, part in parameters.items() for i in range(part.numel())]
    constants = ca.vertcat(parts["gamma"], parts["load"], lengths)
    return BoundaryValueProblem(
        position=deflected.ribbon.position,
        state=state,
        algebraic=ca.SX(0, 1),
        constants=constants,
        parameters=ca.vertcat(*parameters.values()),
        start=places[0],
        phases=phases,
        points=points,
        conditions=conditions,
        state_names=tuple(f"state {i}" for i in range(2 * nx)),
        constant_names=tuple(f"constant {i}" for i in range(int(constants.numel()))),
        parameter_names=tuple(names),
        stations=stations,
    )


def packed(a: Array, b: Array, row: Array, numbers: Array) -> Array:
    """Return the parameters theta of the problem."""
    return np.concatenate([a, b, row, numbers])
