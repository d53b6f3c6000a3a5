"""Mixtures from end to end in results and along branches; phases that turn out not to be there."""

from pathlib import Path

import numpy as np
import pytest
from helices import clamped_at, end_of, energy_of
from scipy.spatial.transform import Rotation

from ribbonopt.checks.arcs import Arcs, without_empty
from ribbonopt.output.report import report
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import loads_scene
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import POINT

TWISTED = """name: twisted
law: {law}
parameters: {{turns: {turns}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end:
    position: {{x: 0, y: 0}}
    directors: {{turns: [{{z: 360*turns*deg}}]}}
    force: {{z: 200}}
tolerance: 1e-8
"""


def test_a_mixture_is_saved_loaded_and_a_guess(tmp_path: Path) -> None:
    u2, u3 = 0.5, 1.2
    found = solve(clamped_at(*end_of(u2, u3)))
    assert found.sheets == (0,)
    assert "m2 = 0 (mixture) all along" in report(summarize(found))
    save_solution(found, tmp_path)
    loaded = load_solution(tmp_path)
    assert loaded.verified
    assert loaded.sheets == (0,)
    np.testing.assert_array_equal(loaded.n0, found.n0)
    near = end_of(0.5, 1.21)
    again = prepare(clamped_at(*near)).solve(guess=loaded, fallback=False)
    assert again.verified, again.message
    assert again.energy == pytest.approx(energy_of(0.5, 1.21), rel=1e-8)


def test_no_pure_mixture_where_the_clamp_is_off_by_little() -> None:
    # The equations with slack have a solution: what is not zero in it is told.
    r, frame = end_of(0.5, 1.2)
    turned = Rotation.from_rotvec([1e-4, -2e-4, 1e-4]).as_matrix() @ frame
    exact = solve(clamped_at(r, frame))
    search = prepare(clamped_at(r, turned)).search()
    assert not search.run_in(Arcs((0,), np.empty(0)), exact)
    assert search.last is not None
    assert search.last.best is not None
    assert not search.last.best.verified


def test_a_branch_of_mixtures_claims_no_branch_point() -> None:
    # Zeros of the determinant with slack are none; the smooth law has its first at 1.32 turns.
    text = TWISTED + "continuation: {{parameter: parameters.turns, to: 1.3}}\n"
    scene = loads_scene(text.format(law="{type: sadowsky}", turns=0.7))
    points = list(Continuation(scene))
    assert points[-1].position == pytest.approx(1.3)
    assert {point.kind for point in points} == {POINT}
    for point in points:
        torque = 8 * np.pi * point.position
        assert point.solution.sheets == (0,)
        np.testing.assert_allclose(point.solution.m0, [0, 0, torque], rtol=1e-8, atol=1e-6)


def test_phases_without_length_are_dropped() -> None:
    rng = np.random.default_rng(1045)
    q = rng.normal(size=4)
    distance, v = rng.uniform(0.3, 0.95), rng.normal(size=3)
    frame = Rotation.from_quat(q).as_matrix()
    found = solve(clamped_at(distance * v / np.linalg.norm(v), frame, tolerance=1e-6))
    assert found.verified, found.message
    assert found.sheets == (1, 0, 1)
    assert without_empty(found) is None
    assert (np.diff([0, *found.switch_points, 1]) > 1e-3).all()
