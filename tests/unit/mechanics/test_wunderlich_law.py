"""Wunderlich's law against its energy: what is stationary, and its functions in many digits."""

from typing import Any

import casadi as ca
import mpmath as mp
import numpy as np
import pytest

from ribbonopt.mechanics.laws.gathering import gathering, log_factor, xi_of
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.laws.natural import NaturalStrains
from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw
from ribbonopt.mechanics.laws.wunderlich import DirectWunderlichLaw, WunderlichLaw

WIDTH = 0.13
NATURAL = NaturalStrains(*(ca.SX(k) for k in (1.5, -0.4, 0.7, 0.3)), ca.SX.sym("s"))
LAWS = (None, NATURAL)


def evaluated(make: Any) -> Any:
    x = ca.SX.sym("x")
    value = make(x)
    slope = ca.jacobian(value, x)
    return ca.Function("f", [x], [value, slope])


def exact(xi: mp.mpf) -> mp.mpf:
    return (mp.sinh(2 * xi) - 2 * xi) / (4 * xi**2)


def test_xi_and_its_slope_are_exact_over_a_hundred_and_thirty_decades() -> None:
    found = evaluated(xi_of)
    with mp.workdps(40):
        for exponent in np.linspace(-9, 120, 259):
            g = mp.mpf(10) ** mp.mpf(exponent)
            value, slope = (float(v) for v in found(float(g)))
            true = mp.findroot(lambda x, g=g: mp.log(exact(x) / g), mp.mpf(value))
            assert abs(value / true - 1) < 1e-14
            change = (mp.cosh(2 * true) - 1) / (2 * true**2) - 2 * exact(true) / true
            assert abs(slope * change - 1) < 1e-13


def test_g_and_phi_are_exact_and_even_or_odd() -> None:
    g, phi = evaluated(gathering), evaluated(log_factor)
    with mp.workdps(40):
        for x in np.concatenate([np.logspace(-8, np.log10(300), 60)]):
            true = mp.mpf(float(x))
            assert abs(float(g(x)[0]) / exact(true) - 1) < 1e-13
            assert abs(float(phi(x)[0]) / (true * mp.coth(true)) - 1) < 1e-14
            assert float(g(-x)[0]) == -float(g(x)[0])
            assert float(phi(-x)[0]) == float(phi(x)[0])
    assert float(g(0.0)[0]) == 0.0
    assert float(phi(0.0)[0]) == 1.0


@pytest.mark.parametrize("natural", LAWS, ids=("flat", "natural"))
def test_strains_and_rates_are_those_where_the_lagrangian_is_stationary(natural: Any) -> None:
    """L = W - m . u - p eta' over u2 and xi, and p' = dL/d eta: written out in numbers here."""
    law = WunderlichLaw(ca.SX(WIDTH), natural)
    m, own = ca.SX.sym("m", 3), ca.SX.sym("own", 2)
    stress = Stress(ca.SX.zeros(3), m, own)
    u = law.strain(stress)
    W, conjugate = law.densities(stress, u)
    f = ca.Function("f", [m, own], [u, law.rates(stress, u), W, conjugate])
    with mp.workdps(30):
        K11, K12, K22, C = (0.0,) * 4
        if natural is not None:
            k11, k12, k22, nu = 1.5, -0.4, 0.7, 0.3
            K11, K12, K22 = k11 + nu * k22, (1 - nu) * k12, k22 + nu * k11
            C = ((1 - nu) * (k11**2 + 2 * k12**2 + k22**2) + nu * (k11 + k22) ** 2) / 2

        def lagrangian(u2: Any, xi: Any, eta: Any, m2: Any, m3: Any, p: Any) -> Any:
            W = u2**2 * (1 + eta**2) ** 2 * xi * mp.coth(xi) / 2 + C
            W -= u2 * (K11 + 2 * K12 * eta + K22 * eta**2)
            return W - m2 * u2 - m3 * eta * u2 - p * 2 / WIDTH * mp.tanh(xi)

        rng = np.random.default_rng(3)
        for _ in range(20):
            m2, m3, eta, p = rng.normal(size=4) * (5, 5, 0.5, 0.02)
            (u1, u2, u3), (turning, change), W, conjugate = (
                np.array(v).ravel() for v in f([9.0, m2, m3], [eta, p])
            )
            assert u1 == 0
            assert u3 == pytest.approx(eta * u2, rel=1e-14)
            xi = mp.atanh(mp.mpf(float(turning)) * WIDTH / 2)
            at = (mp.mpf(float(u2)), xi, mp.mpf(float(eta)), m2, m3, p)
            size = 1 + abs(m2) + abs(m3)
            assert abs(mp.diff(lagrangian, at, (1, 0, 0, 0, 0, 0))) < 1e-11 * size
            assert abs(mp.diff(lagrangian, at, (0, 1, 0, 0, 0, 0))) < 1e-10 * size
            assert change == pytest.approx(
                float(mp.diff(lagrangian, at, (0, 0, 1, 0, 0, 0))), rel=1e-9, abs=1e-9
            )
            stored = lagrangian(*at[:3], 0, 0, 0)
            assert float(W[0]) == pytest.approx(float(stored), rel=1e-12)
            assert float(conjugate[0]) == pytest.approx(-float(lagrangian(*at)), rel=1e-11)


