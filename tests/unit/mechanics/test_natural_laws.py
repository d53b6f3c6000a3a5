"""Laws with natural strains against brute force, and each against itself.

Truth: the supremum of m . u - W over developable surfaces, W of the plate as it stands in textbooks
(no eigenvalue in it), by a grid and Newton's method in numpy; numbers of another program.
"""

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from ribbonopt.mechanics.laws.kirchhoff import KirchhoffLaw
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, RibbonLaw, Stress
from ribbonopt.mechanics.laws.natural import NaturalStrains
from ribbonopt.mechanics.laws.natural_sadowsky import NaturalSadowskyLaw
from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw, SingleSheetLaw
from ribbonopt.mechanics.laws.shifted import ShiftedLaw
from ribbonopt.mechanics.laws.variational import VariationalLaw

Array = np.ndarray
Numbers = tuple[float, float, float, float]  # k11, k12, k22, nu
RANDOM = np.random.default_rng(18)
LAWS: list[Numbers] = [
    (*(float(v) for v in RANDOM.normal(size=3) * (2, 1, 1)), float(RANDOM.uniform(0, 0.5)))
    for _ in range(40)
]


def natural(numbers: Numbers) -> NaturalStrains:
    return NaturalStrains(*map(ca.SX, numbers), ca.SX.sym("s"))


def with_strains(law: ConstitutiveLaw, numbers: Numbers) -> RibbonLaw:
    found = law.naturally(natural(numbers))
    assert isinstance(found, RibbonLaw)
    return found


def called(what: Callable[[ca.SX, ca.SX], object], pairs: Array) -> Array:
    """Return the values (k, n) of a function of two scalars at pairs (2, k)."""
    a = ca.SX.sym("a", 2)
    value = what(a[0], a[1])
    column = ca.densify(ca.vertcat(*value) if isinstance(value, tuple) else ca.vertcat(value))
    function = ca.Function("f", [a], [column])
    return np.array(function.map(pairs.shape[1])(pairs))


def plate(u2: Array, u3: Array, numbers: Numbers) -> Array:
    """Return the energy of a plate bent to a developable surface, from its definition."""
    k11, k12, k22, nu = numbers
    b22 = u3**2 / u2
    squares = (u2 - k11) ** 2 + 2 * (u3 - k12) ** 2 + (b22 - k22) ** 2
    return ((1 - nu) * squares + nu * (u2 + b22 - k11 - k22) ** 2) / 2


def supremum(m: Array, numbers: Numbers) -> tuple[Array, float]:
    """Return where m . u - W is largest, and its value there."""
    size = 6 + 2 * float(np.abs(m).max()) + 3 * max(map(abs, numbers))
    curvature, angle = np.meshgrid(
        np.linspace(-size, size, 801), np.linspace(-np.pi / 2, np.pi / 2, 403)[1:-1]
    )

    def gain(curvature: Array, angle: Array) -> Array:
        u2 = curvature * np.cos(angle) ** 2
        u3 = curvature * np.cos(angle) * np.sin(angle)
        return m[0] * u2 + m[1] * u3 - plate(u2, u3, numbers)

    with np.errstate(all="ignore"):
        best = int(np.nanargmax(gain(curvature, angle)))
    x, step = np.array([curvature.flat[best], angle.flat[best]]), np.array([size / 400, 0.01])
    for _ in range(60):  # a compass: no derivatives of anything
        tries = [x + step * np.array(way) for way in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))]
        tries += [x + step * np.array(way) for way in ((1, 1), (1, -1), (-1, 1), (-1, -1))]
        values = [float(gain(*t)) for t in tries]
        chosen = int(np.argmax(values))
        x, step = tries[chosen], step / 2 if chosen == 0 else step
    u2, u3 = x[0] * np.cos(x[1]) ** 2, x[0] * np.cos(x[1]) * np.sin(x[1])
    return np.array([u2, u3]), float(gain(*x))


def test_numbers_of_another_program() -> None:
    """SCIENCE: strain(1, 2) and W_Leg, twelve digits."""
    for numbers, strains, energy in (
        ((2.5, 0.0, 0.0, 0.3), (3.459373996368, 1.124932428780), 4.191015603883),
        ((2.5, 0.8, -0.4, 0.3), (3.426951175540, 1.448954866780), 4.806128202438),
    ):
        law = with_strains(SadowskyLaw(), numbers)
        moment = np.array([[1.0], [2.0]])
        np.testing.assert_allclose(called(law.strains, moment)[:, 0], strains, atol=6e-13)
        np.testing.assert_allclose(called(law.complementary, moment)[0, 0], energy, atol=6e-13)


