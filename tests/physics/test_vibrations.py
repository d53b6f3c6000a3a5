"""Natural frequencies against closed forms, and tables made by shooting and by Ritz's method."""

from math import pi, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq  # type: ignore[import-untyped]
from scipy.special import ellipe, ellipk  # type: ignore[import-untyped]

from ribbonopt.checks.modes import Modes, modes_of
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import loads_scene
from ribbonopt.scene.inertia import Inertia
from ribbonopt.solution.solution import Solution

ROD = "{type: kirchhoff, B2: 1, B3: 2}"
CLAMPED_FREE = [3.51601526850, 22.0344915647, 61.6972144136]
CLAMPED = [22.3732854481, 61.6728228679, 120.903391727]
#: of an arch between clamps a tenth nearer than its length: in its plane; across it by inertia
ARCH = [43.887343084, 75.755677798, 153.038438412, 236.991205734, 369.056035]
ACROSS = {
    Inertia(): [81.047681050, 432.356070077],
    Inertia(0, 1e-3): [77.656955730, 259.963847553, 479.869781797],
    Inertia(0, 1e-2): [58.097346758, 96.698798094, 169.500126172],
    Inertia(1e-2, 1e-2): [56.091989863, 95.175395787, 167.274265755],
}


def solved_text(text: str) -> Solution:
    solution = prepare(loads_scene(text)).solve()
    assert solution.verified, solution.message
    return solution


def modes(solution: Solution, count: int = 8, inertia: Inertia | None = None) -> Modes:
    found = modes_of(solution, count, inertia)
    assert not isinstance(found, str), found
    return found


def straight(end: str, degree: int = 6, intervals: int = 8, more: str = "") -> Solution:
    return solved_text(
        f"""
        name: straight
        law: {ROD}
        boundary:
          start: {{support: clamped, position: [0, 0, 0], directors: identity}}
          end: {end}
        transcription: {{type: collocation, degree: {degree}, intervals: {intervals}}}
        {more}
        """
    )


def arch_text(shortening: float, degree: int = 6, intervals: int = 20, law: str = ROD) -> str:
    """Return the arch between two clamps, with the loads that elliptic integrals tell."""
    k = brentq(lambda k: 2 * ellipe(k * k) / ellipk(k * k) - 2 + shortening, 1e-6, 0.95)
    force = 16 * ellipk(k * k) ** 2
    return f"""
    name: arch
    law: {law}
    boundary:
      start: {{support: clamped, position: [0, 0, 0], directors: identity}}
      end: {{support: clamped, position: [0, 0, {1 - shortening}], directors: identity}}
    guess: {{force: [0, 0, {-force}], moment: [0, {2 * k * sqrt(force)}, 0]}}
    transcription: {{type: collocation, degree: {degree}, intervals: {intervals}}}
    """


def ring_text(loop: str, interval: str, intervals: int) -> str:
    return f"""
    name: ring
    law: {ROD}
    boundary: {{loop: {loop}}}
    interval: {interval}
    transcription: {{type: collocation, degree: 8, intervals: {intervals}}}
    """


def agree(found: Modes, expected: list[float], chosen: np.ndarray, digits: float) -> None:
    """Frequencies are those of a table, to its digits, and to their own bars."""
    frequencies, errors = found.frequencies[chosen], found.errors[chosen]
    count = min(len(expected), len(frequencies))
    apart = np.abs(frequencies[:count] / expected[:count] - 1)
    assert count and apart.max() < digits
    assert (apart <= errors[:count] + digits).all()


def test_straight_strips_bend_about_their_width_alone() -> None:
    free = straight("{support: free}")
    found = modes(free, 3)
    agree(found, CLAMPED_FREE, np.arange(3), 1e-9)
    np.testing.assert_allclose(found.in_plane, 1, atol=1e-9)
    turned = modes(free, 8, Inertia(0, 0.01))
    across = turned.in_plane < 0.5
    agree(turned, [(2 * j - 1) / 2 * pi * sqrt(200) for j in (1, 2, 3)], across, 1e-9)
    agree(turned, CLAMPED_FREE, ~across, 1e-9)
    # They twist: nothing of the line moves, and the turn is that of a quarter wave.
    first = int(np.flatnonzero(across)[0])
    turn, s = turned.rotation[first], turned.s
    np.testing.assert_allclose(turn[:, :2], 0, atol=1e-8)
    np.testing.assert_allclose(np.abs(turn[:, 2]), np.sin(pi * s / 2), atol=1e-7)
    held = straight("{position: {x: 0, y: 0}, force: {z: 0}, directors: identity}")
    found = modes(held, 6, Inertia(0, 0.01))
    agree(found, CLAMPED, found.in_plane > 0.5, 1e-9)
    agree(found, [j * pi * sqrt(200) for j in (1, 2, 3)], found.in_plane < 0.5, 1e-9)


