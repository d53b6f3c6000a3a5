"""Extensible ribbons and Sano's: tables of the science notes, and energies written in mpmath."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import casadi as ca
import numpy as np
import pytest
from mpmath import mp, mpf

from ribbonopt.mechanics.laws.catalogue import is_linear
from ribbonopt.mechanics.laws.extensible import COEFFICIENTS, ExtensibleLaw, phi
from ribbonopt.mechanics.laws.kirchhoff import KirchhoffLaw
from ribbonopt.mechanics.laws.law import RibbonLaw, Stress
from ribbonopt.mechanics.laws.quartic_law import QuarticLaw
from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw
from ribbonopt.mechanics.laws.sano import SanoLaw
from ribbonopt.mechanics.laws.smooth import first_law, first_laws
from ribbonopt.scene import Extensible, Sano, Variational

Array = np.ndarray


def extensible(nu: float = 0.3, unit: float = 1.0, ratio: float = 20.0) -> ExtensibleLaw:
    """Return the law of a given k*, w / h being `ratio`."""
    width = 1 / (ratio * unit * np.sqrt(12 * (1 - nu**2)))
    return ExtensibleLaw(*map(ca.SX, (width, width / ratio, nu)))


def sano(B2: float = 1.0, B3: float = 2.0, zeta: float = 10.0) -> SanoLaw:
    return SanoLaw(*map(ca.SX, (B2, B3, zeta)))


LAWS = {
    "nu 0.3": extensible(0.3),
    "nu 0": extensible(0.0, 0.2),
    "nu 0.5": extensible(0.5, 3.0),
    "nu -0.6": extensible(-0.6),
    "sano": sano(),
    "sano, stiff": sano(10.0, 1.0, 1.0),
    "sano, soft": sano(0.1, 3.0, 0.5),
}
every = pytest.mark.parametrize("name", LAWS)


@cache
def function(law: RibbonLaw, which: str) -> Callable[[Array], Array]:
    """Return a member of a law, or a derivative of it ("strains''"), on arrays (2, n)."""
    x = ca.SX.sym("x", 2)
    found = getattr(law, which.rstrip("'"))(x[0], x[1])
    value = ca.vertcat(*found) if isinstance(found, tuple) else found
    for _ in range(which.count("'")):
        value = ca.vec(ca.jacobian(value, x))
    f = ca.Function("f", [x], [ca.densify(value)])
    return lambda points: np.array(f.map(points.shape[1])(points))


def scattered(law: QuarticLaw, count: int, seed: int = 0) -> Array:
    """Return moments (2, n) of both signs over 1e-3 to 3e3 units, half near the cusp."""
    rng = np.random.default_rng(seed)
    m = 10 ** rng.uniform(-3, 3.5, (2, count)) * float(ca.evalf(law.unit))
    near, limit = slice(0, count // 2), float(ca.evalf(law.limit))
    m[0, near] = limit * 10 ** rng.uniform(-5, 0, count // 2)
    side = rng.choice([-1, 1], count // 2)
    m[1, near] = limit * (1 + 0.9 * side * 10 ** rng.uniform(-4, 0, count // 2))
    return rng.choice([-1.0, 1.0], (2, count)) * m


# The tables of section 5.

TABLE = {
    (1, 1): (1.098030734467, 0.7130575632455, 0.9060674515577),
    (5, 8): (5.342645185769, 5.342104726819, 35.58126369746),
    (20, 60): (23.64211743235, 24.7056947196, 1073.52676553),
    (1, 150): (31.02010994026, 43.19145545676, 3649.711896145),
}


@pytest.mark.parametrize("unit", [1.0, 0.302613766334, 1e-4])
def test_table_of_the_extensible_ribbon(unit: float) -> None:
    law = extensible(0.3, unit)
    m = np.array(list(TABLE)).T * unit
    truth = np.array(list(TABLE.values())).T
    np.testing.assert_allclose(function(law, "strains")(m) / unit, truth[:2], rtol=2e-13)
    W = function(law, "complementary")(m)[0] / unit**2
    np.testing.assert_allclose(W, truth[2], rtol=5e-13)


def test_table_of_sanos_ribbon() -> None:
    m = np.array([[1, 3, 0.1], [1, 5, 2]])
    truth = [
        [1.029917823346, 3.343257530074, 0.5436546590726],
        [0.4271908942926, 1.893331144929, 0.5253866215936],
    ]
    np.testing.assert_allclose(function(sano(), "strains")(m), truth, rtol=5e-13)


def test_series_of_phi() -> None:
    truth = [2.77777777777777778e-3, -5.51146384479717813e-6, 1.10080921919546258e-8]
    truth += [-2.19912186434906634e-11, 4.39328784341353808e-14, -8.77667724308406123e-17]
    truth += [1.75335800483177188e-19, -3.50276557841570568e-22]
    np.testing.assert_allclose(COEFFICIENTS[:8], truth, rtol=1e-15)


def exact_phi(a: mpf) -> mpf:
    s = mp.sqrt(abs(a) / 2)
    R = (mp.cosh(s) - mp.cos(s)) / (mp.sinh(s) + mp.sin(s))
    return (mpf(1) / 2 - R / s) / s**4


def test_phi_and_its_derivatives_anywhere_without_overflow() -> None:
    x = ca.SX.sym("x")
    found = ca.Function("phi", [x], list(phi(x)))
    with mp.workdps(60):
        for a in (1e-6, 0.5, -1.9, 2.1, 5.999, 6.001, -6.1, 8, 22.4, 60, -1e3, 1e5):
            truth = [exact_phi(mpf(a)), *(mp.diff(exact_phi, mpf(a), k) for k in (1, 2))]
            for k, (value, exact) in enumerate(zip(found(a), truth, strict=True)):
                assert abs(mpf(float(value)) / exact - 1) < (3e-14, 5e-14, 2e-12)[k]
    assert np.isfinite([float(v) for v in found(1e12)]).all()
    assert [float(v) for v in found(0)] == [COEFFICIENTS[0], 0, 2 * COEFFICIENTS[1]]


def exact_energy(law: QuarticLaw) -> Callable[[mpf, mpf], mpf]:
    """Return W(u2, u3), written once more."""
    if isinstance(law, SanoLaw):
        B2, B3, zeta = (mpf(float(ca.evalf(x))) for x in (law.B2, law.B3, law.zeta))
        return lambda u2, u3: (B2 * u2**2 + B3 * u3**2 + u3**4 / (1 / zeta**2 + u2**2)) / 2
    assert isinstance(law, ExtensibleLaw)
    w, h, nu = (mpf(float(ca.evalf(x))) for x in (law.width, law.thickness, law.poisson_ratio))
    k = h / (w**2 * mp.sqrt(12 * (1 - nu**2)))

    def energy(u2: mpf, u3: mpf) -> mpf:
        a, b = u2 / k, u3 / k
        bent = (1 - nu**2) * a**2 / 2 + (1 - nu) * b**2
        return k**2 * (bent + (nu * a**2 + b**2) ** 2 * exact_phi(a) / 4)

    return energy


@every
def test_strains_have_the_moments_of_the_energy(name: str) -> None:
    law = LAWS[name]
    m = scattered(law, 60)
    u = function(law, "strains")(m)
    W = exact_energy(law)
    with mp.workdps(40):
        for (m2, m3), pair in zip(m.T, u.T, strict=True):
            u2, u3 = (mpf(float(v)) for v in pair)
            size = abs(m2) + abs(m3)
            assert abs(mp.diff(W, (u2, u3), (1, 0)) - m2) < 1e-13 * size
            assert abs(mp.diff(W, (u2, u3), (0, 1)) - m3) < 1e-13 * size


@every
def test_thousands_of_moments_are_inverted(name: str) -> None:
    law = LAWS[name]
    m = scattered(law, 4000, seed=1)
    u = function(law, "strains")(m)
    back = function(law, "moments")(u)
    H = function(law, "stored''")(u).reshape(2, 2, -1)
    # What rounding of the moments makes of the strains: the cusp is ill-conditioned.
    error = np.linalg.solve(H.transpose(2, 0, 1), (back - m).T[..., None])[..., 0].T
    condition = (np.abs(m).sum(axis=0) / np.linalg.norm(u, axis=0)) * np.linalg.norm(
        np.linalg.inv(H.transpose(2, 0, 1)), axis=(1, 2)
    )
    size = np.linalg.norm(error, axis=0) / np.linalg.norm(u, axis=0)
    assert (size <= 1e-13 * np.maximum(condition, 1)).all()
    assert (u * m >= 0).all()


@every
def test_no_strains_have_less_energy_under_these_moments(name: str) -> None:
    law = LAWS[name]
    unit = float(ca.evalf(law.unit))
    m = scattered(law, 200, seed=2)
    grid = unit * np.concatenate([[0], np.geomspace(1e-3, 1e4, 200)])
    a, b = (x.ravel() for x in np.meshgrid(grid, grid))
    W = function(law, "stored")(np.array([a, b]))[0]
    best = np.abs(m).T @ np.array([a, b]) - W
    assert (best.max(axis=1) <= function(law, "complementary")(m)[0] * (1 + 1e-12)).all()


@every
def test_derivatives_are_those_of_the_implicit_function(name: str) -> None:
    law = LAWS[name]
    m = scattered(law, 400, seed=3)
    u = function(law, "strains")(m)
    J = function(law, "strains'")(m).reshape(2, 2, -1).transpose(2, 1, 0)
    H = function(law, "stored''")(u).reshape(2, 2, -1).transpose(2, 1, 0)
    bent = np.linalg.norm(J, axis=(1, 2)) * np.linalg.norm(H, axis=(1, 2))
    assert (np.abs(J @ H - np.eye(2)).max(axis=(1, 2)) < 1e-11 * bent).all()
    # u'' from W''' u' u' + W'' u'' = 0.
    second = function(law, "strains''")(m).reshape(2, 2, 2, -1)
    third = function(law, "stored'''")(u).reshape(2, 2, 2, -1)
    truth = -np.einsum("nla,abcn,nbi,ncj->lijn", J, third, J, J)
    size = np.abs(truth).max(axis=(0, 1, 2)) + 1e-9 / float(ca.evalf(law.unit))
    # CasADi's order of the indices of a second derivative does not matter: it is symmetric.
    off = np.abs(second.transpose(2, 0, 1, 3) - truth).max(axis=(0, 1, 2))
    assert (off < 1e-7 * size * np.maximum(bent, 1)).all()


@every
def test_complementary_energy_has_the_strains_as_gradient_and_is_even(name: str) -> None:
    law = LAWS[name]
    m = scattered(law, 400, seed=4)
    u = function(law, "strains")(m)
    gradient = function(law, "complementary'")(m)
    assert (np.abs(gradient - u) <= 1e-10 * np.abs(u).max(axis=0)).all()
    for signs in ([[-1], [1]], [[1], [-1]]):
        np.testing.assert_array_equal(function(law, "strains")(signs * m), signs * u)


def test_no_moment_no_strain_and_a_rod_there() -> None:
    for law, B in ((LAWS["nu 0.3"], (0.91, 1.4)), (LAWS["sano, stiff"], (10, 1))):
        zero = np.zeros((2, 1))
        np.testing.assert_array_equal(function(law, "strains")(zero), zero)
        J = function(law, "strains'")(zero).reshape(2, 2)
        np.testing.assert_allclose(J, np.diag(1 / np.array(B)), rtol=1e-14, atol=1e-14)


# Convexity: up to a twisting moment, and the two sides beyond.


@pytest.mark.parametrize(("nu", "twist"), [(0.0, 24.5437409), (0.3, 27.3021471), (0.5, 28.8334037)])
def test_limit_of_convexity_of_the_extensible_ribbon(nu: float, twist: float) -> None:
    law = extensible(nu, 0.1)
    b, _ = law.quartic.limit
    assert float(ca.evalf(b)) == pytest.approx(twist, abs=1e-7)
    # Where W'' is singular at u2 = 0, by the energy itself.
    u = np.array([[0.0, 0.0], [0.1 * twist * 0.999, 0.1 * twist * 1.001]])
    bending = function(law, "stored''")(u)[0]
    assert bending[0] > 0 > bending[1]
    limit = float(ca.evalf(law.limit))
    m3 = function(law, "moments")(np.array([[0.0], [0.1 * twist]]))[1, 0]
    assert limit == pytest.approx(m3, rel=1e-8)
    if nu == 0.3:
        assert limit == pytest.approx(9.4754167, abs=1e-7)


@pytest.mark.parametrize(("B2", "B3", "zeta"), [(1, 2, 10), (0.5, 3, 2)])
def test_limit_of_convexity_of_sanos_ribbon(B2: float, B3: float, zeta: float) -> None:
    law = sano(B2, B3, zeta)
    twist = (B2 / zeta**4) ** 0.25
    m3 = B3 * twist + 2 * twist**3 * zeta**2
    assert float(ca.evalf(law.limit)) == pytest.approx(m3, rel=1e-14)


@every
def test_sides_are_the_law_below_the_limit_and_continue_it_beyond(name: str) -> None:
    law = LAWS[name]
    limit = float(ca.evalf(law.limit))
    sides = {chi: function(law.branch(chi), "strains") for chi in (1, -1)}
    whole = function(law, "strains")
    below = limit * np.array([[-0.3, -1e-3, 1e-9, 0.2], [0.9, -0.99, 0.5, 0.1]])
    for side in sides.values():
        np.testing.assert_array_equal(side(below), whole(below))
    t = np.linspace(-1, 1, 9) * 1e-3 * limit  # a side ends not far beyond
    across = np.array([t, np.full(9, 1.4 * limit)])
    u2, _ = sides[1](across)
    np.testing.assert_array_equal(u2[t > 0], whole(across)[0, t > 0])
    np.testing.assert_array_equal(-sides[-1](across * [[-1], [1]])[0], u2)
    assert (u2 > 0).all()
    # Analytic there: a polynomial through all values has its moments too, beyond m2 = 0.
    np.testing.assert_allclose(
        function(law, "moments")(sides[1](across)), across, atol=1e-12 * limit
    )
    fit = np.polynomial.Polynomial.fit(t[::2], u2[::2], 4)
    np.testing.assert_allclose(fit(t[1::2]), u2[1::2], rtol=1e-7)


@every
def test_both_sides_meet_with_one_energy_where_they_leap(name: str) -> None:
    law = LAWS[name]
    limit = float(ca.evalf(law.limit))
    for m3 in (1.01 * limit, -3 * limit):
        at = np.array([[0.0], [m3]])
        W = [function(law.branch(chi), "complementary")(at)[0, 0] for chi in (1, -1)]
        u = [function(law.branch(chi), "strains")(at)[:, 0] for chi in (1, -1)]
        assert W[0] == pytest.approx(W[1], rel=1e-13)
        np.testing.assert_allclose(u[0], [-u[1][0], u[1][1]], rtol=1e-12)
        assert abs(u[0][0]) > 0.1 * float(ca.evalf(law.unit))


def test_leaps_count_from_the_limit_on() -> None:
    law = LAWS["nu 0.3"]
    m3 = ca.DM([90.0, 94.754167, 100.0])
    leaps = [
        float(ca.evalf(law.switching(Stress.of_moment(ca.SX(ca.vertcat(0, 1, x)))).leap))
        for x in m3.full().ravel()
    ]
    assert leaps[0] == 0 and abs(leaps[1]) < 1e-6
    assert leaps[2] == pytest.approx(100 - 94.754167, abs=1e-6)


@every
def test_a_mixture_has_the_twist_of_both_sides(name: str) -> None:
    law = LAWS[name]
    limit, h = float(ca.evalf(law.limit)), 1e-4
    x = ca.SX.sym("x")
    u3, slope = (float(v) for v in ca.Function("f", [x], list(law.mixture.twist(x)))(1.5 * limit))
    m3 = np.array([1.5, 1.5 - h, 1.5 + h]) * limit
    truth = function(law.branch(1), "strains")(np.array([np.zeros(3), m3]))[1]
    assert u3 == pytest.approx(truth[0], rel=1e-14)
    assert slope == pytest.approx((truth[2] - truth[1]) / (2 * h * limit), rel=1e-6)


# Limits, with their rates.


def gaps(laws: list[QuarticLaw], limit: RibbonLaw) -> Array:
    """Return the largest difference of strains over a few moments, law by law."""
    m = np.array([[1.3, 0.4, -2.0], [0.9, 2.0, -0.3]])
    truth = function(limit, "strains")(m)
    return np.array([np.abs(function(law, "strains")(m) - truth).max() for law in laws])


def rates(values: Array, ratio: float) -> Array:
    return np.diff(np.log(values)) / np.log(ratio)


def test_extensible_ribbons_tend_to_sadowskys_as_the_root_of_the_unit() -> None:
    found = gaps([extensible(0.3, k) for k in (1e-5, 1e-6, 1e-7)], SadowskyLaw())
    np.testing.assert_allclose(rates(found, 0.1), 0.5, atol=0.01)


def test_extensible_ribbons_tend_to_rods_as_the_inverse_square_of_the_unit() -> None:
    found = gaps([extensible(0.3, k) for k in (1e2, 1e3, 1e4)], KirchhoffLaw(0.91, 1.4))
    np.testing.assert_allclose(rates(found, 10), -2, atol=0.01)


def test_sanos_ribbons_tend_to_sadowskys_and_to_rods_as_the_square_of_zeta() -> None:
    found = gaps([sano(zeta=z) for z in (1e2, 1e3, 1e4)], SadowskyLaw())
    np.testing.assert_allclose(rates(found, 10), -2, atol=0.01)
    found = gaps([sano(zeta=z) for z in (1e-2, 1e-3, 1e-4)], KirchhoffLaw(1, 2))
    np.testing.assert_allclose(rates(found, 0.1), 2, atol=0.01)


# What starts begin with.


def test_wide_ribbons_begin_with_another_law_and_narrow_ones_have_it_for_a_second_try() -> None:
    narrow = Extensible(width=0.05, thickness=0.0025, poisson_ratio=0.3)
    wide = Extensible(width=0.05, thickness=0.0001, poisson_ratio=0.3)
    assert first_law(narrow, 0.3) == narrow
    assert first_law(wide, 0.3) == Variational(delta=0.3)
    assert first_laws(narrow, 0.3) == (narrow, Variational(delta=0.3))
    assert first_laws(wide, 0.3) == (Variational(delta=0.3),)
    assert first_law(Sano(B2=1.0, B3=2.0, zeta=0.1), 0.3) == Sano(B2=1.0, B3=2.0, zeta=0.1)
    assert is_linear(narrow, up_to=28.0) and not is_linear(narrow, up_to=29.0)
