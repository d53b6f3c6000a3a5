"""A buckling load, and the ribbon deflected by its mode: a guess for the buckled ribbon."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import Posed, Ribbon

from .mode import Mode

SMALL = 1e-6  # amplitude of a deflection that is linear


@dataclass(frozen=True, eq=False)
class Buckling:
    """A buckling load, and the shape that the ribbon begins to take.

    Attributes
    ----------
    value : float
        Of the parameter, in the units of the scene.
    error : float
        Estimated error of it.
    posed : Posed
        The scene at this load, in the states with the fewest unknowns.
    ribbon, mode : Ribbon, Mode
        Its mechanics, and the infinitesimal deflection.
    """

    value: float
    error: float
    posed: Posed
    ribbon: Ribbon
    mode: Mode

    def guess(self, amplitude: float) -> Deflection:
        """Return the ribbon deflected by an amplitude, relative to its length, as a guess.

        Where the centre line stays where it is the amplitude is an angle.
        """
        return Deflection(self, amplitude)

    def numbers(self, fraction: Array) -> tuple[Array, Array, Array]:
        """States x and their deflection xi (k, nx) at fractions (k,), and gamma (nc,)."""
        nx, nc = len(self.ribbon.states), len(self.ribbon.constants)
        v = self.mode.trajectory.approximate(fraction)
        return v[:, :nx], v[:, nx : 2 * nx], self.mode.trajectory.dense.constants[:nc]

    @cached_property
    def size(self) -> float:
        """Largest displacement of the mode as it was found, or turn where there is none."""
        fraction = np.linspace(0.0, 1.0, 201)
        at, beside = (self.fields(fraction, a) for a in (0.0, SMALL))
        moved = float(np.abs(beside.r - at.r).max()) / (SMALL * self.posed.length)
        turned = float(np.abs(beside.frames - at.frames).max()) / SMALL
        return moved if moved > SMALL * turned else turned

    def fields(self, fraction: Array, factor: float) -> RodFields:
        """Fields at fractions (k,) of the length, the mode as it was found times a factor."""
        x, xi, gamma = self.numbers(fraction)
        start, _ = self.posed.scene.interval
        s = start + self.posed.length * fraction
        c = self._straight + factor * gamma
        function = self.ribbon.section_function.map(len(fraction))
        columns = (np.repeat(v[:, None], len(fraction), axis=1) for v in (c, self.posed.values))
        c_columns, theta = columns
        found = function((x + factor * xi).T, c_columns, theta, s[None])
        r, d1, d2, d3, n, m = (np.array(part).T for part in found[:6])
        return RodFields(r, np.stack([d1, d2, d3], axis=2), n, m)

    @cached_property
    def _straight(self) -> Array:
        """Constants (nc,) of the straight state."""
        nx, nc, nt = len(self.ribbon.states), len(self.ribbon.constants), len(self.ribbon.theta)
        theta, load = self.mode.trajectory.dense.theta, self.mode.load
        a, b = theta[: nx + nc + nt], theta[nx + nc + nt : 2 * (nx + nc + nt)]
        found: Array = (a + load * (b - a))[nx : nx + nc]
        return found


@dataclass(frozen=True, eq=False)
class Deflection:
    """A buckling mode of some amplitude: a guess for the buckled ribbon."""

    buckling: Buckling
    amplitude: float

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, units Dw = L = 1."""
        return self.buckling.fields(fraction, self.amplitude / self.buckling.size)
