"""Bars of positions and directors hold between the nodes too, where the order is low."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene

CONFIGS = Path(__file__).resolve().parents[3] / "configs"


@pytest.mark.parametrize(
    ("scene", "formulation", "scheme", "degree", "intervals"),
    [
        ("ring_pressed", "inverted", "gauss", 3, 5),
        ("ring_pressed", "inverted", "lobatto", 5, 10),
        ("twisted_ring", "inverted", "gauss", 1, 20),
        ("curved_ring", "algebraic", "gauss", 1, 10),
    ],
)
def test_errors_within_elements_are_within_bars(
    scene: str, formulation: str, scheme: str, degree: int, intervals: int
) -> None:
    """Errors at the nodes of a ring are a hundredth of these; truth is a mesh of another order."""
    path, plain = CONFIGS / f"{scene}.yaml", ["tolerance=null", "continuation=null"]
    mesh = f"{{type: collocation, scheme: {scheme}, degree: {degree}, intervals: {intervals}}}"
    settings = [f"transcription={mesh}", f"formulation={formulation}"]
    found = solve(load_scene(path, [*plain, *settings]))
    exact = solve(load_scene(path, ["continuation=null", "tolerance=1e-12"]))
    assert found.verified and exact.verified
    fraction = np.linspace(0, 1, 201)
    ours, truth = (one.trajectory.outputs(fraction) for one in (found, exact))
    off = max(float(np.abs(ours[k] - truth[k]).max()) for k in ("r", "d1", "d2", "d3"))
    assert off <= estimate_error(found)["states"] <= 20 * off