def test_parallel_generatrices_are_sadowskys() -> None:
    law, m = WunderlichLaw(ca.SX(WIDTH)), ca.SX([0, 1.3, -0.8])
    sheet = SadowskyLaw().strain(Stress.of_moment(m))
    eta = sheet[2] / sheet[1]
    stress = Stress(ca.SX.zeros(3), m, ca.vertcat(eta, 0))
    found = ca.Function("f", [], [law.strain(stress) - sheet])()["o0"]
    np.testing.assert_allclose(np.array(found), 0, atol=1e-15)


@pytest.mark.parametrize("natural", LAWS, ids=("flat", "natural"))
def test_the_energy_form_says_the_same_of_its_controls(natural: Any) -> None:
    law = WunderlichLaw(ca.SX(WIDTH), natural)
    direct = law.direct()
    assert isinstance(direct, DirectWunderlichLaw)
    assert direct.direct() is direct
    assert isinstance(direct.indirect(), WunderlichLaw)
    m, own = ca.SX.sym("m", 3), ca.SX.sym("own", 2)
    stress = Stress(ca.SX.zeros(3), m, own)
    u = law.strain(stress)
    W, conjugate = law.densities(stress, u)
    xi = law.xi(stress)
    known = stress._replace(own=own[:1])
    program = direct.relaxed(known)
    assert program is not None
    assert program.strain is not None
    assert program.complementary is not None
    assert program.rates is not None
    parts = [program.cost - W, program.complementary - conjugate, program.own["p"] - own[1]]
    parts += [program.rates - law.rates(stress, u)[0], *ca.vertsplit(program.strain - u)]
    parts += ca.vertsplit(direct.controls_for(known, program.rates) - program.controls)
    values = ca.vertcat(*ca.substitute(parts, [program.controls], [ca.vertcat(u[1], xi)]))
    f = ca.Function("f", [m, own], [values])
    rng = np.random.default_rng(4)
    for _ in range(20):
        m2, m3, eta, p = rng.normal(size=4) * (5, 5, 0.5, 0.02)
        np.testing.assert_allclose(np.array(f([0, m2, m3], [eta, p])), 0, atol=1e-10)


def test_an_unbent_ribbon_has_no_strain_and_finite_slopes() -> None:
    law = WunderlichLaw(ca.SX(WIDTH))
    m, own = ca.SX.sym("m", 3), ca.SX.sym("own", 2)
    stress = Stress(ca.SX.zeros(3), m, own)
    u = law.strain(stress)
    f = ca.Function("f", [m, own], [u, ca.jacobian(u, ca.vertcat(m, own))])
    value, slope = f([0, 0, 0], [0, 0])
    assert not np.array(value).any()
    assert np.isfinite(np.array(slope)).all()
