"""Energies of the laws: gradients, Legendre transforms, convexity, and the limits of families."""

from collections.abc import Callable
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from ribbonopt.mechanics.laws import relations as laws
from ribbonopt.mechanics.laws.blended import HomotopyLaw, RegularizedLaw
from ribbonopt.mechanics.laws.catalogue import LAWS, law_class
from ribbonopt.mechanics.laws.extensible import ExtensibleLaw
from ribbonopt.mechanics.laws.kirchhoff import KirchhoffLaw
from ribbonopt.mechanics.laws.law import RibbonLaw
from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw, SingleSheetLaw
from ribbonopt.mechanics.laws.sano import SanoLaw
from ribbonopt.mechanics.laws.variational import VariationalLaw

Pairs = np.ndarray
WITH_ENERGY = [
    KirchhoffLaw(1, 2),
    KirchhoffLaw(3, 0.7),
    SadowskyLaw(),
    SingleSheetLaw(1),
    SingleSheetLaw(-1),
    VariationalLaw(0.3),
    VariationalLaw(0.01),
    ExtensibleLaw(0.2, 0.1, 0.3),  # convex at all strains of these tests
    SanoLaw(1, 2, 0.05),
]
with_energy = pytest.mark.parametrize("law", WITH_ENERGY, ids=str)
convex = pytest.mark.parametrize(
    "law", [law for law in WITH_ENERGY if not isinstance(law, SingleSheetLaw)], ids=str
)
number = st.floats(-10, 10).filter(lambda x: abs(x) > 1e-6)


@cache
def evaluated(expression: Callable[[Any, Any], Any], gradient: bool = False) -> Any:
    """Return the numeric function of arrays (2, k) of an expression of two symbols."""
    a = ca.SX.sym("a", 2)
    value = expression(a[0], a[1])
    value = ca.vertcat(*value) if isinstance(value, tuple) else value
    function = ca.Function("f", [a], [ca.densify(ca.gradient(value, a) if gradient else value)])
    return lambda points: np.array(function.map(points.shape[1])(points))


def moments_of(law: RibbonLaw) -> Pairs:
    """Return random moments in every quadrant that has strains."""
    rng = np.random.default_rng(11)
    m = rng.uniform(0.1, 3, (2, 400)) * rng.choice([-1, 1], (2, 400))
    return m[:, law.chi * m[0] > 0] if isinstance(law, SingleSheetLaw) else m


def test_every_variational_law_has_both_energies_and_no_other_has_one() -> None:
    numbers = {"B2": 1, "B3": 2, "chi": 1, "epsilon": 0.1, "rho": 0.5, "delta": 0.1}
    numbers |= {"width": 0.2, "thickness": 0.1, "poisson_ratio": 0.3, "zeta": 0.05}
    for kind in (kind for kind in map(law_class, LAWS) if issubclass(kind, RibbonLaw)):
        law = kind(**{name: numbers[name] for name in kind.__dataclass_fields__})
        assert (law.stored(1.0, 0.5) is not None) is law.variational
        assert (law.complementary(1.0, 0.5) is not None) is law.variational


@with_energy
def test_strain_is_the_gradient_of_the_complementary_energy(law: RibbonLaw) -> None:
    m = moments_of(law)
    gradient = evaluated(law.complementary, gradient=True)(m)
    np.testing.assert_allclose(gradient, evaluated(law.strains)(m), rtol=1e-13)


@with_energy
def test_moment_is_the_gradient_of_the_energy(law: RibbonLaw) -> None:
    m = moments_of(law)
    u = evaluated(law.strains)(m)
    np.testing.assert_allclose(evaluated(law.stored, gradient=True)(u), m, rtol=1e-10)


@with_energy
def test_complementary_energy_is_the_legendre_transform(law: RibbonLaw) -> None:
    m = moments_of(law)
    u = evaluated(law.strains)(m)
    transform = (m * u).sum(axis=0) - evaluated(law.stored)(u)[0]
    np.testing.assert_allclose(evaluated(law.complementary)(m)[0], transform, rtol=1e-12)


@convex
def test_complementary_energy_is_the_supremum(law: RibbonLaw) -> None:
    rng = np.random.default_rng(12)
    m, u = moments_of(law)[:, :50], rng.uniform(-3, 3, (2, 2000))
    bound = evaluated(law.complementary)(m)[0]
    assert ((m.T @ u - evaluated(law.stored)(u)) <= bound[:, None] * (1 + 1e-12)).all()


def test_the_printed_legendre_transform_is_none() -> None:
    u2, u3 = evaluated(SadowskyLaw().strains)(np.array([[1.0], [2.0]]))
    transform = u2 + 2 * u3 - evaluated(SadowskyLaw().stored)(np.array([u2, u3]))
    printed = (2 * np.sqrt(5)) ** 2 / 8  # (7.2), both roots of m2^2 + m3^2
    assert abs(printed - transform[0, 0]) > 0.5


@convex
@given(a2=number, a3=number, b2=number, b3=number)
def test_complementary_energy_is_convex(
    law: RibbonLaw, a2: float, a3: float, b2: float, b3: float
) -> None:
    points = np.array([[a2, b2, (a2 + b2) / 2], [a3, b3, (a3 + b3) / 2]])
    a, b, middle = evaluated(law.complementary)(points)[0]
    assert middle <= (a + b) / 2 * (1 + 1e-13)