def test_the_shape_of_a_cantilever_that_vibrates() -> None:
    found = modes(straight("{support: free}", intervals=10), 1)
    k, s = sqrt(CLAMPED_FREE[0]), found.s
    ratio = (np.cosh(k) + np.cos(k)) / (np.sinh(k) + np.sin(k))
    shape = np.cosh(k * s) - np.cos(k * s) - ratio * (np.sinh(k * s) - np.sin(k * s))
    moved = found.displacement[0]
    np.testing.assert_allclose(moved[:, 0] * np.sign(moved[-1, 0]), shape / shape[-1], atol=1e-7)
    np.testing.assert_allclose(moved[:, 1:], 0, atol=1e-9)


@pytest.mark.parametrize("inertia", ACROSS)
def test_the_arch_in_its_plane_and_across(inertia: Inertia) -> None:
    solution = solved_text(arch_text(0.1))
    found = modes(solution, 12, inertia)
    agree(found, ARCH, found.in_plane > 0.5, 3e-9)
    agree(found, ACROSS[inertia], found.in_plane < 0.5, 3e-11)
    assert found.zero == () and found.told == "" and found.unit == "sqrt(Dw/(rho L^4))"
    sizes = np.linalg.norm(found.displacement, axis=2).max(axis=1)
    np.testing.assert_allclose(sizes[found.in_plane > 0.5], 1)


@pytest.mark.parametrize("degree, intervals", [(2, 16), (4, 5), (8, 4)])
def test_bars_hold_on_coarse_meshes(degree: int, intervals: int) -> None:
    found = modes(solved_text(arch_text(0.1, degree, intervals)), 8)
    inside = np.flatnonzero(found.in_plane > 0.5)[:5]
    apart = np.abs(found.frequencies[inside] / ARCH[: len(inside)] - 1)
    known = np.isfinite(found.errors[inside])
    assert (apart <= found.errors[inside])[known].all() and known[:3].all()
    # Nor are they useless.
    assert (found.errors[inside][:3] <= 1e3 * apart[:3] + 1e-6).all()


@pytest.mark.parametrize(
    "how",
    [
        "{type: collocation, scheme: lobatto, degree: 4, intervals: 10}",
        "{type: shooting, intervals: 4, steps: 2}",
        "{type: collocation, degree: 6, intervals: 3}\n    formulation: energy",
    ],
)
def test_bars_hold_whatever_found_the_shape(how: str) -> None:
    """Where its stages are not those of the second variation, or it is a minimum."""
    text, _, _ = arch_text(0.1).partition("transcription")
    found = modes(solved_text(f"{text}transcription: {how}\n"), 7)
    inside = np.flatnonzero(found.in_plane > 0.5)[:4]
    apart = np.abs(found.frequencies[inside] / ARCH[: len(inside)] - 1)
    assert (apart <= found.errors[inside]).all()


def test_a_planar_scene_in_its_plane_alone() -> None:
    text = arch_text(0.1) + "planar: true\n"
    solution = solved_text(text)
    inside = modes_of(solution, 5, planar=True)
    assert not isinstance(inside, str)
    agree(inside, ARCH, np.arange(5), 1e-8)
    assert inside.told == "in its plane alone"
    every = modes(solution, 7)
    np.testing.assert_allclose(np.sort(every.in_plane), [0, 0, 1, 1, 1, 1, 1], atol=1e-9)
    # This law is singular across the plane at the inflections of the arch, not in it.
    ribbon = solved_text(arch_text(0.1, law="{type: variational, delta: 0.1}") + "planar: true\n")
    inside = modes_of(ribbon, 5, planar=True)
    assert not isinstance(inside, str)
    agree(inside, ARCH, np.arange(5), 1e-8)
    every = modes(ribbon, 7)
    assert (np.isnan(every.errors) == (every.in_plane < 0.5)).all()
    assert "singular where it does not bend" in every.told


