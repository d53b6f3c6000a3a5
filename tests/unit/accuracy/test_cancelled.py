"""Bars on meshes that see a layer badly: errors may cancel in a difference of two schemes."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

CONFIGS = Path(__file__).parents[3] / "configs"
SCENE = CONFIGS / "band_three.yaml"
COARSE = "transcription={{type: collocation, degree: {}, intervals: {}}}"


@pytest.fixture(scope="module")
def exact() -> Solution:
    """The same band by Radau's scheme, to 1e-12."""
    return solve(load_scene(SCENE, ["transcription.scheme=radau", "tolerance=1e-12"]))


# Where n0 or u0 of the degree used and of the next agree by accident.
@pytest.mark.parametrize(("degree", "intervals"), [(2, 16), (3, 4), (3, 5)])
def test_no_bar_is_small_by_accident(exact: Solution, degree: int, intervals: int) -> None:
    mesh = [f"transcription.degree={degree}", f"transcription.intervals={intervals}"]
    found = solve(load_scene(SCENE, mesh))
    bars = estimate_error(found)
    assert exact.verified and found.verified
    assert np.abs(found.n0 - exact.n0).max() <= bars["n0"]
    assert np.abs(found.m0 - exact.m0).max() <= bars["m0"]
    assert np.abs(found.start["u"] - exact.start["u"]).max() <= bars["u0"]
    assert abs(found.energy - exact.energy) <= bars["energy"]


def test_a_mesh_too_coarse_for_a_newton_step_has_wide_bars() -> None:
    scene = CONFIGS / "heavy_cantilever.yaml"
    exact = solve(load_scene(scene, ["tolerance=1e-10"]))
    found = solve(load_scene(scene, ["tolerance=null", COARSE.format(1, 2)]))
    bars = estimate_error(found)
    assert exact.verified and found.verified
    assert np.abs(found.m0 - exact.m0).max() <= bars["m0"]
    assert np.abs(found.start["u"] - exact.start["u"]).max() <= bars["u0"]


@pytest.mark.parametrize(("tolerance", "told"), [("null", True), ("1e-6", False)])
def test_an_answer_without_bars_is_told_as_one(tolerance: str, told: bool) -> None:
    changed = [f"tolerance={tolerance}", COARSE.format(6, 2)]
    summary = summarize(solve(load_scene(CONFIGS / "moebius_whole.yaml", changed)))
    assert summary["verified"]
    assert (summary["error_estimate"]["n0"] is None) == told
    assert any("no error of this answer is known" in text for text in summary["warnings"]) == told
    assert ("verified, its errors not known" in report(summary).splitlines()[0]) == told
