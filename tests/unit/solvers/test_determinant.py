"""The determinant of a condensed system: one number of the equations, whatever the mesh."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solvers.condense import CondensedSystem


@pytest.mark.parametrize("degree", [3, 4])
def test_the_determinant_is_that_of_single_shooting_on_any_mesh(configs: Path, degree: int) -> None:
    """Of the conditions by the start and the constants: sign and size are those of the ribbon."""
    found = []
    for count in (8, 9, 10, 11, 15, 24, 33):
        mesh = f"transcription={{type: collocation, degree: {degree}, intervals: {count}}}"
        solution = solve(load_scene(configs / "moebius_half.yaml", [mesh]))
        blocks, w, p = solution.dense.blocks, solution.dense.w, solution.dense.p
        _, derivatives = blocks.linearize(w, p)
        found.append(CondensedSystem(blocks, derivatives, p).determinant)
    signs, logs = np.array(found).T
    assert abs(signs).min() == 1 and abs(signs.sum()) == len(signs)
    np.testing.assert_allclose(logs, logs[-1], atol=0.05)
