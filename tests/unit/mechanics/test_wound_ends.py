"""Rotations by which a scene writes a frame: in their order they make it."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ribbonopt.mechanics.ends.frames import frame_of
from ribbonopt.mechanics.ends.winding import _rotations as rotations
from ribbonopt.mechanics.ends.winding import winding
from ribbonopt.scene import Boundary, End, Turn, Turns

AXES = ("x", "y", "z", "d1", "d2", "d3")


def turned(names: Any, angles: Any) -> End:
    turns = tuple(Turn(**{name: float(a)}) for name, a in zip(names, angles, strict=True))
    return End("clamped", (0, 0, 0), Turns(turns))


@pytest.mark.parametrize("seed", range(8))
def test_turns_about_directors_and_lab_axes_follow_one_another(seed: int) -> None:
    """Each is about the axis as it then stands; all of them, one after another, make the frame."""
    rng = np.random.default_rng(seed)
    end = turned(rng.choice(AXES, 5), rng.uniform(-5, 5, 5))
    frame = np.eye(3)
    for vector in rotations(end, {}):
        frame = Rotation.from_rotvec(vector).as_matrix() @ frame
    expected = frame_of(end, {})
    assert expected is not None
    np.testing.assert_allclose(frame, expected, atol=1e-12)


@pytest.mark.parametrize("angle", [-9.0, 4.0, 7.0, 20.0])
@pytest.mark.parametrize("name", ["x", "d2", "d3"])
def test_one_turn_winds_by_its_angle(name: str, angle: float) -> None:
    start = End("clamped", (0, 0, 0), "identity")
    found = winding(Boundary(start, turned([name], [angle])), {})
    assert found is not None
    np.testing.assert_allclose(found, angle * np.eye(3)[AXES.index(name) % 3], atol=1e-9)
