"""The rod with finite B1: energy, inverse, natural strains, and what it says of itself."""

import casadi as ca
import numpy as np
import pytest

from ribbonopt.mechanics.laws.catalogue import capabilities, numbers_of, relation_of
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.laws.rod import RodLaw
from ribbonopt.scene import Boundary, Kirchhoff, Rod, Scene
from ribbonopt.scene.lens import paths_of, value_at, with_value

B, K = np.array([3.0, 1.0, 0.8]), np.array([0.4, 1.0, -0.5])
ROD = Rod(B=(3.0, 1.0, 0.8), natural=(0.4, 1.0, -0.5))


def scene(law: Rod) -> Scene:
    return Scene("rod", law, Boundary())


def numbers(*expressions: ca.SX) -> list[np.ndarray]:
    return [np.array(ca.evalf(e)).ravel() for e in expressions]


def test_strain_moment_and_energies() -> None:
    law, rng = RodLaw(ca.SX(B), ca.SX(K)), np.random.default_rng(4)
    for m in rng.uniform(-9, 9, (20, 3)):
        stress = Stress.of_moment(ca.SX(m))
        u, back, W, Leg = numbers(
            law.strain(stress),
            law.moment(law.strain(stress)),
            law.energy(law.strain(stress)),
            law.complementary_energy(stress),
        )
        np.testing.assert_allclose(u, m / B + K, rtol=1e-15)
        np.testing.assert_allclose(back, m, rtol=1e-13)
        assert W[0] == pytest.approx((B * (u - K) ** 2).sum() / 2, rel=1e-13)
        assert Leg[0] == pytest.approx(m @ u - W[0], rel=1e-13)


def test_numbers_are_named_by_directors_and_continued_by_these_names() -> None:
    assert numbers_of(ROD) == {
        **{f"B.d{i + 1}": B[i] for i in range(3)},
        **{f"natural.d{i + 1}": K[i] for i in range(3)},
    }
    this = scene(ROD)
    names = [name for name in paths_of(this) if name.startswith("law.")]
    assert names == [f"law.{name}" for name in numbers_of(ROD)]
    for name, value in numbers_of(ROD).items():
        assert value_at(this, f"law.{name}") == value
    assert with_value(this, "law.B.d3", 7.0).law == Rod(B=(3.0, 1.0, 7.0), natural=ROD.natural)
    assert with_value(this, "law.natural.0", 7.0).law == Rod(B=ROD.B, natural=(7.0, 1.0, -0.5))


@pytest.mark.parametrize(
    ("law", "natural", "spins"),
    [
        (Rod(), False, True),
        (Rod(B=(2, 2, 0.3), natural=(0, 0, 1.5)), True, True),
        (Rod(B=(2, 1, 0.3)), False, False),
        (Rod(natural=(0, 0.1, 0)), True, False),
        (Rod(natural=(0.1, 0, 0)), True, False),
    ],
)
def test_what_it_says_of_itself(law: Rod, natural: bool, spins: bool) -> None:
    found = capabilities(scene(law))
    assert (found.natural, found.spins, found.developable) == (natural, spins, False)
    assert found.components == (0, 1, 2)


def test_where_its_numbers_may_change_natural_strains_may_come() -> None:
    assert relation_of(scene(Rod()), ca.SX.sym, ca.SX.sym("s")).natural
    assert not capabilities(Scene("a", Kirchhoff(), Boundary())).natural


def test_a_tapered_one_spins_as_well() -> None:
    found = capabilities(Scene("rod", Rod(), Boundary(), width="1 - s/2"))
    assert (found.spins, found.natural, found.developable) == (True, False, False)
    assert not capabilities(Scene("rod", ROD, Boundary(), width="1 - s/2")).spins
