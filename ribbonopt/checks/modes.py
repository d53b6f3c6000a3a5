"""Natural frequencies and shapes of small vibrations about an equilibrium.

r + dr e^(i omega t), mass per length one (or that of the material): M x = mu (K + sigma M) x with
K the second variation of the energy (`variation`) and M the kinetic energy (`vibrations.kinetic`),
omega^2 = 1 / mu - sigma. Nothing stretches that does not stretch in the model. An omega^2 below
zero is a direction of instability, and the number of these is that of the negative directions.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.scene.inertia import Inertia
from ribbonopt.solution.solution import Solution

from .vibrations.found import Vibrations, vibrations
from .vibrations.shapes import shapes_of, straightens
from .vibrations.units import Time, gyration_of, time_of

COUNT = 8
ACROSS = 1 - 1e-6  # share of the kinetic energy in the plane, of a mode across it
UNCLAIMED = "those across the plane without a bound, the law being singular where it does not bend"


@dataclass(frozen=True, eq=False)
class Modes:
    """The lowest natural frequencies and their shapes.

    Attributes
    ----------
    squared : (k,) array
        omega^2, ascending, zero modes left out: in units Dw / (rho L^4), rho mass per length, or
        (rad/s)^2 of a scene in SI that has a density.
    frequencies : (k,) array
        sign(squared) sqrt ``|squared|``, in Hz (over 2 pi) of such a scene. A negative one is a
        rate of growth.
    errors : (k,) array
        Bounds of the relative errors of the frequencies; nan where none is known: not
        even a sign, or across a plane where the law is singular.
    zero : tuple of str
        Motions that nothing opposes, such as "translation along x" or "sliding along itself".
    in_plane : (k,) array
        Share of the kinetic energy in the ribbon's plane, where it is planar; else nan.
    s : (n,) array
        Arclengths of the start, the stages and the end, in the units of the scene; of all of a band
        or strip of which a piece was solved.
    displacement, rotation : (k, n, 3) arrays
        Of positions, over the unit of length, and of directors, which turn about this vector; lab
        frame. Scaled to a largest displacement of one; of rotation where nothing moves.
    unit : str
        Of the frequencies.
    negative : int
        How many omega^2 are clearly negative, of all.
    told : str
        Which modes these are, where not all: in the plane alone, or with the symmetry of a piece;
        and what is not known of them.
    bounds : (k,) array
        Bounds of the errors of `squared`.
    """

    squared: Array
    frequencies: Array
    errors: Array
    zero: tuple[str, ...]
    in_plane: Array
    s: Array
    displacement: Array
    rotation: Array
    unit: str
    negative: int
    told: str
    bounds: Array

    def __repr__(self) -> str:
        """Say what they are in one line."""
        count = len(self.squared)
        some = ", ".join(f"{value:.6g}" for value in self.frequencies[:4])
        more = ", ..." if count > 4 else ""
        return f"<{count} modes: {some}{more} {self.unit}; {self.negative} grow>"


def modes_of(
    solution: Solution, count: int = COUNT, inertia: Inertia | None = None, planar: bool = False
) -> Modes | str:
    """Return the lowest modes of a solution or, in words, why there are none.

    Parameters
    ----------
    solution
        Any equilibrium that has a second variation, stable or not.
    count
        How many modes, zero modes not counted; fewer are returned where the mesh has no more.
    inertia
        Of sections that turn, in the place of the scene's `inertia`.
    planar
        Whether only motions in the ribbon's plane are looked at.
    """
    gyration = gyration_of(solution, inertia)
    if isinstance(gyration, str):
        return gyration
    found = vibrations(solution, count, gyration, planar=planar)
    if isinstance(found, str):
        return found
    return _in_units(solution, found, time_of(solution))


def _in_units(solution: Solution, found: Vibrations, time: Time) -> Modes:
    """Return modes in the units of a scene."""
    shapes = shapes_of(solution, found)
    squared, bounds = found.squared / time.size**2, found.bounds / time.size**2
    cycles = 2 * np.pi if time.seconds else 1.0
    frequencies = np.sign(squared) * np.sqrt(np.abs(squared)) / cycles
    told, across = found.told, shapes.in_plane < ACROSS
    if across.any() and straightens(solution):
        told = ", ".join(filter(None, [told, UNCLAIMED]))
        bounds[across] = np.nan
    return Modes(
        squared,
        frequencies,
        _relative(squared, bounds),
        found.zero,
        shapes.in_plane,
        shapes.s,
        shapes.displacement,
        shapes.rotation,
        time.unit,
        found.negative,
        told,
        bounds,
    )


def _relative(squared: Array, bounds: Array) -> Array:
    """Relative errors of roots from errors of their squares: nan where the sign is not known."""
    sizes = np.abs(squared)
    known = bounds < sizes
    ratio = np.where(known, bounds / np.where(known, sizes, 1.0), np.nan)
    found: Array = 1 - np.sqrt(1 - ratio)
    return found
