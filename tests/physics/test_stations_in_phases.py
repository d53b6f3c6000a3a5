"""A ribbon in phases that is held between its ends, followed as the place of its support moves."""

import pytest

from ribbonopt.scene import loads_scene
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.phases import margins

HELD = """
name: held
law: {type: sadowsky}
tolerance: 1e-8
supports: [{at: 0.3, position: {x: 0.03}}]
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: pinned, position: [0.3, 0.1, 0.7]}
continuation: {parameter: supports.0.at, to: 0.305}
"""


@pytest.mark.parametrize("law", ["sadowsky", "regularized, epsilon: 0.01"])
def test_a_support_is_no_change_of_phases(law: str) -> None:
    """Where it acts m2 keeps its sign, and its slope may be any."""
    walk = Continuation(loads_scene(HELD.replace("sadowsky", law)))
    points = list(walk)
    assert walk.ending.reached, walk.ending
    assert points[0].solution.sheets == points[-1].solution.sheets == (-1, 1, 1, -1)
    assert min(margins(points[0].solution).values()) > -1e-12
    assert points[-1].solution.verified
