"""What a guess shows before anything is solved, and what is therefore not solved at all.

Truth: 28-digit numbers of the Moebius ribbon, whose half is on one side of the switch and whose
whole crosses it once.
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS, REGULARIZED

from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.checks.arcs import sign_changes
from ribbonopt.guess import Guess
from ribbonopt.mechanics.rotations import turns_about
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.poles import toward_poles
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.pipeline.shown import crosses, phases_shown, side_shown
from ribbonopt.scene import LoadGuess, Scene, load_scene
from ribbonopt.solution.solution import Solution

EPSILON = 0.01


class Noisy:
    """Moments of a guess times 1 + level * xi at each place, xi uniform between -1 and 1.

    Frames are turned about the tangent by up to level radians, so that m2 changes its sign.
    """

    def __init__(self, guess: Guess, level: float, seed: int) -> None:
        self.guess, self.level, self.seed = guess, level, seed

    def fields(self, fraction: Array) -> RodFields:
        f, rng = self.guess.fields(fraction), np.random.default_rng(self.seed)
        angles = self.level * rng.uniform(-1, 1, len(fraction))
        m = f.m * (1 + self.level * rng.uniform(-1, 1, f.m.shape))
        turned = turns_about(angles[:, None] * f.frames[:, :, 2]) @ f.frames
        return RodFields(f.r, turned, f.n, m)


@pytest.fixture(scope="module")
def half() -> Prepared:
    return prepare(scene_of("moebius_half"))


@pytest.fixture(scope="module")
def whole() -> Prepared:
    """The whole ribbon from the loads that other programs begin with: far from any solution."""
    guess = LoadGuess((0.0, 40.0, 40.0), (0.0, 2.0, -9.0))
    return prepare(replace(scene_of("moebius_regularized"), guess=guess, tolerance=1e-8))


def scene_of(name: str) -> Scene:
    return load_scene(Path(__file__).parents[3] / "configs" / f"{name}.yaml")


def error(solution: Solution, truth: dict[str, tuple[float, ...]]) -> float:
    gaps = np.abs(solution.n0) - np.abs(truth["n0"]), np.abs(solution.m0) - np.abs(truth["m0"])
    return float(np.abs(gaps).max() / np.abs(truth["n0"]).max())


def steps_of(solution: Solution, words: str) -> list[str]:
    return [step["step"] for step in solution.steps if words in step["step"]]


def begun(prepared: Prepared, guess: Guess | None = None) -> tuple[Attempt, Array]:
    attempt = prepared.structure.attempt(prepared.posed())
    return attempt, attempt.unknowns(guess or prepared.guess())


def test_a_guess_that_crosses_the_switch_is_solved_in_phases_alone(whole: Prepared) -> None:
    found = whole.solve()
    assert found.verified and found.sheets == (1, -1)
    assert error(found, REGULARIZED[EPSILON]) < 1e-8
    assert steps_of(found, "newton") == steps_of(found, "in 2 phases")
    assert not found.given_up and not found.fell_back


def test_phases_of_a_guess_that_lead_nowhere_are_no_harm(
    whole: Prepared, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without them signs are settled first, and no further: the rest is solved in phases."""
    monkeypatch.setattr("ribbonopt.pipeline.search.phases_shown", lambda *parts: None)
    attempt, w = begun(whole)
    assert attempt.run_from(w, quick=True, check=False)
    found = whole.solve()
    assert found.verified and found.sheets == (1, -1)
    assert error(found, REGULARIZED[EPSILON]) < 1e-8
    (plain,) = (s for s in found.steps if "newton" in s["step"] and "phases" not in s["step"])
    assert plain["iterations"] < attempt.iterations


def test_the_first_mesh_is_graded_to_the_poles(whole: Prepared) -> None:
    """As many elements as an even mesh has, and an error a thousand times smaller."""
    plain, w = begun(whole)
    source = plain.restored(w)
    arcs = sign_changes(source)
    structure = whole.structure.in_phases(arcs.kinds)
    even = structure.attempt(
        whole.posed(), mesh=structure.mesh(arcs.switches), switches=arcs.switches
    )
    mesh = toward_poles(even, even.unknowns(source))
    assert mesh is not None and mesh.elements == even.mesh.elements
    graded = structure.attempt(whole.posed(), mesh=mesh, switches=arcs.switches)
    errors = []
    for attempt in (even, graded):
        assert attempt.run(source) and attempt.best is not None
        errors.append(relative_error(attempt.best)[0])
    assert errors[1] < 1e-3 * errors[0]
    # Narrowest where phases meet, where the law (6.1) has its pole at epsilon |m3| / (2 |m2'|).
    assert [int(np.argmin(widths)) for widths in mesh.phases] == [mesh.elements[0] - 1, 0]


def test_a_law_without_poles_near_by_keeps_an_even_mesh(half: Prepared) -> None:
    """Sadowsky's sheets are singular where m2 and m3 vanish together: not on this ribbon."""
    structure = half.structure.in_phases((1,))
    attempt = structure.attempt(half.posed())
    assert toward_poles(attempt, attempt.unknowns(half.guess())) is None


@pytest.mark.parametrize("seed", range(5))
def test_noise_hides_no_side(half: Prepared, whole: Prepared, seed: int) -> None:
    """Moments off by all of themselves, frames by a radian: the half is on one side all the same.

    The whole is as much on the one as on the other; neither shows phases beyond doubt.
    """
    attempt, w = begun(half, Noisy(half.guess(), 1.0, seed))
    assert crosses(attempt, w) and phases_shown(attempt, w) is None
    assert side_shown(attempt, w) == 1
    attempt, w = begun(whole, Noisy(whole.guess(), 1.0, seed))
    assert crosses(attempt, w) and phases_shown(attempt, w) is None
    assert side_shown(attempt, w) is None


def test_a_guess_without_noise_shows_what_it_is(half: Prepared, whole: Prepared) -> None:
    attempt, w = begun(half)
    assert not crosses(attempt, w) and side_shown(attempt, w) == 1
    attempt, w = begun(whole)
    arcs = phases_shown(attempt, w)
    assert arcs is not None and arcs.kinds == (1, -1)


def test_one_side_is_solved_where_newton_sees_kinks(
    half: Prepared, stalling: Callable[[Prepared], Guess]
) -> None:
    """The answer is one of the law itself, from the guess that was given and not from another."""
    found = half.solve(guess=stalling(half), fallback=False, quick=True)
    assert found.verified and not found.given_up
    assert error(found, HALF_MOEBIUS) < 1e-9
    assert steps_of(found, "newton")[0].endswith(")")  # says how it failed


@pytest.fixture
def stalling() -> Callable[[Prepared], Guess]:
    """Noise from which Newton's method on the law with its kink leads nowhere."""

    def found(prepared: Prepared) -> Guess:
        for seed in range(100):
            attempt, w = begun(prepared, Noisy(prepared.guess(), 1.0, seed))
            if not attempt.run_from(w, quick=True, check=False):
                return Noisy(prepared.guess(), 1.0, seed)
        raise AssertionError("no noise stalls Newton's method")

    return found