@pytest.mark.parametrize("numbers", LAWS[:12])
def test_strains_are_those_of_the_largest_gain(numbers: Numbers) -> None:
    law = with_strains(SadowskyLaw(), numbers)
    for m in np.random.default_rng(3).normal(size=(3, 2)) * 4:
        u, gain = supremum(m, numbers)
        pair = m[:, None]
        assert called(law.complementary, pair)[0, 0] == pytest.approx(gain, abs=1e-9)
        np.testing.assert_allclose(called(law.strains, pair)[:, 0], u, atol=2e-4)


@pytest.mark.parametrize("numbers", LAWS)
def test_moment_undoes_strain_and_energies_add_up(numbers: Numbers) -> None:
    law, m = with_strains(SadowskyLaw(), numbers), RANDOM.normal(size=(2, 200)) * 5
    u = called(law.strains, m)
    np.testing.assert_allclose(called(law.moments, u), m, atol=1e-11)
    W, dual = called(law.stored, u)[0], called(law.complementary, m)[0]
    np.testing.assert_allclose(W + dual, (m * u).sum(axis=0), atol=1e-11)
    np.testing.assert_allclose(W, plate(*u, numbers), atol=1e-10)


@pytest.mark.parametrize("numbers", LAWS[:10])
def test_energy_is_the_least_over_curvatures_across(numbers: Numbers) -> None:
    """The program of the energy form: W_F = min over b of |b|^2 / 2 - K : b + C, any strains."""
    law, k = with_strains(SadowskyLaw(), numbers), natural(numbers)
    K11, K12, K22, C = (float(v) for v in (k.K11, k.K12, k.K22, k.constant))
    for u2, u3 in np.random.default_rng(5).normal(size=(12, 2)) * 2:

        def energy(b: Array, u2: float = u2, u3: float = u3) -> Array:
            size = np.maximum(np.abs(u2 + b), np.sqrt((u2 - b) ** 2 + 4 * u3**2))
            return size**2 / 2 - K11 * u2 - 2 * K12 * u3 - K22 * b + C

        centre, reach = 0.0, 60.0
        for _ in range(5):
            b = np.linspace(centre - reach, centre + reach, 2001)
            centre, reach = float(b[energy(b).argmin()]), reach / 400
        found = called(law.stored, np.array([[u2], [u3]]))[0, 0]
        assert found == pytest.approx(float(energy(np.array(centre))), abs=1e-8)


def test_what_a_sheet_allows_is_where_the_strain_returns() -> None:
    rng, wrong = np.random.default_rng(7), 0
    for numbers in LAWS:
        law = with_strains(SadowskyLaw(), numbers)
        u = rng.normal(size=(2, 300)) * 2
        k = natural(numbers)
        m = called(lambda a, b, c=k: _on_a_sheet(c, a, b), u)
        back = np.abs(called(law.strains, m) - u).max(axis=0) < 1e-7 * (1 + np.abs(u).max(axis=0))
        allowed = np.abs(called(k.slope, u)[0]) <= 1
        wrong += int((back != allowed).sum())
    assert wrong == 0


def _on_a_sheet(k: NaturalStrains, u2: ca.SX, u3: ca.SX) -> tuple[ca.SX, ca.SX]:
    eta = u3 / u2
    m2 = u2 * (1 - eta**4) - k.K11 + k.K22 * eta**2
    return m2, 2 * u3 * (1 + eta**2) - 2 * k.K12 - 2 * k.K22 * eta


@pytest.mark.parametrize("chi", [1, -1])
def test_sheets_go_on_beyond_the_switch(chi: int) -> None:
    for numbers in LAWS[:10]:
        law = with_strains(SingleSheetLaw(ca.SX(chi)), numbers)
        whole = with_strains(SadowskyLaw(), numbers)
        m = np.random.default_rng(1).normal(size=(2, 300)) * 4
        k = natural(numbers)
        T = m[0] + float(k.K11) + float(k.K22)
        same = np.abs(called(law.strains, m) - called(whole.strains, m)).max(axis=0) < 1e-12
        np.testing.assert_array_equal(same, chi * T > 0)
        gradient = called(
            lambda a, b, f=law: tuple(ca.vertsplit(_gradient(f.complementary, a, b))), m
        )
        np.testing.assert_allclose(called(law.strains, m), gradient, atol=1e-11)


def _gradient(what: Callable[[ca.SX, ca.SX], ca.SX], m2: ca.SX, m3: ca.SX) -> ca.SX:
    a = ca.SX.sym("m", 2)
    return ca.substitute(ca.gradient(what(a[0], a[1]), a), a, ca.vertcat(m2, m3))