@pytest.mark.parametrize(
    "loop, interval, intervals",
    [("{half_twists: 0}", "[0, 1]", 12), ("{half_twists: 0, piece: half}", "[0, 0.5]", 6)],
)
def test_a_free_ring(loop: str, interval: str, intervals: int) -> None:
    """Closed forms; of a half that was solved the frequencies are those of the whole."""
    found = modes(solved_text(ring_text(loop, interval, intervals)), 10)
    k = np.repeat(np.arange(2.0, 6.0), 2)
    inside = (2 * pi) ** 2 * np.sqrt(k**2 * (k**2 - 1) ** 2 / (k**2 + 1))
    across = (2 * pi) ** 2 * np.sqrt(k**2 * (k**2 - 1) * (2 * (k**2 - 1) + 1))
    agree(found, inside.tolist(), found.in_plane > 0.5, 1e-10)
    agree(found, across.tolist(), found.in_plane < 0.5, 1e-10)
    assert found.zero == tuple(
        f"{motion} {axis}" for motion in ("translation along", "rotation about") for axis in "xyz"
    )
    assert found.s[-1] == pytest.approx(1) and found.negative == 0


def test_frequencies_in_hertz_of_a_cantilever() -> None:
    """A strip of polyester: the formula of textbooks, with the stiffness of a plate."""
    sizes = {"length": 0.3, "width": 0.01, "thickness": 1e-4, "youngs_modulus": 4.5e9}
    ribbon = ", ".join(f"{name}: {value}" for name, value in sizes.items())
    more = f"ribbon: {{{ribbon}, poisson_ratio: 0.38, density: 1390}}"
    solution = straight("{support: free}", more=more)
    found = modes(solution, 2)
    plate = sizes["youngs_modulus"] * 1e-12 / (12 * (1 - 0.38**2))
    rate = sqrt(plate / (1390 * 1e-4)) / 0.3**2
    np.testing.assert_allclose(found.frequencies, rate * np.array(CLAMPED_FREE[:2]) / (2 * pi))
    np.testing.assert_allclose(found.squared, (2 * pi * found.frequencies) ** 2)
    assert found.unit == "Hz" and found.s[-1] == pytest.approx(0.3)
    heavy = modes(straight("{support: free}", more=more + "\n        inertia: ribbon"), 8)
    torsion = pi / 2 * sqrt(2 / (0.01**2 / 12 / 0.3**2)) * rate / (2 * pi)
    assert np.abs(heavy.frequencies / torsion - 1).min() < 1e-6 or heavy.frequencies[-1] < torsion
    # Without a density there are no seconds.
    silent = modes(straight("{support: free}", more=more.replace(", density: 1390", "")), 3)
    agree(silent, CLAMPED_FREE, np.arange(3), 1e-9)
    assert silent.unit == "sqrt(Dw/(rho L^4))"


@pytest.mark.slow
def test_units_and_place_do_not_matter() -> None:
    """Thirty long, turned about z and shifted: frequencies follow, and shapes turn."""
    text = arch_text(0.1)
    one = modes(solved_text(text), 6, Inertia(1e-3, 1e-2))
    turned = text.replace("identity", "{turns: [{z: pi/2}]}").replace("[0, 0, 0]", "[1, 2, 0]")
    turned = turned.replace("[0, 0, 0.9]", "[1, 2, 27]") + "interval: [0, 30]\n"
    guess = text.partition("guess: ")[2].partition("\n")[0]
    two = modes(solved_text(turned.replace(guess, "{arc: 1.5}")), 6, Inertia(0.9, 9.0))
    np.testing.assert_allclose(two.frequencies, one.frequencies / 900, rtol=1e-8)
    np.testing.assert_allclose(two.in_plane, one.in_plane, atol=1e-8)
    assert two.s[-1] == 30
    inside = int(np.flatnonzero(one.in_plane > 0.5)[0])
    assert np.abs(one.displacement[inside][:, 1]).max() < 1e-6
    assert np.abs(two.displacement[inside][:, 0]).max() < 1e-6


