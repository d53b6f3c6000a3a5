"""A ribbon without a moment at its stages may have one between them, and no bar tells."""

from pathlib import Path

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
PLAIN = ["tolerance=null", "continuation=null"]


def test_a_mesh_that_sees_no_load_verifies_nothing() -> None:
    """On two elements of one stage a bent ribbon looks straight."""
    mesh = "transcription={type: collocation, degree: 1, intervals: 2}"
    found = solve(load_scene(CONFIGS / "three_supports.yaml", [*PLAIN, mesh]))
    assert not found.verified
    assert "between the stages of a ribbon without a moment" in found.message


def test_a_straight_ribbon_is_verified() -> None:
    hung = ["boundary.end={force: [0, 0, 3], moment: [0, 0, 0]}", "loads={}", "guess=auto"]
    mesh = "transcription={type: collocation, degree: 1, intervals: 2}"
    found = solve(load_scene(CONFIGS / "cantilever.yaml", [*PLAIN, *hung, mesh]))
    assert found.verified, found.message
    assert abs(found.energy) < 1e-20
