"""The lowest vibrations of a solution in units Dw = L = 1, and how far from the truth they are.

Errors are told by a second opinion, the same modes at a degree less, and by the error of the shape:
where forces, moments and directors are known to a relative error e, so is each part of omega^2 =
x K x, the energy of the strains and what the loads do; the sum of their sizes times e is a bound.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.widths import widths
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.solution.solution import Solution

from ..gauss_stages import known_error
from ..stability import useless
from ..variation import Variation
from .interpolated import interpolated
from .kinetic import Gyration, Kinetic, kinetic
from .lowest import Pencil, Spectrum
from .stated import Vibrating, stated
from .zero import Neutral

MARGIN = 3.0  # bounds over what two opinions differ by
SHAPE = 10.0  # bounds over the error of the shape
SOFT = 1e-13  # of the largest eigenvalue: what has no stiffness and no mass
ROUNDING = 1e-12  # of omega^2 and the shift: least bound


@dataclass(frozen=True, eq=False)
class Vibrations:
    """The lowest vibrations of a ribbon, units Dw = L = 1 and mass per length one.

    Attributes
    ----------
    squared, bounds : (k,) arrays
        omega^2, without those of zero modes, and bounds of their errors.
    modes : (N, nx + m, k) array
        By the variables of each element, of kinetic energy one half at unit frequency.
    zero : tuple of str
        Motions that nothing opposes.
    negative : int
        How many omega^2 are clearly negative.
    variation, ribbon : Variation, Ribbon
        Where they are.
    weights : (N K,) array
        Masses of the stages.
    pieces : int
        How many times what was solved makes what vibrates.
    told : str
        Which modes these are, where not all.
    """

    squared: Array
    bounds: Array
    modes: Array
    zero: tuple[str, ...]
    negative: int
    variation: Variation
    ribbon: Ribbon
    weights: Array
    pieces: int
    told: str


def vibrations(
    solution: Solution, count: int, gyration: Gyration, *, planar: bool
) -> Vibrations | str:
    """Return the `count` lowest vibrations of a solution or, in words, why there are none."""
    what = stated(solution, planar=planar)
    if isinstance(what, str):
        return what
    variation = what.variation(again=False)
    if why := useless(variation):
        return why
    energy = _kinetic(what, variation, gyration)
    neutral = Neutral.of(what, variation, energy)
    scale = 1 / (variation.largest * what.length**4)
    pencil = Pencil(variation.form, energy.rows, SOFT * variation.largest)
    first = pencil.lowest(count + neutral.most, scale)
    if isinstance(first, str):
        return first
    kept = np.flatnonzero(~neutral.among(first, energy))[:count]
    squared, modes = first.squared[kept], first.modes[..., kept]
    bounds = _bounds(what, variation, first, gyration, scale)[kept]
    negative = int((squared < -bounds).sum())
    return Vibrations(
        squared,
        bounds,
        modes,
        neutral.names(first, energy),
        negative,
        variation,
        what.ribbon,
        energy.weights,
        what.pieces,
        what.told,
    )


def _kinetic(what: Vibrating, variation: Variation, gyration: Gyration) -> Kinetic:
    posed: Posed = what.posed
    start, end = posed.scene.interval
    s = start + (end - start) * ((variation.stages.places * what.pieces) % 1.0)
    return kinetic(variation, what.ribbon.model, what.length, widths(posed.scene, s), gyration)


def _bounds(
    what: Vibrating,
    variation: Variation,
    first: Spectrum,
    gyration: Gyration,
    scale: float,
) -> Array:
    """Bounds (k,) of the errors of omega^2; infinite where the second opinion has no such mode."""
    again = what.variation(again=True)
    rows = _kinetic(what, again, gyration).rows
    pencil = Pencil(again.form, rows, SOFT * again.largest)
    near = interpolated(first.modes, variation, again)
    if near is not None:
        other = pencil.improved(near, first.shift)
    else:
        found = pencil.lowest(len(first.squared), scale)
        other = np.empty(0) if isinstance(found, str) else found.squared
    apart = np.full(len(first.squared), np.inf)
    both = min(len(apart), len(other))
    if first.complete:
        apart[:both] = np.abs(first.squared[:both] - other[:both])
    nx = variation.form.A.shape[1]
    own, compliance = first.modes[:, nx:], np.diagonal(variation.form.Q, axis1=1, axis2=2)[:, nx:]
    strained = np.einsum("eyk,ey->k", own**2, np.abs(compliance))
    parts = np.abs(first.squared) + 2 * strained
    least = SHAPE * _shape_error(what.solution, variation) * parts + ROUNDING * (
        parts + first.shift
    )
    least += SOFT * variation.largest * (own**2).sum(axis=(0, 1))
    bounds: Array = MARGIN * apart + least
    return bounds


def _shape_error(solution: Solution, variation: Variation) -> float:
    """Relative error of the shape: as estimated, or else as the gradient of the energy tells."""
    error = variation.stages.error or known_error(solution)
    return variation.residual if error is None else error