@convex
@given(a2=number, a3=number, b2=number, b3=number)
def test_energy_is_convex(law: RibbonLaw, a2: float, a3: float, b2: float, b3: float) -> None:
    points = np.array([[a2, b2, (a2 + b2) / 2], [a3, b3, (a3 + b3) / 2]])
    a, b, middle = evaluated(law.stored)(points)[0]
    assert middle <= (a + b) / 2 * (1 + 1e-13)


def test_sadowsky_energy_itself_is_not_convex() -> None:
    points = np.array([[1.0, -1.0, 0.1], [1.0, 1.0, 1.0]])
    a, b, middle = evaluated(laws.sadowsky_energy)(points)[0]
    assert middle > max(a, b)


@given(u2=number, eta=st.floats(-1, 1))
def test_convexified_energy_is_sadowskys_where_eta_is_allowed(u2: float, eta: float) -> None:
    u3 = eta * u2
    # (2.8) as printed
    expected = (u2**2 + 2 * u3**2 + u3**4 / u2**2) / 2
    found = evaluated(laws.convexified_energy)(np.array([[u2], [u3]]))[0, 0]
    assert found == pytest.approx(expected, rel=1e-14)


@given(u3=number, share=st.floats(-1, 1, exclude_min=True, exclude_max=True))
def test_convexified_energy_is_that_of_twist_beyond(u3: float, share: float) -> None:
    found = evaluated(laws.convexified_energy)(np.array([[share * u3], [u3]]))[0, 0]
    assert found == pytest.approx(2 * u3**2, rel=1e-14)


@given(u2=number, u3=number)
def test_convexified_energy_is_a_minimum_over_the_curvature(u2: float, u3: float) -> None:
    least = minimize_scalar(
        lambda k: (k + u3**2 / k) ** 2 / 2,
        bounds=(abs(u2), abs(u2) + 2 * abs(u3)),
        method="bounded",
        options={"xatol": 1e-12},
    )
    smallest = min(least.fun, (abs(u2) + u3**2 / abs(u2)) ** 2 / 2)
    found = evaluated(laws.convexified_energy)(np.array([[u2], [u3]]))[0, 0]
    assert found == pytest.approx(smallest, rel=1e-9)


MOMENTS = np.array([[0.3, -1.2, 2.0, -0.01, 1.0], [1.0, 0.4, -3.0, -0.5, 0.0]])


def gap(law: RibbonLaw, limit: RibbonLaw) -> float:
    return float(np.abs(evaluated(law.strains)(MOMENTS) - evaluated(limit.strains)(MOMENTS)).max())


def test_homotopy_starts_at_the_rod() -> None:
    assert gap(HomotopyLaw(0.0, 0.0), KirchhoffLaw(1, 2)) <= 1e-15
    assert gap(HomotopyLaw(0.0, 0.1), KirchhoffLaw(1, 2)) <= 1e-15


def test_homotopy_ends_at_the_ribbon() -> None:
    assert gap(HomotopyLaw(1.0, 0.0), SadowskyLaw()) <= 1e-15
    assert gap(HomotopyLaw(1.0, 0.1), RegularizedLaw(0.1)) <= 1e-15


def test_variational_at_delta_one_is_a_rod() -> None:
    assert gap(VariationalLaw(1.0), KirchhoffLaw(1, 1)) <= 1e-15


@pytest.mark.parametrize(("family", "rate"), [(RegularizedLaw, 1), (VariationalLaw, 2)])
def test_families_tend_to_sadowsky_at_their_rate(family: Any, rate: int) -> None:
    small = np.array([1e-4, 5e-5])
    gaps = [gap(family(x), SadowskyLaw()) for x in small]
    assert np.log2(gaps[0] / gaps[1]) == pytest.approx(rate, abs=0.05)


@given(m2=number, m3=number, n2=number, n3=number)
@pytest.mark.parametrize(
    "law",
    [*WITH_ENERGY[:3], VariationalLaw(0.1), RegularizedLaw(0.1), HomotopyLaw(0.5, 0.0)],
    ids=str,
)
def test_more_moment_gives_more_strain(
    law: RibbonLaw, m2: float, m3: float, n2: float, n3: float
) -> None:
    m = np.array([[m2, n2], [m3, n3]])
    u = evaluated(law.strains)(m)
    work = ((m[:, 0] - m[:, 1]) * (u[:, 0] - u[:, 1])).sum()
    assert work >= -1e-13 * np.abs(m).max() * np.abs(u).max()


def test_bending_moment_and_curvature_have_one_sign_where_eta_is_allowed() -> None:
    m = moments_of(SadowskyLaw())
    u = evaluated(SadowskyLaw().strains)(m)
    assert (np.sign(u[0]) == np.sign(m[0])).all()
    assert (np.abs(u[1] / u[0]) <= 1).all()


def test_curvature_jumps_by_half_the_twisting_moment_where_bending_changes_sign() -> None:
    m = np.array([[1e-14, -1e-14, 0.0], [2.0, 2.0, 2.0]])
    u = evaluated(SadowskyLaw().strains)(m)
    np.testing.assert_allclose(u[0], [0.5, -0.5, 0.0], atol=1e-13)
    np.testing.assert_allclose(u[1], 0.5, atol=1e-13)
