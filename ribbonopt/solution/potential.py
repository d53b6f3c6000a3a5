"""Potential of a solution: its energy less the work of the dead loads that act on it.

What a stable equilibrium has the least of. Work along the ribbon is f . r, from the origin of the
lab; that of a dead force at an end is on the chord, which a start that is held only shifts.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.ends.conditions import Component, Equation
from ribbonopt.mechanics.ends.placement import LoadAlong
from ribbonopt.problem import Posed
from ribbonopt.problem.potentials import end_without_potential, point_without_potential

from .solution import Solution


def potential(solution: Solution) -> float | None:
    """Return the potential, in the units of the solution; None where some load has none."""
    posed = solution.posed
    if any(load.without_potential for load in posed.loads):
        return None
    if posed.stations and point_without_potential(posed.stations) is not None:
        return None
    told = any(isinstance(c, Equation) and not c.kinematic for c in posed.conditions)
    if told or end_without_potential(posed.conditions) is not None:
        return None
    return known_potential(solution)


def known_potential(solution: Solution) -> float:
    """Return the same, without what has no potential."""
    posed, units = solution.posed, solution.units
    along, force = solution.integral("potential"), dead_force_of(posed)
    if posed.stations:
        r = solution.trajectory.outputs(posed.places)["r"]
        for station, place in zip(posed.stations, r, strict=True):
            along -= sum(action.work(place) for action in station.actions) * units.moment
    if not force.any():
        return along
    ends = solution.at_nodes["r"]
    return along - float(force @ (ends[-1] - ends[0])) * units.force


def dead_force_of(posed: Posed) -> Array:
    """Dead force (3,) on an end, lab frame, units Dw = L = 1."""
    force = np.zeros(3)
    for c in posed.conditions:
        if c.kinematic:
            continue
        if isinstance(c, Component) and c.quantity == "force" and c.axis in "xyz":
            force["xyz".index(c.axis)] = c.value
        elif isinstance(c, LoadAlong):
            force += c.value * np.array(c.along)
    return force
