"""Laws at a width w: what they say is w times what they say at 1, at moments w times smaller."""

import casadi as ca
import numpy as np
import pytest

from ribbonopt.mechanics.laws.catalogue import law_class
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.mechanics.laws.tapered import tapered

W = 0.37
CASES: list[tuple[str, dict[str, float]]] = [
    ("kirchhoff", {"B2": 1.2, "B3": 0.7}),
    ("sadowsky", {}),
    ("single_sheet", {"chi": 1}),
    ("variational", {"delta": 0.1}),
    ("homotopy", {"rho": 0.6, "epsilon": 0.02}),
]
MOMENTS = np.array([[1.0, 2.0], [0.4, -1.5], [2.0, 0.3]])
each_law = pytest.mark.parametrize(("name", "numbers"), CASES, ids=str)


def law_at(name: str, numbers: dict[str, float], width: float) -> ConstitutiveLaw:
    law = law_class(name)(**{key: ca.SX(value) for key, value in numbers.items()})
    return tapered(law, ca.SX(width), ca.SX.sym("s"))


def called(expression: ca.SX, symbol: ca.SX, value: np.ndarray) -> np.ndarray:
    function = ca.Function("f", [symbol], [ca.densify(expression)])
    return np.array(function(value), dtype=float).ravel()


@each_law
@pytest.mark.parametrize("m", MOMENTS, ids=str)
def test_it_is_that_of_unit_width_scaled(
    name: str, numbers: dict[str, float], m: np.ndarray
) -> None:
    law, plain = law_at(name, numbers, W), law_class(name)(**numbers)  # type: ignore[arg-type]
    free, u = ca.SX.sym("m", 2), ca.SX.sym("u", 3)
    stress = Stress.of_moment(ca.vertcat(0, free))
    strains = called(law.strain(stress), free, m)
    np.testing.assert_allclose(strains, called(plain.strain(stress), free, m / W), rtol=1e-14)
    np.testing.assert_allclose(called(law.moment(u), u, strains), m, rtol=1e-9)
    implicit = law.implicit(stress)
    estimate = called(implicit.estimate, free, m)
    equations = ca.substitute(implicit.equations, implicit.unknowns, ca.DM(estimate))
    np.testing.assert_allclose(called(equations, free, m), 0, atol=1e-9)


@each_law
@pytest.mark.parametrize("m", MOMENTS, ids=str)
def test_strains_and_moments_are_derivatives_of_its_energies(
    name: str, numbers: dict[str, float], m: np.ndarray
) -> None:
    law = law_at(name, numbers, W)
    if not law.variational:
        return
    free, u = ca.SX.sym("m", 2), ca.SX.sym("u", 3)
    stress = Stress.of_moment(ca.vertcat(0, free))
    strains = called(law.strain(stress), free, m)
    complementary, energy = law.complementary_energy(stress), law.energy(u)
    gradient = called(ca.gradient(complementary, free), free, m)
    np.testing.assert_allclose(gradient, strains[1:], rtol=1e-12)
    np.testing.assert_allclose(called(ca.gradient(energy, u), u, strains)[1:], m, rtol=1e-8)
    both = called(energy, u, strains) + called(complementary, free, m)
    np.testing.assert_allclose(both, m @ strains[1:], rtol=1e-10)
