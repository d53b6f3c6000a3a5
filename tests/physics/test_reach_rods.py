"""Rods very uneven in their stiffnesses between clamps at random are found from nothing.

Truth: equilibria of code that shares nothing with ours, next to what was found.
"""

from dataclasses import replace

import numpy as np
import pytest
from independent import Law, polish

from ribbonopt.mechanics.rotations import matrix_of
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Boundary, Collocation, Directors, End, Kirchhoff, Scene
from ribbonopt.solution.solution import Solution

RATIOS = [1e-3, 1e-2, 0.1, 10, 100, 1e3]


def clamps(seed: int, count: int) -> list[Scene]:
    rng = np.random.default_rng(seed)
    return [clamp(rng) for _ in range(count)]


def clamp(rng: np.random.Generator) -> Scene:
    turn = matrix_of(rng.normal(size=4)).T.tolist()
    distance, direction = rng.uniform(0.3, 0.95), rng.normal(size=3)
    place = (distance * direction / np.linalg.norm(direction)).tolist()
    return Scene(
        name="clamp",
        law=Kirchhoff(B2=1, B3=1),
        boundary=Boundary(
            start=End(position=(0.0, 0.0, 0.0), directors="identity"),
            end=End(position=tuple(place), directors=Directors(*map(tuple, turn))),
        ),
        transcription=Collocation(scheme="gauss", degree=6, intervals=40),
        tolerance=1e-6,
    )


def moved_from_truth(found: Solution) -> float:
    """How far places and frames are from an equilibrium, at most."""
    law, end = found.scene.law, found.scene.boundary.end
    assert isinstance(law, Kirchhoff)
    assert isinstance(end.directors, Directors)
    frame = np.array([end.directors.d1, end.directors.d2, end.directors.d3])

    def start(s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        out = found.outputs(s)
        return out["r"], np.stack([out["d1"], out["d2"], out["d3"]], axis=1)

    rod = Law("kirchhoff", stiffness=(law.B2, law.B3))
    truth = polish(rod, found.n0, found.m0, start, (np.array(end.position), frame))
    assert truth.verdict == "found", truth.reason
    assert truth.path is not None
    assert found.energy == pytest.approx(truth.path.energy, rel=1e-5)
    return truth.moved


@pytest.mark.parametrize("ratio", RATIOS)
def test_uneven_rods_between_random_clamps_are_found(ratio: float) -> None:
    found = []
    for scene in clamps(seed=51, count=3):
        found.append(solve(replace(scene, law=Kirchhoff(B2=1, B3=ratio))))
        assert found[-1].verified, found[-1].message
        assert found[-1].given_up == ()
    if ratio in (1e-3, 1e3):  # where it is hardest
        assert moved_from_truth(found[0]) < 1e-5


@pytest.mark.parametrize("stiffness", [20.0, 1e3])
def test_what_is_uneven_does_not_depend_on_the_unit_of_stiffness(stiffness: float) -> None:
    """Strains depend on B3 / B2 alone, moments are in proportion to both."""
    (scene,) = clamps(seed=52, count=1)
    one, other = (
        solve(replace(scene, law=Kirchhoff(B2=B, B3=2e-3 * B), tolerance=1e-8))
        for B in (1.0, stiffness)
    )
    assert one.verified, one.message
    assert other.verified, other.message
    assert moved_from_truth(other) < 1e-6
