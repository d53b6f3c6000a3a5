"""What acts on a solution, as numbers: along it, at single places, and what its supports carry.

Forces are those on the ribbon, lab frame, in the units of the scene. At a station the force n falls
by the force there, so that all of them and the loads along the ribbon add up to zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import Section

from .solution import Solution

RECOVERED = "recovered."  # before the names of constants that follow from costates
VECTORS = ("r", "d1", "d2", "d3", "n", "m")


@dataclass(frozen=True, eq=False)
class PlaceForce:
    """The force and moment (3,) on the ribbon at the arclength `at`; `path` is whose, in the scene.

    `support` says whether that holds the ribbon, or is its end: then the equilibrium has found it.
    """

    path: str
    at: float
    force: Array
    moment: Array
    support: bool


def at_places(solution: Solution) -> tuple[PlaceForce, ...]:
    """Return the forces between the ends, in order of arclength: point loads and reactions."""
    if not solution.posed.stations:
        return ()
    posed, units, (numbers, constants) = solution.posed, solution.units, _numbers(solution)
    # In a plane what is across it is not among the unknowns.
    theta, unknown = _symbols(numbers), _symbols(constants)
    return tuple(
        PlaceForce(
            action.path,
            units.length * numbers.get(f"{action.path}.at", action.at),
            units.force * _vector(action.force(theta, unknown)),
            units.moment * _vector(action.couple(theta, unknown)),
            support=not action.loads,
        )
        for station in posed.stations
        for action in station.actions
    )


def reactions(solution: Solution) -> tuple[PlaceForce, ...]:
    """Return the forces at supports, in order of arclength: at the start, between, at the end.

    At an end it is what acts there, be it a support or a given load. None at the ends of a piece of
    a loop, where the ribbon goes on.
    """
    between = tuple(place for place in at_places(solution) if place.support)
    if solution.scene.boundary.loop is not None:
        return between
    (start, end), n, m = solution.scene.interval, *(solution.at_nodes[name] for name in "nm")
    first = PlaceForce("boundary.start", float(start), 0.0 - n[0], 0.0 - m[0], support=True)
    last = PlaceForce("boundary.end", float(end), n[-1], m[-1], support=True)
    return (first, *between, last)


def forces_along(solution: Solution, s: Array) -> dict[str, Array]:
    """Return the force per length (k, 3) of each load along the ribbon at arclengths s (k,)."""
    if not solution.posed.loads:
        return {}
    found = _along(solution, s / solution.units.length, solution.outputs(s))
    return {name: force for name, (force, _) in found.items()}


def resultants(solution: Solution) -> dict[str, tuple[Array, Array]]:
    """Return the force (3,) and couple (3,) of each load along the ribbon in all.

    By the scheme's quadrature; the couple is that which is given, without moments of the force.
    """
    if not solution.posed.loads:
        return {}
    start, end = solution.scene.interval
    _, fraction, weights, _ = solution.trajectory.stages
    s = (start + (end - start) * fraction) / solution.units.length
    along = _along(solution, s, solution.at_stages)
    share = (end - start) * weights
    return {name: (share @ force, share @ couple) for name, (force, couple) in along.items()}


def _along(
    solution: Solution, s: Array, values: Mapping[str, Array]
) -> dict[str, tuple[Array, Array]]:
    """Return forces and couples per length (k, 3) at arclengths s (k,), which are in units L = 1.

    `values` are the outputs there, in the units of the scene.
    """
    units, theta = solution.units, _symbols(_numbers(solution)[0])
    own, position = solution.posed.loads, ca.SX.sym("s")
    r, d1, d2, d3, n, m = (ca.SX.sym(name, 3) for name in VECTORS)
    e = ca.SX.sym("e")
    section = Section(r, d1, d2, d3, n, m, position, ca.SX(0, 1), extension=e)
    vectors = [ca.vertcat(x.force(section, theta), x.couple(section, theta)) for x in own]
    inputs = [r, d1, d2, d3, n, m, position, e]
    function = ca.Function("acting", inputs, [ca.densify(vector) for vector in vectors])
    numbers = [(values[name] / units.of(name)).T for name in VECTORS]
    result: dict[str, tuple[Array, Array]] = {}
    numbers += [s[None], values["extension"][None]]
    for load, found in zip(own, function.map(len(s)).call(numbers), strict=True):
        force, couple = np.split(np.array(found).T, 2, axis=1)
        force, couple = force * units.force / units.length, couple * units.force
        if load.name in result:  # as two of a user's own may have it
            force, couple = force + result[load.name][0], couple + result[load.name][1]
        result[load.name] = force, couple
    return result


def _numbers(solution: Solution) -> tuple[dict[str, float], dict[str, float]]:
    """Return parameters and unknown constants by name, in units Dw = L = 1."""
    problem, dense = solution.problem, solution.dense
    theta = dict(zip(problem.parameter_names, map(float, dense.theta), strict=True))
    constants = dict(zip(problem.constant_names, map(float, dense.constants), strict=False))
    recovered = {
        name.removeprefix(RECOVERED): theta[name] for name in problem.recovered if name in theta
    }
    return theta, constants | recovered


def _symbols(numbers: Mapping[str, float]) -> Callable[[str], ca.SX]:
    """Return the symbols of numbers by name, which are the numbers; 0 for what is not there."""
    return lambda name: ca.SX(numbers.get(name, 0.0))


def _vector(value: ca.SX) -> Array:
    return np.array(ca.evalf(value)).ravel()
