"""Answers under the laws of extensible ribbons and of Sano and Wada, integrated again."""

import numpy as np
import pytest
from independent.confirm import confirm

from ribbonopt import solve
from ribbonopt.scene import Boundary, End, Extensible, Quaternion, RotationVector, Sano, Scene

START = End("clamped", (0.0, 0.0, 0.0), "identity")
BENT = Boundary(START, End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6))))
#: between these clamps u2 changes its sign two and three times
TWISTED = (
    ((-0.07, 0.6, -0.25), (0.46, -0.16, 0.78, 0.39)),
    ((0.1, 0.2, -0.6), (-0.28, 0.53, -0.61, 0.52)),
)
TOLERANCE = 1e-9
SIZES = {"width": 1 / 20, "poisson_ratio": 0.3}


def test_the_bent_clamp() -> None:
    """The first number is that of two more methods, the second of `test_plates_truth.py`."""
    law = Extensible(thickness=1 / 400, **SIZES)
    found = solve(Scene("C", law, BENT, tolerance=TOLERANCE))
    assert found.energy == pytest.approx(2.965209684562, rel=TOLERANCE)
    assert confirm(found) < TOLERANCE / 10
    law = Sano(B2=0.91, B3=1.4, zeta=(0.91 / 60) ** 0.5)
    found = solve(Scene("C", law, BENT, tolerance=TOLERANCE))
    assert found.energy == pytest.approx(2.934277990548, rel=TOLERANCE)
    assert confirm(found) < TOLERANCE / 10


@pytest.mark.parametrize(
    "thickness",
    [
        pytest.param(1 / 400, marks=pytest.mark.slow),
        pytest.param(1 / 4000, marks=pytest.mark.sweep),
    ],
)
@pytest.mark.parametrize(("place", "q"), TWISTED)
def test_twisted_clamps(place: tuple[float, ...], q: tuple[float, ...], thickness: float) -> None:
    """Thin ribbons leap where u2 changes its sign."""
    unit = np.array(q) / np.linalg.norm(q)
    end = End("clamped", place, Quaternion(tuple(unit.tolist())))
    law = Extensible(thickness=thickness, **SIZES)
    found = solve(Scene("twisted", law, Boundary(START, end), tolerance=TOLERANCE))
    assert found.verified
    assert confirm(found) < 10 * TOLERANCE
