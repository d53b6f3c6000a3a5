"""Solutions in phases: what a scene may say of them, sampling, files, units, and use as a guess.

Truth: 28-digit numbers of the Moebius ribbon, whose m2 changes sign at half its length.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS

from ribbonopt.errors import ModelError, SceneError
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import SolutionGuess, load_scene
from ribbonopt.solution.solution import Solution

SADOWSKY = "law={type: sadowsky}"
NAMES = ("r", "d1", "d2", "d3", "n", "m", "u", "u2", "u3", "eta", "m2", "energy", "H")
Solved = Callable[..., Solution]


@pytest.fixture(scope="module")
def found(solved: Solved) -> Solution:
    return solved("moebius_whole", SADOWSKY)


@pytest.fixture(scope="module")
def saved(found: Solution, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("phases")
    save_solution(found, folder)
    return folder


def error(solution: Solution) -> float:
    gaps = solution.n0 - HALF_MOEBIUS["n0"], solution.m0 - HALF_MOEBIUS["m0"]
    return float(np.abs(gaps).max())


def test_two_phases_are_found(found: Solution) -> None:
    assert found.sheets == (1, -1)
    np.testing.assert_allclose(found.switch_points, [0.5], rtol=0, atol=1e-11)
    assert error(found) < 1e-9
    summary = summarize(found)
    assert summary["phases"] == [1, -1]
    assert summary["switch_points"] == pytest.approx([0.5], abs=1e-11)


def test_loading_gives_back_what_was_saved(found: Solution, saved: Path) -> None:
    loaded = load_solution(saved)
    s = np.concatenate([np.linspace(0, 1, 41), found.switch_points, found.nodes])
    for name in NAMES:
        np.testing.assert_array_equal(loaded.sample(s, name), found.sample(s, name))
    assert loaded.sheets == (1, -1)
    assert loaded.scene == found.scene
    assert loaded.status is found.status
    np.testing.assert_array_equal(loaded.switch_points, found.switch_points)
    np.testing.assert_array_equal(loaded.nodes, found.nodes)
    assert loaded.energy == found.energy


def test_loading_on_a_mesh_of_its_own(configs: Path, tmp_path: Path) -> None:
    # a tolerance leaves phases with numbers of elements that the scene does not say
    overrides = [SADOWSKY, "tolerance=1e-10", "transcription.degree=5", "transcription.intervals=9"]
    refined = solve(load_scene(configs / "moebius_whole.yaml", overrides))
    assert refined.verified, refined.message
    save_solution(refined, tmp_path)
    loaded = load_solution(tmp_path)
    s = np.linspace(0, 1, 57)
    for name in NAMES:
        np.testing.assert_array_equal(loaded.sample(s, name), refined.sample(s, name))
    assert error(loaded) < 1e-10 * max(HALF_MOEBIUS["n0"])


def test_sampling_at_the_switch_and_around_it(found: Solution) -> None:
    s = found.switch_points[0]
    at = found.sample(s, "u2")
    before, after = found.sample(np.array([s - 1e-10, s + 1e-10]), "u2")
    # figure 4: u3(1/2) = 4.934876749, and u2 jumps from one |u3| to the other
    assert before == pytest.approx(4.934876749, rel=1e-7)
    assert after == pytest.approx(-4.934876749, rel=1e-7)
    assert at == pytest.approx(after, rel=1e-7)  # where two meet, the later
    assert abs(found.sample(s, "m2")) < 1e-9
    for name in ("r", "d1", "d2", "d3", "n", "m", "u3", "H"):
        around = found.sample(np.array([s - 1e-12, s, s + 1e-12]), name)
        np.testing.assert_allclose(around, np.broadcast_to(around[1], around.shape), atol=1e-8)


def test_sampling_is_of_one_ribbon(found: Solution) -> None:
    # unsorted, scalar, at both ends, and nowhere: as of any solution
    s = np.array([0.9, 0.1, 0.5, 0.0, 1.0])
    rows = found.sample(s, "r")
    np.testing.assert_array_equal(rows, [found.sample(x, "r") for x in s])
    np.testing.assert_allclose(rows[3], 0, atol=1e-12)
    np.testing.assert_allclose(rows[4], 0, atol=1e-9)
    assert found.sample(0.5, "r")[0] == pytest.approx(HALF_MOEBIUS["x_end"], abs=1e-10)
    assert found.sample(np.empty(0), "r").shape == (0, 3)
    with pytest.raises(ValueError, match="expected in"):
        found.sample(1.1, "r")


def test_sampling_is_smooth_inside_phases(found: Solution) -> None:
    # n constant, r' = d3, m' = n x d3: by central differences across nodes and the switch
    s, h = np.linspace(0.01, 0.99, 99), 1e-5
    ahead, behind, here = found.outputs(s + h), found.outputs(s - h), found.outputs(s)
    slope = {name: (ahead[name] - behind[name]) / (2 * h) for name in ("r", "m")}
    np.testing.assert_allclose(slope["r"], here["d3"], atol=1e-3)
    np.testing.assert_allclose(slope["m"], np.cross(here["n"], here["d3"]), atol=1e-1)
    away = np.abs(s - 0.5) > 2 * h
    np.testing.assert_allclose(slope["r"][away], here["d3"][away], atol=1e-7)
    np.testing.assert_allclose(slope["m"][away], np.cross(here["n"], here["d3"])[away], atol=1e-5)


def test_nodes_and_quadrature_cover_both_phases(found: Solution) -> None:
    assert (np.diff(found.nodes) > 0).all()
    assert (found.nodes[0], found.nodes[-1]) == (0, 1)
    assert np.abs(found.nodes - 0.5).min() < 1e-11
    assert found.integral("energy") == pytest.approx(HALF_MOEBIUS["H"], rel=1e-10)
    assert abs(found.twist) == pytest.approx(0.3233117792, abs=1e-9)


@pytest.mark.parametrize("guess", ["guess=auto", "guess={force: [0, 43, 42], moment: [0, 2, -9]}"])
def test_switch_may_be_given(configs: Path, guess: str) -> None:
    given = solve(
        load_scene(configs / "moebius_regularized.yaml", [SADOWSKY, guess, "switching=[0.5]"])
    )
    assert given.verified, given.message
    assert given.sheets == (1, -1)
    np.testing.assert_allclose(given.switch_points, [0.5], rtol=0, atol=1e-11)
    assert error(given) < 1e-9


def test_given_switch_is_a_guess_only(configs: Path) -> None:
    near = solve(load_scene(configs / "moebius_whole.yaml", [SADOWSKY, "switching=[0.47]"]))
    assert near.verified, near.message
    np.testing.assert_allclose(near.switch_points, [0.5], rtol=0, atol=1e-11)
    assert error(near) < 1e-9


def test_off_is_off(configs: Path) -> None:
    overrides = ["switching=off", "law.epsilon=0.01"]
    plain = solve(load_scene(configs / "moebius_regularized.yaml", overrides))
    assert plain.verified, plain.message
    assert plain.sheets == ()
    assert plain.switch_points.shape == (0,)
    assert summarize(plain)["phases"] == []


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("moebius_variational", "law.delta=0.1"),
        ("moebius_half", SADOWSKY),
        ("moebius_whole", "law.delta=0.1"),
    ],
)
def test_laws_and_ribbons_without_a_switch_have_one_phase(
    solved: Solved, name: str, law: str
) -> None:
    assert solved(name, law).sheets == ()


@pytest.mark.parametrize("switching", ["[]", "[1.5]", "[-0.1]", "[0.6, 0.4]", "[0.5, 0.5]", "on"])
def test_switches_that_make_no_sense_are_bad_input(configs: Path, switching: str) -> None:
    with pytest.raises(SceneError, match="switching"):
        prepare(load_scene(configs / "moebius_whole.yaml", [SADOWSKY, f"switching={switching}"]))


def test_si_ribbon_in_phases_is_the_same_ribbon(configs: Path, found: Solution) -> None:
    whole = ["interval=[0, 0.3]", "boundary={loop: {half_twists: 1}}", "guess=auto"]
    si = solve(load_scene(configs / "ribbon_si.yaml", whole))
    assert si.verified, si.message
    assert si.sheets == (1, -1)
    np.testing.assert_allclose(si.switch_points, [0.15], rtol=0, atol=1e-11)
    # D w / L^2 and D w / L of that strip of film, from E h^3 w / (12 (1 - nu^2))
    stiffness = 4.5e9 * 1e-4**3 * 0.01 / (12 * (1 - 0.38**2))
    force, moment = stiffness / 0.3**2, stiffness / 0.3
    np.testing.assert_allclose(si.n0 / force, HALF_MOEBIUS["n0"], rtol=0, atol=1e-6)
    np.testing.assert_allclose(si.m0 / moment, HALF_MOEBIUS["m0"], rtol=0, atol=1e-6)
    assert si.energy / moment == pytest.approx(HALF_MOEBIUS["H"], rel=1e-7)
    assert si.sample(0.15, "r")[0] / 0.3 == pytest.approx(HALF_MOEBIUS["x_end"], abs=1e-8)
    given = solve(load_scene(configs / "ribbon_si.yaml", [*whole, "switching=[0.15]"]))
    assert given.sheets == (1, -1)
    np.testing.assert_allclose(given.n0, si.n0, rtol=0, atol=1e-9 * np.abs(si.n0).max())


def test_solution_in_phases_is_a_guess_for_itself(found: Solution) -> None:
    again = prepare(found.scene).solve(guess=found)
    assert again.verified, again.message
    assert again.sheets == (1, -1)
    assert again.iterations <= 3  # there is nothing left to do
    np.testing.assert_allclose(again.n0, found.n0, rtol=0, atol=1e-10)


@pytest.mark.parametrize(
    "law", ["{type: regularized, epsilon: 0.01}", "{type: variational, delta: 0.03}"]
)
def test_solution_in_phases_is_a_guess_for_other_laws(
    configs: Path, found: Solution, saved: Path, law: str
) -> None:
    scene = load_scene(configs / "moebius_whole.yaml", [f"law={law}"])
    direct = solve(scene)
    of_file = solve(replace(scene, guess=SolutionGuess(str(saved))))
    for other in (prepare(scene).solve(guess=found), of_file):
        assert other.verified, other.message
        assert other.sheets == direct.sheets
        np.testing.assert_allclose(other.n0, direct.n0, rtol=0, atol=1e-8)
        np.testing.assert_allclose(other.m0, direct.m0, rtol=0, atol=1e-8)


def test_solution_in_phases_is_a_guess_on_another_mesh(configs: Path, found: Solution) -> None:
    mesh = "transcription={type: collocation, scheme: gauss, degree: 5, intervals: 15}"
    scene = load_scene(configs / "moebius_whole.yaml", [SADOWSKY, mesh])
    other = prepare(scene).solve(guess=found)
    assert other.verified, other.message
    assert other.sheets == (1, -1)
    assert error(other) < 1e-5


@pytest.mark.parametrize(
    "setting",
    ["formulation=algebraic", "law={type: variational, delta: 0.1}", "law={type: kirchhoff}"],
)
def test_switches_where_there_can_be_none_are_refused(configs: Path, setting: str) -> None:
    scene = load_scene(configs / "moebius_regularized.yaml", ["switching=[0.5]", setting])
    with pytest.raises(ModelError, match=r"switching: \[0\.5\] is of no use here") as caught:
        prepare(scene)
    assert caught.value.key == "switching"
