"""What ends may say of a ribbon's edges beside supports, and what is told of a faulty scene."""

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene
from ribbonopt.scene.edges import edge_of

SCENE = """
name: edges
law: {law}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{{end}}}
"""
WIDE = "{type: wunderlich, width: 0.05}"
HINGED = "support: hinged, position: [0.5, 0, 0.3], axis: d2, along: [0, 1, 0]"
FLIP = "support: flip, position: [0.3, 0, 0.3], along: [0, 1, 0], axis: d2"
CLAMPED = "support: clamped, position: [0.6, 0, 0.3], directors: identity"
PINNED = "support: pinned, position: [0.6, 0, 0.3]"


@pytest.mark.parametrize("end", [HINGED, CLAMPED, PINNED, "support: free"])
@pytest.mark.parametrize("edge", ["straight", "free"])
def test_a_support_may_say_what_it_does_to_the_edge(end: str, edge: str) -> None:
    scene = loads_scene(SCENE.format(law=WIDE, end=f"{end}, edge: {edge}"))
    assert edge_of(scene.boundary.end) == edge


def test_a_hinge_has_to_say_it() -> None:
    with pytest.raises(SceneError, match=r"boundary\.end\.edge: missing.*straight.*free"):
        loads_scene(SCENE.format(law=WIDE, end=HINGED))


@pytest.mark.parametrize("edge", ["straight", "free"])
def test_an_axis_of_symmetry_tells_by_itself(edge: str) -> None:
    loads_scene(SCENE.format(law=WIDE, end=FLIP))
    with pytest.raises(SceneError, match=r"boundary\.end\.edge.*axis of symmetry.*remove it"):
        loads_scene(SCENE.format(law=WIDE, end=f"{FLIP}, edge: {edge}"))


@pytest.mark.parametrize("end", [HINGED, FLIP, CLAMPED, PINNED])
def test_other_laws_refuse_it_beside_supports_too(end: str) -> None:
    with pytest.raises(SceneError, match=r"boundary\.end\.edge.*sadowsky knows no edges"):
        loads_scene(SCENE.format(law="{type: sadowsky}", end=f"{end}, edge: free"))


def test_of_a_law_that_is_sound_nothing_false_is_said_beside_other_faults() -> None:
    text = SCENE.format(law=WIDE, end=f"{HINGED}, edge: free") + "foo: 3\n"
    with pytest.raises(SceneError, match="foo") as error:
        loads_scene(text)
    assert "edge" not in str(error.value)


@pytest.mark.parametrize(
    ("law", "more"),
    [
        ("{type: wunderlich, width: x}", ""),
        ("wunderlich", "ribbon: {length: 1, width: 0.01, thickness: -1}\n"),
    ],
)
def test_nothing_is_said_of_what_a_faulty_law_or_ribbon_would_settle(law: str, more: str) -> None:
    text = SCENE.format(law=law, end=f"{HINGED}, edge: free") + more
    with pytest.raises(SceneError) as error:
        loads_scene(text)
    assert "edge" not in str(error.value)
    assert "law.width: missing" not in str(error.value)


@pytest.mark.parametrize("number", ["B2: 1e30, B3: 2", "B2: 1, B3: 1e-30"])
def test_stiffnesses_are_not_too_unlike_that_of_the_plate(number: str) -> None:
    law = f"{{type: sano, {number}, zeta: 0.1}}"
    with pytest.raises(SceneError, match=r"law\.B.*in units of Dw; expected from 1e-12 to 1e\+12"):
        loads_scene(SCENE.format(law=law, end=CLAMPED))


@pytest.mark.parametrize(
    ("law", "more", "path"),
    [
        ("{type: wunderlich, width: 1e-9}", "", "law.width"),
        (
            "wunderlich",
            "ribbon: {length: 1, width: 9e-6, thickness: 1e-9, youngs_modulus: 1, "
            "poisson_ratio: 0.3}\n",
            "ribbon.width",
        ),
    ],
)
def test_ribbons_too_narrow_for_their_layers(law: str, more: str, path: str) -> None:
    with pytest.raises(SceneError, match=rf"{path}.*at least 1e-05 L.*write law: sadowsky"):
        loads_scene(SCENE.format(law=law, end=CLAMPED) + more)
    wide = law.replace("1e-9", "1e-4")
    loads_scene(SCENE.format(law=wide, end=CLAMPED) + more.replace("9e-6", "2e-5"))
