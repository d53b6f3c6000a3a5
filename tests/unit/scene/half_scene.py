"""A scene file to read, write and spoil."""

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene

SCENE = """\
name: half
law:
  type: regularized
  epsilon: 1e-2
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end:
    position: {y: 0, z: 1 - turn}
    d1: {x: 0}
  also:
    - dot(n, d1(start)) = 0
parameters: {turn: .5}
guess: {force: [0, 40, 40], moment: [0, 2, -9]}
"""


def refusal(text: str, *overrides: str) -> str:
    with pytest.raises(SceneError) as caught:
        loads_scene(text, "s.yaml", overrides)
    return str(caught.value)


def changed(old: str, new: str) -> str:
    assert old in SCENE
    return SCENE.replace(old, new)
