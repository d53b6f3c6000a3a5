"""Laws with finite stiffness in the ribbon's plane: energies, controls, mixtures, what is said."""

from itertools import product

import casadi as ca
import numpy as np
import pytest

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.catalogue import capabilities, relation_of
from ribbonopt.mechanics.laws.kirchhoff import KirchhoffLaw
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.mechanics.laws.membrane import with_membrane
from ribbonopt.mechanics.laws.natural import NaturalStrains
from ribbonopt.mechanics.laws.natural_sadowsky import NaturalSadowskyLaw
from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw
from ribbonopt.mechanics.laws.shifted import ShiftedLaw
from ribbonopt.mechanics.laws.tapered import tapered
from ribbonopt.mechanics.laws.variational import VariationalLaw
from ribbonopt.scene import (
    Boundary,
    Homotopy,
    Kirchhoff,
    Membrane,
    Regularized,
    Rod,
    Sadowsky,
    Scene,
    SingleSheet,
    Variational,
)

B1, EA = 5.0, 30.0
BOTH = {"bending": ca.SX(B1), "stretching": ca.SX(EA)}
s = ca.SX.sym("s")
SMOOTH: dict[str, ConstitutiveLaw] = {
    "kirchhoff": KirchhoffLaw(ca.SX(1.3), ca.SX(0.7)),
    "variational": VariationalLaw(ca.SX(0.2)),
    "sadowsky": SadowskyLaw(),
}


def values(expression: ca.SX, *pairs: tuple[ca.SX, np.ndarray]) -> np.ndarray:
    function = ca.Function("f", [symbol for symbol, _ in pairs], [ca.densify(expression)])
    (found,) = function.call([value for _, value in pairs])
    return np.array(found).ravel()


@pytest.mark.parametrize("name", SMOOTH)
def test_strains_are_the_gradient_of_the_complementary_energy(name: str) -> None:
    law, n, m = with_membrane(SMOOTH[name], BOTH, 1.0, s), ca.SX.sym("n", 3), ca.SX.sym("m", 3)
    stress = Stress(n, m, ca.SX(0, 1))
    dual, rng = law.complementary_energy(stress), np.random.default_rng(2)
    for forces, moments in rng.uniform(-4, 4, (5, 2, 3)):
        at = (n, forces), (m, moments)
        u = values(law.strain(stress), *at)
        np.testing.assert_allclose(u, values(ca.gradient(dual, m), *at), rtol=1e-12)
        assert u[0] == pytest.approx(moments[0] / B1)
        (e,) = values(law.extension(stress), *at)
        np.testing.assert_allclose(values(ca.gradient(dual, n), *at), (0, 0, e), atol=1e-15)
        assert e == pytest.approx(forces[2] / EA)
        W, Leg = (values(each, *at)[0] for each in law.densities(stress, law.strain(stress)))
        assert W + Leg == pytest.approx(moments @ u + forces[2] * e)
        assert W - EA * e**2 / 2 == pytest.approx(values(law.energy(ca.SX(u)))[0])
        np.testing.assert_allclose(values(law.moment(ca.SX(u))), moments, rtol=1e-9)


@pytest.mark.parametrize("name", SMOOTH)
def test_controls_stand_for_the_stress(name: str) -> None:
    law = with_membrane(SMOOTH[name], BOTH, 1.0, s)
    n, m = ca.SX([0.0, 0.0, 7.0]), ca.SX([1.0, 2.0, 3.0])
    z = law.controls_at(Stress(n, m, ca.SX(0, 1)))
    again = law.stress_of(z, ca.SX(0, 1))
    assert z.numel() == 4
    for found, given in zip(again, (n, m), strict=False):
        np.testing.assert_allclose(values(found), values(given))
    assert values(z[0])[0] ** 2 / 2 == pytest.approx(1 / (2 * B1))  # each has half its square
    assert values(z[1])[0] ** 2 / 2 == pytest.approx(49 / (2 * EA))


@pytest.mark.parametrize("name", SMOOTH)
def test_the_implicit_law_has_its_strain_for_solution(name: str) -> None:
    law = with_membrane(SMOOTH[name], BOTH, 1.0, s)
    found = law.implicit(Stress.of_moment(ca.SX([1.0, 2.0, 1.5])))
    off = ca.substitute(found.equations, found.unknowns, found.estimate)
    assert np.abs(values(off)).max() < 1e-13
    assert found.unknowns.numel() == found.equations.numel()


WIDTH = 1 - 0.4 * s + 0.1 * s**2
CURVED = NaturalStrains(0.3 + 0.2 * s + 0.1 * s**2, 0.1 * s, 0.2 * s**2, ca.SX(0.3), s, WIDTH)
EVEN = NaturalStrains(0.3 + 0.2 * s + 0.1 * s**2, 0.1 * s, 0.2 * s**2, ca.SX(0.3), s)
MIXED = {
    "plain": (SadowskyLaw(), 1.0),
    "tapered": (tapered(SadowskyLaw(), WIDTH, s), WIDTH),
    "curved": (NaturalSadowskyLaw(EVEN), 1.0),
    "both": (tapered(NaturalSadowskyLaw(CURVED), WIDTH, s), WIDTH),
}
FINITE = {"rigid": {}, "bending": ["bending"], "stretching": ["stretching"], "all": list(BOTH)}


