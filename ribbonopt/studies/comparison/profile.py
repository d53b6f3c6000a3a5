"""What errors of a comparison are measured on: loads at the start, strains along the ribbon."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.scene.units import Units

SAMPLES = 101


@dataclass(frozen=True, eq=False)
class Profile:
    """What errors are measured on: n, m (3,) at the start, lab frame, and u (SAMPLES, 3) along s.

    u is taken in the middles of equal parts of the ribbon, because it may jump at the ends (at the
    end of half a Moebius ribbon m2 changes sign, and at epsilon = 0 that throws u2 over). All in
    the scene's `units`, with which n and m can be compared.
    """

    n0: Array
    m0: Array
    u: Array
    units: Units


def load_sizes(profile: Profile) -> tuple[float, float]:
    """Sizes of n(0) and m(0); one that vanishes is measured by the other, and both by one."""
    units = profile.units
    n = float(np.linalg.norm(profile.n0)) / units.force
    m = float(np.linalg.norm(profile.m0)) / units.moment
    tiny = 1e-9 * max(n, m)
    if n <= tiny:
        n = m
    if m <= tiny:
        m = n
    return (n or 1.0) * units.force, (m or 1.0) * units.moment


def errors_of(found: Profile, true: Profile) -> dict[str, float]:
    """Relative errors of n(0), m(0) and of u along s."""
    sizes = load_sizes(true)
    return {
        "error_n0": float(np.linalg.norm(found.n0 - true.n0)) / sizes[0],
        "error_m0": float(np.linalg.norm(found.m0 - true.m0)) / sizes[1],
        "error_u": relative(found.u - true.u, true.u),
    }


def relative(difference: Array, whole: Array) -> float:
    """Largest difference over the largest size of the whole, where that is not zero."""
    size = float(np.abs(whole).max())
    largest = float(np.abs(difference).max())
    return largest / size if size > 0 else largest
