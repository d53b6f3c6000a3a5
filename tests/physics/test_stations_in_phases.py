"""A ribbon in phases that is held between its ends, followed as the place of its support moves."""

import pytest

from ribbonopt.scene import loads_scene
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.phases import margins

HELD = """
name: held
law: {type: LAW}
tolerance: 1e-8
supports: [{at: AT, position: {x: HEIGHT}}]
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end:
    support: clamped
    position: [0.3, 0.06, 0.9]
    directors: {rotation_vector: [0, -0.6, 0.5]}
continuation: {parameter: supports.0.at, to: TO}
"""


@pytest.mark.parametrize(
    ("law", "at", "height", "sheets"),
    [
        ("sadowsky", 0.7, 0.2, (-1, 1, 1, -1)),
        ("regularized, epsilon: 0.01", 0.25, 0.12, (1, -1, -1)),
    ],
)
def test_a_support_is_no_change_of_phases(
    law: str, at: float, height: float, sheets: tuple[int, ...]
) -> None:
    """Where it acts m2 keeps its sign, and its slope may be any."""
    text = HELD.replace("LAW", law).replace("AT", str(at)).replace("HEIGHT", str(height))
    walk = Continuation(loads_scene(text.replace("TO", str(at + 0.004))))
    points = list(walk)
    assert walk.ending.reached, walk.ending
    assert points[0].solution.sheets == points[-1].solution.sheets == sheets
    assert min(margins(points[0].solution).values()) > 0
    assert points[-1].solution.verified
