"""Thresholds of `loaded_truth`, found from linearised equations by hand, against the whole ones.

There the ends of a ribbon can be reached by other loads at its start too, to first order: the
derivatives of what its end prescribes, by differences of `tests/independent`, are singular.
"""

from collections.abc import Callable

import loaded_truth as truth
import numpy as np
import pytest
from independent.curved import Material, Natural
from independent.loaded import Strip, state
from independent.shooting import held

Array = np.ndarray
Case = tuple[Strip, tuple[float, ...], float]  # strip, force and moment at the start, length
OFF = 1e-4
ROUND = 2 * np.pi


def curled(k: float, ratio: float) -> Case:
    law = Material("sadowsky", natural=Natural(k, poisson_ratio=ratio))
    return Strip(law), (0, 0, 0, 0, 1 - k, 0), ROUND


def curled_rod(k: float) -> Case:
    law = Material("rod", B=(1e9, 1, 2 / 1.3), strains_of_rod=(0, k, 0))
    return Strip(law), (0, 0, 0, 0, 1 - k, 0), ROUND


def twisted(twist: float, C: float) -> Case:
    moment = C * twist / ROUND
    return Strip(Material("rod", B=(1, 1, C))), (0, moment, 0, 0, 1, moment), ROUND


def pressed(p: float) -> Case:
    return Strip(Material("kirchhoff"), pressure=p), (0, 0, -p, 0, 1, 0), ROUND


def torque(M: float) -> Case:
    return Strip(Material("rod", B=(1, 1, 0.8))), (0, 0, 0, 0, 0, M), 1.0


def column(q: float) -> Case:
    return Strip(Material("rod", B=(1, 1, 1)), (0, 0, -q)), (0, 0, -q, 0, 0, 0), 1.0


def heavy_sideways(q: float) -> Case:
    return Strip(Material("kirchhoff"), (0, -q, 0)), (0, -q, 0, q / 2, 0, 0), 1.0


def loaded_sideways(P: float) -> Case:
    return Strip(Material("kirchhoff")), (0, -P, 0, P, 0, 0), 1.0


#: case of a load or curvature, its threshold, whether the far end is free, neutral directions
CASES: dict[str, tuple[Callable[[float], Case], float, bool, int]] = {
    "curled ring": (lambda k: curled(k, 0.0), truth.curled_ring(), False, 0),
    "with Poisson's ratio": (lambda k: curled(k, 0.3), truth.curled_ring(0.3), False, 0),
    "curled rod": (curled_rod, truth.curled_rod_ring(2 / 1.3), False, 0),
    # An isotropic ring may turn about its own tangent.
    "twisted ring": (lambda x: twisted(x, 1.0), truth.twisted_ring(), False, 1),
    "of another rod": (lambda x: twisted(x, 0.8), truth.twisted_ring(0.8), False, 1),
    "pressed ring": (pressed, truth.pressed_ring(), False, 0),
    # A straight rod comes no nearer, to first order.
    "torque": (torque, truth.clamped_torque(), False, 1),
    "column": (column, truth.heavy_column(), True, 0),
    "weight": (heavy_sideways, truth.heavy_rod_sideways(1.0, 2.0), True, 0),
    "tip load": (loaded_sideways, truth.loaded_rod_sideways(1.0, 2.0), True, 0),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_equations_are_singular_at_the_threshold(name: str) -> None:
    make, threshold, free, neutral = CASES[name]
    below, there, above = (
        singular_values(make(share * threshold), free)[-1 - neutral] for share in (0.99, 1.0, 1.01)
    )
    assert there < 2e-6 * min(below, above)


def singular_values(case: Case, free: bool) -> Array:
    """Singular values (6,) of what the far end prescribes, by force and moment at the start."""
    strip, loads, length = case
    middle = np.array(loads, float)[:, None]
    columns = np.concatenate([middle + OFF * np.eye(6), middle - OFF * np.eye(6), middle], axis=1)
    y = state(np.zeros(3), np.eye(3), columns[:3], columns[3:])
    (end,) = strip.along(y, (0.0, length), (1,))
    found = end[12:18] if free else held(end, end[:3, -1], end[3:12, -1].reshape(3, 3))
    slopes = (found[:, :6] - found[:, 6:12]) / (2 * OFF)
    return np.linalg.svd(slopes, compute_uv=False)
