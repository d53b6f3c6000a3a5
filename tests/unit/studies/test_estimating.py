"""Tangents from the factors of the estimate: those of the branch, and the estimate is the same."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import analyse
from ribbonopt.accuracy.improved import Improved
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import loads_scene
from ribbonopt.scene.stages import stages_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.coordinates import metric_at
from ribbonopt.studies.continuation.curve import Curve
from ribbonopt.studies.continuation.linearising import heading, linearised
from ribbonopt.studies.continuation.ribbons import RibbonEquations

Array = np.ndarray
HALF = """
name: half
law: {type: regularized, epsilon: 0.05}
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}
  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}
guess: {force: [0, 40, 40], moment: [0, 2, -9]}
transcription: {%s}
continuation: {parameter: law.epsilon, from: 0.05, to: 0.01}
"""
GAUSS = "type: collocation, scheme: gauss"
FINE = {
    "one degree more": f"{GAUSS}, degree: 6, intervals: 12",
    "halved elements": f"{GAUSS}, degree: 10, intervals: 6",
    "radau": "type: collocation, scheme: radau, degree: 6, intervals: 16",
    "shooting": "type: shooting, scheme: rk8, intervals: 12, steps: 3",
}
COARSE = f"{GAUSS}, degree: 2, intervals: 6"


class At:
    """A point of the branch in epsilon, at 0.03."""

    def __init__(self, transcription: str) -> None:
        scene = loads_scene(HALF % transcription)
        self.curve = Curve(scene, stages_of(scene)[0])
        self.prepared: Prepared = prepare(self.curve.scene_at(0.05))
        self.solution = self.solved(0.03, self.prepared.solve())
        self.equations = RibbonEquations(
            self.prepared, self.curve, metric_at(self.solution, self.curve)
        )
        self.unknowns = np.append(self.solution.dense.w, 0.03)
        self.ahead = self.equations.reduced(self.solution, self.unknowns)
        tangent = linearised(self.equations, self.fresh(), self.unknowns, self.ahead).direction
        self.ahead = self.equations.reduced(self.solution, tangent)

    def solved(self, epsilon: float, guess: Solution) -> Solution:
        found = self.prepared.solve(self.curve.posed_at(epsilon), guess=guess)
        assert found.verified
        return replace(found, trajectory=replace(found.trajectory, found={}))

    def fresh(self) -> Solution:
        trajectory = replace(self.solution.trajectory, found={})
        return replace(self.solution, trajectory=trajectory)


@cache
def at(transcription: str) -> At:
    return At(transcription)


each_scheme = pytest.mark.parametrize("scheme", FINE)


@each_scheme
def test_the_tangent_is_the_derivative_of_solutions(scheme: str) -> None:
    """Along the whole ribbon, in the layout of the point itself."""
    here, h = at(FINE[scheme]), 1e-4
    solution = here.fresh()
    found = heading(here.equations, solution, here.unknowns, here.ahead)
    assert Improved in solution.trajectory.found
    ahead, behind = (here.solved(0.03 + sign * h, solution).dense.w for sign in (1, -1))
    expected = (ahead - behind) / (2 * h)
    tangent = found.direction[:-1] / found.direction[-1]
    np.testing.assert_allclose(tangent, expected, rtol=0, atol=1e-4 * np.abs(expected).max())


@each_scheme
def test_it_is_that_of_the_scheme_itself(scheme: str) -> None:
    here = at(FINE[scheme])
    found = heading(here.equations, here.fresh(), here.unknowns, here.ahead)
    own = linearised(here.equations, here.fresh(), here.unknowns, here.ahead)
    assert found.sign == own.sign != 0
    one, other = (
        here.equations.reduced(here.solution, v.direction / v.direction[-1]) for v in (found, own)
    )
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-5 * np.abs(other).max())


@each_scheme
def test_the_estimate_is_the_same(scheme: str) -> None:
    here = at(FINE[scheme])
    solution, expected = here.fresh(), analyse(here.fresh())
    heading(here.equations, solution, here.unknowns, here.ahead)
    found = analyse(solution)
    assert Improved not in solution.trajectory.found  # it was used
    for name, error in expected.errors.items():
        assert found.errors[name] == pytest.approx(error, rel=1e-3, abs=1e-14), name
    np.testing.assert_allclose(found.local, expected.local, rtol=1e-6)


def test_where_schemes_differ_the_tangent_is_that_of_the_scheme_itself() -> None:
    here = at(COARSE)
    solution = here.fresh()
    found = heading(here.equations, solution, here.unknowns, here.ahead)
    own = linearised(here.equations, here.fresh(), here.unknowns, here.ahead)
    np.testing.assert_array_equal(found.direction, own.direction)
    assert Improved in solution.trajectory.found  # but the estimate is made already


def test_a_solution_whose_error_is_known_is_linearised_in_its_own_scheme() -> None:
    here = at(FINE["one degree more"])
    solution = here.fresh()
    analyse(solution)
    found = heading(here.equations, solution, here.unknowns, here.ahead)
    own = linearised(here.equations, here.fresh(), here.unknowns, here.ahead)
    np.testing.assert_array_equal(found.direction, own.direction)
    assert Improved not in solution.trajectory.found