@pytest.mark.parametrize("delta", [1.0, 0.1, 1e-3])
def test_smooth_law_is_the_gradient_of_a_convex_energy(delta: float) -> None:
    for numbers in LAWS[:8]:
        law = with_strains(VariationalLaw(ca.SX(delta)), numbers)
        m = np.random.default_rng(2).normal(size=(2, 100)) * 4
        gradient = called(
            lambda a, b, f=law: tuple(ca.vertsplit(_gradient(f.complementary, a, b))), m
        )
        np.testing.assert_allclose(called(law.strains, m), gradient, atol=1e-11)
        ends = called(law.complementary, m)[0]
        middle = called(law.complementary, (m[:, ::2] + m[:, 1::2]) / 2)[0]
        assert (middle <= (ends[::2] + ends[1::2]) / 2 + 1e-12).all()


def test_smooth_law_comes_near_the_sharp_one() -> None:
    numbers, m = LAWS[0], np.random.default_rng(2).normal(size=(2, 100)) * 4
    sharp = called(with_strains(SadowskyLaw(), numbers).strains, m)
    gaps = [
        np.median(
            np.abs(called(with_strains(VariationalLaw(ca.SX(d)), numbers).strains, m) - sharp)
        )
        for d in (1e-2, 1e-3)
    ]
    assert gaps[1] < 0.02 * gaps[0]


def test_without_curvature_across_all_laws_are_shifted() -> None:
    """K22 = 0: the explicit form and the shift of the moments are one."""
    numbers, m = (1.5, 0.4, 0.0, 0.0), np.random.default_rng(4).normal(size=(2, 200)) * 3
    k = natural(numbers)
    for base in (SadowskyLaw(), VariationalLaw(ca.SX(0.05)), SingleSheetLaw(ca.SX(-1))):
        explicit, shifted = with_strains(base, numbers), ShiftedLaw(base, k)
        for read in (_strain, _complementary):
            np.testing.assert_allclose(read(explicit, m), read(shifted, m), atol=1e-12)


def _strain(law: ConstitutiveLaw, m: Array) -> Array:
    return called(lambda a, b: law.strain(_stress(a, b)), m)


def _complementary(law: ConstitutiveLaw, m: Array) -> Array:
    return called(lambda a, b: law.complementary_energy(_stress(a, b)), m)


def test_a_shifted_rod_has_its_energy() -> None:
    numbers, u = (1.5, 0.4, 0.0, 0.0), np.random.default_rng(4).normal(size=(2, 50))
    law = ShiftedLaw(KirchhoffLaw(ca.SX(1.0), ca.SX(2.0)), natural(numbers))
    energy = called(lambda a, b: law.energy(ca.vertcat(0, a, b)), u)[0]
    whole = (u[0] - 1.5) ** 2 / 2 + (u[1] - 0.4) ** 2
    np.testing.assert_allclose(energy, whole, atol=1e-12)
    m = called(lambda a, b: law.moment(ca.vertcat(0, a, b)), u)
    np.testing.assert_allclose(m, [u[0] - 1.5, 2 * (u[1] - 0.4)], atol=1e-12)


def test_all_is_finite_where_the_law_is_singular() -> None:
    """R = 0 (any strains of a disc, the middle of it is taken), T = 0, and both."""
    numbers = (0.0, 0.0, 2.0, 0.0)
    for base in (SadowskyLaw(), VariationalLaw(ca.SX(0.01)), SingleSheetLaw(ca.SX(1))):
        law = with_strains(base, numbers)
        m = np.array([[2.0, -2.0, 0.0, -2.0], [0.0, 0.0, 0.0, 1.0]])
        assert np.isfinite(called(law.strains, m)).all()
        slopes = called(lambda a, b, f=law: ca.vec(_slopes(f, a, b)), m)
        assert np.isfinite(slopes).all()
    u = called(NaturalSadowskyLaw(natural(numbers)).strains, np.array([[2.0], [0.0]]))
    np.testing.assert_allclose(u[:, 0], (1.0, 0.0))


def _slopes(law: RibbonLaw, m2: ca.SX, m3: ca.SX) -> ca.SX:
    a = ca.SX.sym("m", 2)
    slopes = ca.jacobian(ca.vertcat(*law.strains(a[0], a[1])), a)
    return ca.substitute(ca.densify(slopes), a, ca.vertcat(m2, m3))


def _stress(m2: ca.SX, m3: ca.SX) -> Stress:
    return Stress.of_moment(ca.vertcat(0, m2, m3))
