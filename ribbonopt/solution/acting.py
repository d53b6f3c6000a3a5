"""What acts on a solution, as numbers: along it, at single places, and what its supports carry.

Forces are those on the ribbon, lab frame, in the units of the scene. At a station the force n falls
by the force there, so that all of them and the loads along the ribbon add up to zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.section import Section

from .solution import Solution

RECOVERED = "recovered."  # before the names of constants that follow from costates
VECTORS = ("r", "d1", "d2", "d3", "n", "m")


@dataclass(frozen=True, eq=False)
class PlaceForce:
    """The force (3,) on the ribbon at the arclength `at`; `path` is whose, in the scene.

    `support` says whether that holds the ribbon, or is its end: then the equilibrium has found it.
    """

    path: str
    at: float
    force: Array
    support: bool


def at_places(solution: Solution) -> tuple[PlaceForce, ...]:
    """Return the forces between the ends, in order of arclength: point loads and reactions."""
    posed, units = solution.posed, solution.units
    theta, unknown = _numbers(solution)
    return tuple(
        PlaceForce(
            action.path,
            units.length * theta.get(f"{action.path}.at", action.at),
            # In a plane what is across it is not among the unknowns.
            units.force * _vector(action.force(_symbols(theta), _symbols(unknown))),
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
    (start, end), n = solution.scene.interval, solution.at_nodes["n"]
    first = PlaceForce("boundary.start", float(start), 0.0 - n[0], support=True)
    last = PlaceForce("boundary.end", float(end), n[-1], support=True)
    return (first, *between, last)


def forces_along(solution: Solution, s: Array) -> dict[str, Array]:
    """Return the force per length (k, 3) of each load along the ribbon at arclengths s (k,)."""
    if not solution.posed.loads:
        return {}
    return _along(solution, s / solution.units.length, solution.outputs(s))


def resultants(solution: Solution) -> dict[str, Array]:
    """Return the force (3,) of each load along the ribbon in all, by the scheme's quadrature."""
    if not solution.posed.loads:
        return {}
    start, end = solution.scene.interval
    _, fraction, weights, _ = solution.trajectory.stages
    s = (start + (end - start) * fraction) / solution.units.length
    forces = _along(solution, s, solution.at_stages)
    return {name: (end - start) * (weights @ force) for name, force in forces.items()}


def _along(solution: Solution, s: Array, values: Mapping[str, Array]) -> dict[str, Array]:
    """Return forces per length (k, 3) at arclengths s (k,) in units L = 1, outputs there known."""
    units, theta = solution.units, _symbols(_numbers(solution)[0])
    vectors = [ca.SX.sym(name, 3) for name in VECTORS]
    own, position = solution.posed.loads, ca.SX.sym("s")
    r, d1, d2, d3, n, m = vectors
    section = Section(r, d1, d2, d3, n, m, position, ca.SX(0, 1))
    forces = [ca.densify(load.force(section, theta)) for load in own]
    function = ca.Function("forces", [*vectors, position], forces)
    inputs = [(values[name] / units.of(name)).T for name in VECTORS]
    found = function.map(len(s)).call([*inputs, s[None]])
    unit, result = units.force / units.length, dict[str, Array]()
    for load, force in zip(own, found, strict=True):
        # Two of a user's own may share a name.
        result[load.name] = result.get(load.name, 0.0) + unit * np.array(force).T
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
