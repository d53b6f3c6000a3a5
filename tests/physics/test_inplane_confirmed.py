"""Answers for ribbons that give in their own plane, under loads too, integrated again."""

import pytest
from independent.confirm import confirm

from ribbonopt import solve
from ribbonopt.scene import (
    Boundary,
    End,
    Kirchhoff,
    Law,
    Loads,
    Membrane,
    RotationVector,
    Sadowsky,
    Scene,
    Variational,
)

BENT = Boundary(
    End("clamped", (0.0, 0.0, 0.0), "identity"),
    End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6))),
)
LOADS = Loads(force=(2.0, 4.0, -4.0), pressure=3.0)


@pytest.mark.parametrize("law", [Sadowsky(), Variational(delta=0.01), Kirchhoff(B2=1.0, B3=0.8)])
@pytest.mark.parametrize("loads", [Loads(), LOADS], ids=["free", "loaded"])
@pytest.mark.parametrize(("bending", "stretching"), [(5.0, None), (20.0, 400.0)])
def test_a_clamp(law: Law, loads: Loads, bending: float, stretching: float | None) -> None:
    soft = Membrane(bending=bending, stretching=stretching)
    found = solve(Scene("soft", law, BENT, membrane=soft, loads=loads, tolerance=1e-9))
    assert confirm(found) < 1e-10
