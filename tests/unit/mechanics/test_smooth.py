"""Families of smooth laws, and the layers that laws say they have."""

import casadi as ca
import numpy as np
import pytest

from ribbonopt.mechanics.laws.catalogue import law_class
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.laws.smooth import EVEN, first_law, in_family, sharpened, sharpness
from ribbonopt.scene import Kirchhoff, Variational

LAYERS = [
    ("regularized", {"epsilon": 1e-3}),
    ("homotopy", {"rho": 0.99, "epsilon": 1e-3}),
    ("homotopy", {"rho": 1.0, "epsilon": 1e-2}),
    ("variational", {"delta": 1e-3}),
]


@pytest.mark.parametrize("m3", [1.0, -0.2])
@pytest.mark.parametrize(("name", "numbers"), LAYERS, ids=str)
def test_bending_bends_off_where_a_law_says_its_layer_is(
    name: str, numbers: dict[str, float], m3: float
) -> None:
    """Within it u2 is linear in m2, beyond it nearly a constant: at its width about half way."""
    law, m = law_class(name)(**{k: ca.SX(v) for k, v in numbers.items()}), ca.SX.sym("m", 2)
    stress = Stress.of_moment(ca.vertcat(0, m))
    at = law.singular(stress)[1]  # beside that where all moments vanish
    values = ca.Function("u2", [m], [law.strain(stress)[1]])
    re, im = (float(v) for v in ca.Function("at", [m], [at.re, at.im])([1.0, m3]))
    width = abs(im / re)
    slope = float(values([1e-6 * width, m3])) / (1e-6 * width)
    assert 0.45 < float(values([width, m3])) / (slope * width) < 0.75
    assert float(values([20 * width, m3])) < 2.5 * float(values([width, m3]))


@pytest.mark.parametrize("B3", [1e-3, 0.1, 0.29, 3.5, 10.0, 2e3])
@pytest.mark.parametrize("B2", [0.5, 1.0])
def test_rods_are_approached_from_their_own_side(B2: float, B3: float) -> None:
    rod = Kirchhoff(B2=B2, B3=B2 * B3)
    first = first_law(rod, 0.3)
    assert isinstance(first, Kirchhoff) and in_family(first)
    assert sharpness(first, 0.0) == pytest.approx(EVEN)
    # Softer or stiffer in twist than in bending all the way, and the rod itself at its end.
    assert (first.B3 < first.B2) == (rod.B3 < rod.B2)
    for to in np.geomspace(EVEN, sharpness(rod, 0.0), 4):
        between = sharpened(first, float(to))
        assert isinstance(between, Kirchhoff) and between.B2 == B2
        assert sharpness(between, 0.0) == pytest.approx(to)
        assert (between.B3 < between.B2) == (rod.B3 < rod.B2)
    assert sharpened(first, sharpness(rod, 0.0)).B3 == pytest.approx(rod.B3)


def test_even_rods_and_smooth_laws_are_their_own_first() -> None:
    for law in (Kirchhoff(B2=1.0, B3=2.0), Variational(delta=0.5)):
        assert first_law(law, 0.3) == law
    assert first_law(Variational(delta=0.01), 0.3) == Variational(delta=0.3)