@pytest.mark.parametrize("loaded", [False, True])
@pytest.mark.parametrize(("name", "finite"), list(product(MIXED, FINITE)))
def test_in_a_mixture_the_switch_is_linear_in_s(name: str, finite: str, loaded: bool) -> None:
    """T'' = 0 by the equations of the rod, at any stress, loads and couples along it too.

    And where its drift vanishes, T' = 0.
    """
    base, width = MIXED[name]
    law = with_membrane(base, {name: BOTH[name] for name in FINITE[finite]}, width, s)
    n, m, c, v = (ca.SX.sym(name, 3) for name in "nmcv")
    load = ca.vertcat(1 + s, 2 - s**2, s / 2) if loaded else ca.SX.zeros(3)
    couple, varying = (c, v) if loaded else (ca.SX.zeros(3), ca.SX.zeros(3))
    e = law.extension(Stress(n, m, ca.SX(0, 1)))
    # As `loaded_stress` hands them on: less what varies of the couple about d2.
    known = load - ca.vertcat(varying[1] / (1 + e), 0, 0), couple
    stress = Stress(n, m, ca.SX(0, 1), *(known if loaded else (None, None)))
    u = law.branch(0).strain(stress)
    along = ca.vertcat(0, 0, 1 + e)
    rates = ca.vertcat(
        -ca.cross(u, n) - load,
        -ca.cross(u, m) + ca.cross(n, along) - couple,
        varying - ca.cross(u, couple),
    )
    x = ca.vertcat(n, m, c)

    def rate(value: ca.SX) -> ca.SX:
        return ca.jtimes(value, x, rates) + ca.jacobian(value, s)

    first = rate(law.switching(stress).value)
    drift = list(law.zeros(0, stress).values())[1]
    rng = np.random.default_rng(3)
    for _ in range(3):
        at = [(symbol, rng.uniform(-2, 2, 3)) for symbol in (n, m, c, v)]
        place = (s, rng.uniform(0.1, 0.9))
        assert abs(values(rate(first), *at, place)[0]) < 1e-11
        share = values(first / ca.SX(width) + drift, *at, place)
        assert abs(share[0]) < 1e-12


def test_its_stiffnesses_grow_with_the_width() -> None:
    law = with_membrane(tapered(SMOOTH["kirchhoff"], ca.SX(2.0), s), BOTH, 2.0, s)
    stress = Stress(ca.SX([0.0, 0.0, 3.0]), ca.SX([1.0, 1.0, 1.0]), ca.SX(0, 1))
    u = values(law.strain(stress))
    np.testing.assert_allclose(u, (1 / (8 * B1), 1 / (2 * 1.3), 1 / (2 * 0.7)))
    assert values(law.extension(stress))[0] == pytest.approx(3 / (2 * EA))


EVERY = [
    Kirchhoff(),
    Sadowsky(),
    SingleSheet(),
    Regularized(epsilon=0.1),
    Homotopy(rho=0.5, epsilon=0.1),
    Variational(delta=0.1),
]


@pytest.mark.parametrize("law", EVERY, ids=lambda law: law.type)
def test_it_says_of_itself_what_the_law_does(law: object) -> None:
    plain = capabilities(Scene("a", law, Boundary()))  # type: ignore[arg-type]
    found = capabilities(
        Scene("a", law, Boundary(), membrane=Membrane(bending=3.0))  # type: ignore[arg-type]
    )
    for name in ("variational", "bounds_eta", "developable", "smooth", "linear_at_zero"):
        assert getattr(found, name) == getattr(plain, name)
    for name in ("natural", "kinked", "sheeted", "switch_name", "closed_moment", "states"):
        assert getattr(found, name) == getattr(plain, name)
    assert (plain.edgewise, plain.stretches, plain.components) == (False, False, (1, 2))
    assert (found.edgewise, found.stretches, found.components) == (True, False, (0, 1, 2))
    stretched = Scene("a", law, Boundary(), membrane=Membrane(stretching=3.0))  # type: ignore[arg-type]
    assert capabilities(stretched).stretches and not capabilities(stretched).edgewise


def test_which_ones_spin() -> None:
    law = Kirchhoff(B2=1.5, B3=0.7)

    def spins(bending: float, **more: str) -> bool:
        scene = Scene("a", law, Boundary(), membrane=Membrane(bending=bending), **more)  # type: ignore[arg-type]
        return capabilities(scene).spins

    assert spins(1.5) and not spins(1.6)
    assert not spins(1.5, width="1 - s/2")  # B1 is as its cube
    scene = Scene("a", Kirchhoff(), Boundary(), membrane=Membrane(bending=1.0))
    assert relation_of(scene, ca.SX.sym, ca.SX.sym("s")).spins  # of symbols: it may


def test_a_law_with_a_b1_of_its_own_takes_no_other() -> None:
    rod = Rod()
    stretched = Scene("a", rod, Boundary(), membrane=Membrane(stretching=9.0))
    assert capabilities(stretched).components == (0, 1, 2)
    with pytest.raises(ModelError, match=r"membrane\.bending: the law bends about d1 too"):
        capabilities(Scene("a", rod, Boundary(), membrane=Membrane(bending=9.0)))


def test_natural_strains_shift_what_is_inside() -> None:
    strains = NaturalStrains(ca.SX(0.4), ca.SX(0.1), ca.SX(0), ca.SX(0), s)
    law = with_membrane(ShiftedLaw(SMOOTH["kirchhoff"], strains), BOTH, 1.0, s)
    u = values(law.strain(Stress.of_moment(ca.SX([2.0, 0.0, 0.0]))))
    np.testing.assert_allclose(u, (2 / B1, 0.4 / 1.3, 0.2 / 0.7))
