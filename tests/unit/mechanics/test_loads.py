"""Motions that leave a dead load as it is: those that do not turn it."""

import numpy as np
import pytest

from ribbonopt.mechanics.along import Field
from ribbonopt.mechanics.loads.components import Components, Share
from ribbonopt.mechanics.loads.dead_force import DeadForce

SPACE, PLANE = np.eye(6), np.eye(6)[:, [0, 2, 4]]


@pytest.mark.parametrize("scale", [1e-8, 1.0, 1e8])
@pytest.mark.parametrize("force", [(0, 0, 1), (1, 0, 0), (0.3, -2, 0.5), (0, 0, 0)])
@pytest.mark.parametrize("motions", [SPACE, PLANE], ids=["space", "plane"])
def test_all_translations_and_the_turn_about_it_leave_a_weight(
    motions: np.ndarray, force: tuple[float, float, float], scale: float
) -> None:
    f = np.array(force) * scale
    parts = {axis: Share(Field(f"loads.force.{axis}", v)) for axis, v in zip("xyz", f, strict=True)}
    kept = motions @ DeadForce(Components(parts, {}, (0.0, 1.0))).symmetries(motions)
    np.testing.assert_allclose(np.cross(kept[3:].T, f / scale), 0, atol=1e-9)
    # Of those that are allowed no other leaves it: the rest turns it, each in a way of its own.
    turned = np.linalg.matrix_rank(np.cross(motions[3:].T, f / scale))
    assert np.linalg.matrix_rank(kept) == motions.shape[1] - turned
    assert np.linalg.matrix_rank(np.hstack([kept, motions[:, :2]])) == np.linalg.matrix_rank(kept)
