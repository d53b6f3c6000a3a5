"""What is not done twice: verification, meshes, passes without phases, bars, mechanics."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS

import ribbonopt.attempt.attempt as attempt
import ribbonopt.pipeline.refinement as refinement
from ribbonopt.accuracy.estimate import Analysis
from ribbonopt.checks.phase_margins import phase_problems
from ribbonopt.checks.topology import count_half_twists
from ribbonopt.output.results import save_solution
from ribbonopt.pipeline.once import NOT_IT
from ribbonopt.pipeline.prepared import Prepared, prepare, solve
from ribbonopt.scene import SolutionGuess, load_scene
from ribbonopt.solution.solution import Solution

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
SADOWSKY = "law={type: sadowsky}"
SMOOTH = "law={type: variational, delta: 0.05}"
GUESS = "guess={force: [0, 43, 43], moment: [0, 2.1, -8.6]}"


def newton_steps(found: Solution) -> list[str]:
    return [step["step"] for step in found.steps if step["step"].startswith("newton, ")]


@pytest.fixture(scope="module")
def loop() -> Prepared:
    return prepare(load_scene(CONFIGS / "moebius_whole.yaml"))


@pytest.fixture(scope="module")
def smooth() -> Solution:
    """The whole ribbon under a smooth law, to no tolerance."""
    scene = load_scene(CONFIGS / "moebius_whole.yaml", [SMOOTH, "tolerance=null", GUESS])
    return solve(scene)


@pytest.fixture
def verified_on(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Sizes of what was verified, one after another."""
    sizes: list[int] = []
    verified = attempt.verified

    def noted(solution: Solution, *rest: object) -> Solution:
        sizes.append(len(solution.dense.w))
        return verified(solution, *rest)

    for place in (attempt, refinement):
        monkeypatch.setattr(place, "verified", noted)
    return sizes


def test_what_is_refined_is_verified_once(
    loop: Prepared, smooth: Solution, verified_on: list[int]
) -> None:
    found = loop.solve(guess=smooth)
    assert found.verified and found.verification.known
    assert len(newton_steps(found)) == 1 and len(found.steps) == 3  # a mesh, and a better one
    assert verified_on == [len(found.dense.w)]


def test_what_is_not_what_was_asked_for_is_given_up_all_the_same(loop: Prepared) -> None:
    """From a band of three half twists Newton's method finds one: its ends are the same."""
    other = solve(load_scene(CONFIGS / "moebius_whole.yaml", ["boundary.loop.half_twists=3"]))
    assert other.verified and count_half_twists(other) == 3
    found = loop.solve(guess=replace(other, posed=replace(other.posed)))
    assert found.verified and count_half_twists(found) == 1
    assert found.steps[0]["step"] == NOT_IT and found.given_up
    assert found.energy == pytest.approx(57.415096, abs=1e-6)


def test_a_saved_answer_begins_on_its_own_mesh(loop: Prepared, tmp_path: Path) -> None:
    first = loop.solve()
    save_solution(first, tmp_path)
    scene = replace(loop.scene, guess=SolutionGuess(str(tmp_path)))
    found = prepare(scene).solve()
    assert found.verified and found.mesh.elements == first.mesh.elements
    assert len(newton_steps(found)) == len(found.steps) - 1 == 1
    assert any("own mesh" in words for words in found.skipped)
    np.testing.assert_allclose(found.n0, first.n0, atol=1e-8)


def test_a_guess_that_shows_phases_is_solved_in_these_alone(smooth: Solution) -> None:
    prepared = prepare(load_scene(CONFIGS / "moebius_whole.yaml", [SADOWSKY]))
    found = prepared.solve(guess=smooth)
    assert found.verified and found.sheets == (1, -1)
    assert all("in 2 phases" in step for step in newton_steps(found))
    assert any("a pass without phases" in words for words in found.skipped)
    np.testing.assert_allclose(found.n0, HALF_MOEBIUS["n0"], atol=1e-7)


def test_bars_are_asked_only_where_a_sign_is_in_doubt() -> None:
    prepared = prepare(load_scene(CONFIGS / "moebius_regularized.yaml", [SADOWSKY]))
    found = prepared.solve()
    assert found.verified and found.sheets == (1, -1)
    assert Analysis not in found.trajectory.found
    asked: list[bool] = []

    def moments() -> float:
        asked.append(True)
        return 0.0

    assert not phase_problems(found, prepared.ribbon, 1e-8, moments) and not asked
    turned = replace(found, sheets=found.sheets[::-1])
    assert phase_problems(turned, prepared.ribbon, 1e-8, moments) and asked


def test_mechanics_of_known_loads_are_made_once() -> None:
    prepared = prepare(load_scene(CONFIGS / "end_moment.yaml"))
    first = prepared.solve()
    kept = prepared.automatic._inverted
    assert kept is prepared.ribbon
    other = prepared.solve(replace(prepared.scene, parameters={"moment": 2.0}))
    assert first.verified and other.verified
    # Half of the moment is half of the strains on twice the length: the law is homogeneous.
    np.testing.assert_allclose(other.sample(0.6, "u"), first.sample(0.3, "u") / 2, atol=1e-9)
