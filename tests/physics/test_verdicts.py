"""What no one shall be told: strains off their law, a guess that was dropped, errors of nothing."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt import load_solution, save_solution, summarize
from ribbonopt.output.report import report
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import LoadGuess, dump_scene, load_scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

COARSE = ["formulation=differentiated", "transcription.intervals=20"]


def off_the_law(found: Solution) -> float:
    """Return how far the strains are off (6.1), written anew, anywhere along the ribbon."""
    epsilon = found.scene.law.epsilon  # type: ignore[union-attr]
    o = found.outputs(np.linspace(*found.scene.interval, 301))
    m2, m3 = o["m2"], o["m3"]
    M = np.hypot(m2, m3)
    s = M + np.abs(m2)
    u2 = m2 * s**2 / (2 * M * (2 * np.abs(m2) + epsilon * s))
    u3 = m3 * s / (4 * M)
    gap = np.hypot(o["u2"] - u2, o["u3"] - u3)
    return float(gap.max() / np.hypot(u2, u3).max())


def test_strains_off_their_law_are_no_solution(configs: Path) -> None:
    overrides = [*COARSE, "law={type: regularized, epsilon: 1e-3}"]
    scene = load_scene(configs / "moebius_regularized.yaml", overrides)
    found = prepare(scene).solve(fallback=False)
    assert off_the_law(found) > 0.04
    assert found.status is Status.WRONG_SOLUTION
    assert "off the law" in found.message and "formulation: inverted" in found.message


@pytest.mark.parametrize("name", ["moebius_half", "helix", "cantilever"])
def test_strains_that_drift_as_little_as_the_error_are_verified(configs: Path, name: str) -> None:
    found = solve(load_scene(configs / f"{name}.yaml", ["formulation=differentiated"]))
    assert found.verified, found.message


def test_a_branch_of_another_law_is_not_taken_for_an_answer(configs: Path) -> None:
    # From the scene's guess the differentiated form ends 58 % off the law, its equations solved.
    scene = load_scene(configs / "clamped_quarter.yaml", ["formulation=differentiated"])
    found = solve(scene)
    assert found.status is Status.WRONG_SOLUTION
    assert "off the law" in found.message


TWISTED = """
name: twisted
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.95], directors: {turns: [{z: 20*pi}]}}
guess: {helix: {turns: 10.0, rise: 0.95}}
"""


def test_a_guess_that_was_given_up_is_in_the_headline(tmp_path: Path) -> None:
    found = solve(loads_scene(TWISTED))
    assert found.verified
    assert found.given_up == (
        "the guess (helix) led nowhere and was given up for the automatic start",
        "the whole turns of the ends: no equilibrium wound so was found",
    )
    summary = summarize(found)
    assert summary["given_up"] == list(found.given_up)
    assert "given up" in report(summary).splitlines()[1]
    assert not any("the guess is given" in reason for reason in found.skipped)
    save_solution(found, tmp_path)
    assert load_solution(tmp_path).given_up == found.given_up


def test_a_guess_that_led_on_is_not_given_up(configs: Path) -> None:
    found = solve(load_scene(configs / "moebius_half.yaml"))
    assert found.given_up == ()
    assert any("the guess is given" in reason for reason in found.skipped)


def test_a_guess_given_in_python_is_given_up_by_name(configs: Path) -> None:
    scene = load_scene(configs / "clamped_arch.yaml", ["guess=auto"])
    prepared = prepare(scene)
    from ribbonopt.guess import IntegratedLoads

    far = IntegratedLoads(
        prepared.ribbon, prepared.posed(), LoadGuess((400, -300, 900), (0, 90, 70))
    )
    found = prepared.solve(guess=far)
    assert found.given_up[0].startswith("the guess given led nowhere")
    assert found.verified


COLUMN = """
name: straight
law: {type: kirchhoff}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [0, 0, -1]}
"""


@pytest.mark.parametrize("tolerance", [1e-6, 1e-9])
def test_a_straight_ribbon_has_no_relative_error(tolerance: float) -> None:
    found = solve(loads_scene(f"{COLUMN}tolerance: {tolerance}\n"))
    assert found.verified, found.message
    assert found.energy == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(found.sample(1.0, "r"), [0, 0, 1], atol=1e-12)
    assert sum(found.mesh.elements) == 10  # nothing to refine


SIZES = "{length: 2, width: 0.02, thickness: 1e-3, youngs_modulus: 5e10, poisson_ratio: 0}"
STEEL = f"""
name: steel
law: {{type: sadowsky}}
ribbon: {SIZES}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: [1e-3, 0, 0]}}
"""


def test_a_ribbon_of_known_length_is_solved_whole() -> None:
    scene = loads_scene(STEEL)
    assert scene.interval == (0.0, 2.0)
    found = solve(scene)
    assert found.m0[1] == pytest.approx(1.999693e-3, rel=1e-6)
    assert loads_scene(dump_scene(scene)) == scene
    half = loads_scene(STEEL + "interval: [0, 1]\n")
    assert half.interval == (0.0, 1.0)
    assert loads_scene(dump_scene(half)) == half


def test_pieces_of_loops_have_their_share_of_it() -> None:
    text = f"name: band\nlaw: {{type: sadowsky}}\nribbon: {SIZES}\nboundary: {{loop: %s}}\n"
    for loop, length in (
        ("{half_twists: 1}", 2.0),
        ("{half_twists: 1, piece: half}", 1.0),
        ("{half_twists: 3, piece: fundamental}", 1 / 3),
    ):
        assert loads_scene(text % loop).interval[1] == pytest.approx(length)
