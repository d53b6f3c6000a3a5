"""States between the nodes, where neighbouring solutions part faster than one place shows."""

from pathlib import Path

import numpy as np

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene

SCENE = Path(__file__).parents[3] / "configs" / "lateral_buckling.yaml"


def test_a_straight_strip_is_straight_between_its_nodes_under_any_load() -> None:
    # Straight in its stiff plane: r = s e_x under any weight. Where m2 = m3 = 0 the law's slope is
    # what rounding makes it, in some elements a million times that of others.
    found = solve(load_scene(SCENE, ["parameters.q=2e7"]))
    assert found.status.converged
    s = np.linspace(0.0, 1.0, 65)
    outputs = found.outputs(s)
    assert np.abs(outputs["r"] - s[:, None] * [1.0, 0.0, 0.0]).max() < 1e-12
    assert np.abs(outputs["orthonormality"]).max() < 1e-12
