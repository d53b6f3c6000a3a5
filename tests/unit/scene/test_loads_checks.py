"""What is wrong with loads along the ribbon: one message each."""

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene

SIZES = "length: 0.5, width: 0.02, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3"


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("gravity: [0, 0, -9.81]", r"gravity: .*needs to know the ribbon, in metres"),
        (f"gravity: [0, 0, -9.81]\nribbon: {{{SIZES}}}", r"gravity: .*needs the density"),
        (f"ribbon: {{{SIZES}, density: -3}}", r"ribbon\.density"),
        (f"gravity: [0, 0, 1e29]\nribbon: {{{SIZES}, density: 1e9}}", r"gravity\.2: .*is a weight"),
        ("gravity: {down: 9.81}", r"gravity\.down"),
        (f"gravity: {{z: unknown}}\nribbon: {{{SIZES}, density: 1}}", r"gravity\.z: .*unknown"),
        ("loads: {pressure: [1, 2, 3]}", r"loads\.pressure"),
        ("loads: {pressure: 1e20}", r"loads\.pressure: .*expected at most"),
        ("loads: {couple: [0, 0, 1e16]}", r"loads\.couple\.2: .*expected at most"),
        ("loads: {couple: {z: '1/s'}}", r"loads\.couple\.z: .*has no finite real value at s = 0"),
        ("loads: {force: {z: {s: [0, 0.5], values: [1, 1]}}}", r"loads\.force\.z\.s: .*covers s"),
        ("loads: {force: {z: 'weight*s'}}", r"loads\.force\.z: .*weight"),
    ],
)
def test_bad_loads_are_refused_with_one_message(text: str, match: str) -> None:
    scene = "name: a\nlaw: {type: sadowsky}\nboundary: {start: {support: clamped, position: "
    scene += "[0, 0, 0], directors: identity}, end: {support: free}}\n"
    with pytest.raises(SceneError, match=match) as caught:
        loads_scene(scene + text)
    assert "problems" not in str(caught.value)
