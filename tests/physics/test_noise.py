"""A start full of noise still leads to the Moebius band: verified, and right by other means."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from independent.confirm import confirm
from references import HALF_MOEBIUS, REGULARIZED

from ribbonopt.arrays import Array
from ribbonopt.guess import Guess
from ribbonopt.mechanics.rotations import matrix_of, quaternions_from
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import Regularized, load_scene
from ribbonopt.solution.solution import Solution

CONFIGS = Path(__file__).parents[2] / "configs"
TRIES = 50


class Noisy:
    """Every number of a guess times 1 + level * xi, xi uniform between -1 and 1."""

    def __init__(self, guess: Guess, level: float, seed: int) -> None:
        self.guess, self.level, self.rng = guess, level, np.random.default_rng(seed)

    def fields(self, fraction: Array) -> RodFields:
        f = self.guess.fields(fraction)
        quaternions = self.noisy(quaternions_from(f.frames))
        frames = np.stack([matrix_of(q) for q in quaternions])
        # Reduced states hold n(0), m(0) as constants: the noise on these counts.
        return RodFields(self.noisy(f.r), frames, self.noisy(f.n), self.noisy(f.m))

    def noisy(self, values: Array) -> Array:
        return values * (1 + self.level * self.rng.uniform(-1, 1, values.shape))


def off(solution: Solution, truth: Mapping[str, Any]) -> float:
    """Relative error of n(0), m(0); symmetry leaves their signs open."""
    pairs = ((solution.n0, truth["n0"]), (solution.m0, truth["m0"]))
    return max(float(np.abs(np.abs(a) - np.abs(b)).max() / np.abs(b).max()) for a, b in pairs)


@pytest.fixture(scope="module")
def half() -> Prepared:
    return prepare(load_scene(CONFIGS / "moebius_half.yaml"))


@pytest.fixture(scope="module")
def whole() -> Prepared:
    law = "law={type: regularized, epsilon: 0.01}"
    loads = "guess={force: [0, 40, 40], moment: [0, 2, -9]}"
    return prepare(load_scene(CONFIGS / "moebius_whole.yaml", [law, loads]))


@pytest.mark.parametrize("level", [0.1, 0.3, 1.0])
def test_noise_is_survived(half: Prepared, level: float) -> None:
    guess = half.guess()
    found = [half.solve(guess=Noisy(guess, level, seed)) for seed in range(TRIES)]
    assert all(solution.verified for solution in found)
    assert max(off(solution, HALF_MOEBIUS) for solution in found) < 1e-8


@pytest.mark.parametrize(("level", "seeds"), [(0.1, 2), (0.3, 2), (1.0, 4)])
def test_noise_is_survived_by_the_whole_ribbon(whole: Prepared, level: float, seeds: int) -> None:
    guess = whole.guess()
    for seed in range(seeds):
        found = whole.solve(guess=Noisy(guess, level, seed))
        assert found.verified
        assert off(found, REGULARIZED[0.01]) < 1e-9
    assert confirm(found) < 1e-11  # integrated anew, the loop closes


def test_another_epsilon_is_seen(whole: Prepared) -> None:
    """What confirms the answers above would not confirm those of a law a bit off."""
    found = whole.solve()
    scene = replace(found.posed.scene, law=Regularized(epsilon=0.01 * (1 + 1e-5)))
    other = SimpleNamespace(posed=SimpleNamespace(scene=scene), trajectory=found.trajectory)
    assert confirm(other) > 1e-8


@pytest.mark.slow
@pytest.mark.parametrize(("level", "least"), [(0.1, 50), (0.3, 47)])
def test_newton_and_ipopt_survive_moderate_noise_alone(
    half: Prepared, level: float, least: int
) -> None:
    guess = half.guess()
    noisy = (Noisy(guess, level, seed) for seed in range(TRIES))
    found = [half.solve(guess=start, fallback=False) for start in noisy]
    assert sum(solution.verified for solution in found) >= least
