"""What is refused of point loads and supports between the ends: one message each."""

from __future__ import annotations

import pytest

from ribbonopt import loads_scene
from ribbonopt.errors import SceneError

SCENE = """
name: places
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free}
"""
WRONG = [
    ("loads: {points: [{at: 1.2, force: {z: 1}}]}", r"loads\.points\.0\.at.*outside the ribbon"),
    ("loads: {points: [{at: -1, force: {z: 1}}]}", r"loads\.points\.0\.at.*outside the ribbon"),
    ("loads: {points: [{at: 1, force: {z: 1}}]}", r"is outside|is the end of the ribbon"),
    ("loads: {points: [{at: 1e-9, force: {z: 1}}]}", "is the start of the ribbon"),
    ("loads: {points: [{at: 0.5}]}", "expected a force or a moment"),
    ("loads: {points: [{at: 0.5, force: {x: 1, d1: 2}}]}", "keeps its direction"),
    ("loads: {points: [{at: a, force: {z: 1}}]}", r"loads\.points\.0\.at.*unknown"),
    ("loads: {points: [{at: 0.5, force: {z: 1e20}}]}", r"loads\.points\.0\.force\.z.*at most"),
    ("loads: {points: [{force: {z: 1}}]}", r"loads\.points\.0.*at"),
    ("supports: [{at: 0.5, position: {}}]", r"supports\.0\.position.*expected what is held"),
    ("supports: [{at: 2, position: {x: 0}}]", r"supports\.0\.at.*outside the ribbon"),
    ("supports: [{at: 0.5, position: {d1: 0}}]", r"supports\.0\.position\.d1.*unknown key"),
    (
        "supports: [{at: 0.5, position: {x: 0}}]\n"
        "loads: {points: [{at: 0.5000001, force: {x: 1}}]}",
        "all but the place of",
    ),
]


@pytest.mark.parametrize(("text", "message"), WRONG)
def test_refused(text: str, message: str) -> None:
    with pytest.raises(SceneError, match=message) as caught:
        loads_scene(SCENE + text)
    assert len(str(caught.value).splitlines()) == 1
