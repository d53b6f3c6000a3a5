"""A start full of noise still leads to a verified solution of the scene."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.guess import Guess
from ribbonopt.mechanics.rotations import matrix_of, quaternions_from
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import load_scene

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


@pytest.fixture(scope="module")
def half() -> Prepared:
    configs = Path(__file__).parents[2] / "configs"
    return prepare(load_scene(configs / "moebius_half.yaml"))


@pytest.mark.parametrize(("level", "least"), [(0.1, 50), (0.3, 50), (1.0, 45)])
def test_noise_is_survived(half: Prepared, level: float, least: int) -> None:
    guess = half.guess()
    found = [half.solve(guess=Noisy(guess, level, seed)) for seed in range(TRIES)]
    assert sum(solution.verified for solution in found) >= least


@pytest.mark.slow
@pytest.mark.parametrize(("level", "least"), [(0.1, 50), (0.3, 47)])
def test_newton_and_ipopt_survive_moderate_noise_alone(
    half: Prepared, level: float, least: int
) -> None:
    guess = half.guess()
    noisy = (Noisy(guess, level, seed) for seed in range(TRIES))
    found = [half.solve(guess=start, fallback=False) for start in noisy]
    assert sum(solution.verified for solution in found) >= least
