"""Inertia and time of small vibrations in the units of a scene."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.mechanics.widths import own_width
from ribbonopt.scene.inertia import Inertia, of_width
from ribbonopt.solution.solution import Solution

from .kinetic import Gyration

DIMENSIONLESS = "sqrt(Dw/(rho L^4))"


def gyration_of(solution: Solution, inertia: Inertia | None) -> Gyration | str:
    """Return the squared radii of gyration of a solution's sections, L = 1, or why not."""
    scene = solution.scene
    asked = scene.inertia if inertia is None else inertia
    if asked is None:
        return Gyration()
    length = solution.units.length
    if not isinstance(asked, Inertia):
        width = own_width(scene)
        if width is None:
            return "inertia: ribbon takes the width of the `ribbon`, which is not said"
        asked = of_width(width)
    return Gyration(asked.d1 / length**2, asked.d3 / length**2)


class Time(NamedTuple):
    """One over the unit of omega, whether that is in seconds, and the unit of frequencies."""

    size: float
    seconds: bool

    @property
    def unit(self) -> str:
        """Unit of frequencies."""
        return "Hz" if self.seconds else DIMENSIONLESS


def time_of(solution: Solution) -> Time:
    """Return the unit of time: s where a scene in SI has a density, or sqrt(rho L^4 / (Dw)).

    Inside, frequencies are in units sqrt(Dw / (rho L^4)), Dw = L = 1 and rho = 1 of a section of
    the ribbon's own width. A scene in SI without a density is told them as they are.
    """
    units, ribbon = solution.units, solution.scene.ribbon
    mass = 1.0
    if ribbon is not None:
        if ribbon.density is None:
            return Time(1.0, seconds=False)
        mass = ribbon.density * ribbon.width * ribbon.thickness
    return Time(float(np.sqrt(mass / units.force)) * units.length, seconds=ribbon is not None)