@pytest.mark.slow
def test_a_wide_strip_has_more_mass() -> None:
    """Stiffness and mass go with the width, the inertia of turns with its cube."""
    even = modes(straight("{support: free}"), 6, Inertia(0, 0.01))
    wide = modes(straight("{support: free}", more="width: 2"), 8, Inertia(0, 0.01))
    for inside, ratio in ((True, 1.0), (False, 0.5)):
        one, two = (each.frequencies[(each.in_plane > 0.5) == inside] for each in (even, wide))
        np.testing.assert_allclose(two[:3], ratio * one[:3], rtol=1e-8)


@pytest.mark.parametrize(
    "change, words",
    [
        (("law", "{type: regularized, epsilon: 0.01}"), "no energy"),
        (("loads", "{pressure: 3}"), "pressure"),
        (("inertia", "ribbon"), "takes the width"),
    ],
)
def test_what_has_no_modes_says_why(change: tuple[str, str], words: str) -> None:
    key, value = change
    text = arch_text(0.1, intervals=8)
    if key == "law":
        text = text.replace(ROD, value)
    elif key == "loads":
        text += f"loads: {value}\n"
    solution = solved_text(text)
    inertia = "ribbon" if key == "inertia" else None
    assert words in str(modes_of(solution, 3, inertia))  # type: ignore[arg-type]


@pytest.mark.slow
@pytest.mark.parametrize("piece, length", [("whole", 2 * pi), ("half", pi)])
def test_a_ring_under_pressure(piece: str, length: float) -> None:
    """Of unit radius, in its plane: the pressure p takes p from k^2 - 1, and p = 3 buckles it."""
    for pressure in (2.5, 2.999, 4):
        ring = solved_text(
            f"""
            name: pressed
            law: {{type: kirchhoff}}
            planar: true
            boundary: {{loop: {{half_twists: 0, piece: {piece}}}}}
            interval: [0, {length!r}]
            loads: {{pressure: {pressure}}}
            guess: {{strains: [1, 0]}}
            transcription: {{type: collocation, degree: 8, intervals: 10}}
            """
        )
        found = modes(ring, 6)
        k = np.repeat(np.arange(2.0, 5.0), 2)
        expected = k**2 * (k**2 - 1) * (k**2 - 1 - pressure) / (k**2 + 1)
        np.testing.assert_allclose(found.squared, expected, rtol=1e-9, atol=1e-9)
        assert found.zero == ("translation along x", "translation along z", "rotation about y")
        assert found.negative == 2 * (pressure > 3) and found.told == "in its plane alone"


@pytest.mark.slow
def test_all_modes_of_a_strip_of_which_a_half_is_solved() -> None:
    """Those without the symmetry as well: one of them grows, which the half knows nothing of."""
    text = arch_text(0.25).replace("[0, 0, 0.75]", "[0, SHEAR, 0.75]") + "symmetric: d1\n"
    for shear, count in ((0.1, 0), (0.3, 1)):
        half = solved_text(text.replace("SHEAR", str(shear)))
        whole = solved_text(text.replace("SHEAR", str(shear)).replace("symmetric: d1", ""))
        found = modes(half, 5, Inertia(1e-3, 1e-2))
        assert found.negative == count and found.told == "" and found.s[-1] == pytest.approx(1)
        if not count:  # the whole goes over to another shape beyond the pitchfork
            other = modes(whole, 5, Inertia(1e-3, 1e-2))
            np.testing.assert_allclose(found.frequencies, other.frequencies, rtol=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("half", [False, True])
def test_an_isotropic_rod_spins_at_no_cost(half: bool) -> None:
    """About its clamp, of the whole or put together of a half; a ring about its line."""
    rod = "{type: rod, B: [1, 1, 0.8]}"
    text = arch_text(0.2, 8, 10, rod) + "symmetric: d1\n" * half
    for inertia in (Inertia(), Inertia(1e-3, 1e-3)):
        found = modes(solved_text(text), 4, inertia)
        assert found.zero == ("the rod, isotropic, turns about the tangent of its clamp",)
        assert found.squared[0] > 1e3 and found.negative == 0
    ring = solved_text(ring_text("{half_twists: 0}", "[0, 1]", 8).replace(ROD, rod))
    found = modes(ring, 4, Inertia(1e-3, 1e-3))
    assert len(found.zero) == 7 and found.zero[-1] == "sections turning about the line"
    assert len(found.squared) == 4 and found.squared[0] > 1e4
