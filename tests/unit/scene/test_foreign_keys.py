"""Keys of what the model does not have, and of what stands elsewhere in a scene."""

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene

SCENE = "name: t\nlaw: {type: sadowsky}\nboundary: {loop: {half_twists: 1}}\n"


@pytest.mark.parametrize(
    "line, said",
    [
        ("contact: true", "contact: is not in the model: parts of the ribbon"),
        ("foundation: 3", "foundation: is not in the model: nothing elastic holds"),
        ("damping: 0.1", "damping: is not in the model: equilibria only"),
        ("loads: {friction: 1}", "loads.friction: is not in the model"),
        ("density: 1200", "density: unknown key here; it belongs under ribbon"),
        ("pressure: 3", "pressure: unknown key here; it belongs under loads"),
        ("across: 3", "across: unknown key here; it belongs under natural"),
        ("loads: {gravity: [0, 0, 1]}", "loads.gravity: unknown key here; it belongs at the top"),
        ("widht: 1", "widht: unknown key; did you mean 'width'?"),
        ("loads: {forces: 1}", "loads.forces: unknown key; did you mean 'force'?"),
    ],
)
def test_an_unknown_key_says_what_to_do(line: str, said: str) -> None:
    with pytest.raises(SceneError) as caught:
        loads_scene(SCENE + line, "t.yaml")
    assert str(caught.value).startswith(f"t.yaml, line 4, {said}")
    assert "\n" not in str(caught.value)


def test_a_list_that_is_too_short_is_told_once() -> None:
    with pytest.raises(SceneError) as caught:
        loads_scene(SCENE.replace("{type: sadowsky}", "{type: rod, B: []}"))
    assert str(caught.value).count("law.B") == 1


def test_a_quantity_of_the_ribbon_in_a_formula_along_it() -> None:
    with pytest.raises(SceneError, match="numbers and parameters, and s along the ribbon"):
        loads_scene(SCENE + "width: norm(r)")
