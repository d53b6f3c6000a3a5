"""What a scene may say of inertia, and of the frequencies along its continuation."""

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene
from ribbonopt.scene.inertia import Inertia, of_width
from ribbonopt.scene.units import in_special_units

SCENE = """name: t
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free}
"""
SIZES = "ribbon: {length: 2, width: 0.1, thickness: 1e-3, youngs_modulus: 1e9, poisson_ratio: 0.3"
SI = SCENE.replace(", B2: 1, B3: 2", "") + SIZES


@pytest.mark.parametrize(
    "more, said",
    [
        (
            "inertia: ribbon",
            "inertia: found 'ribbon', takes its numbers from the width",
        ),
        ("inertia: {}", "inertia: found {}, says nothing; expected d1, d3 or both"),
        ("inertia: {d3: -1}", "inertia.d3"),
        ("inertia: {d3: 4}", "expected at most the squared length, 1"),
        ("inertia: {d2: 0.1}", "inertia.d2: unknown key"),
        ("inertia: strip", "inertia"),
        ("continuation: {parameter: law.B2, to: 2, modes: -1}", "continuation.modes"),
        ("continuation: {parameter: law.B2, to: 2, modes: 101}", "continuation.modes"),
        ("continuation: {parameter: law.B2, to: 2, modes: two}", "continuation.modes"),
    ],
)
def test_what_is_wrong_is_told_once(more: str, said: str) -> None:
    with pytest.raises(SceneError) as caught:
        loads_scene(SCENE + more, "t.yaml")
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_hertz_need_a_density() -> None:
    stage = "continuation: {parameter: boundary.end.force.0, from: 0, to: 1, modes: 2}\n"
    scene = SI.replace("{support: free}", "{support: free, force: [0, 0, 0]}")
    with pytest.raises(SceneError, match="need the density of the ribbon, in kg/m"):
        loads_scene(f"{scene}}}\n{stage}")
    assert loads_scene(f"{scene}, density: 1000}}\n{stage}").continuation is not None


def test_inside_its_unit_is_the_length_squared() -> None:
    scene = in_special_units(loads_scene(SI + "}\ninertia: ribbon\n"))
    assert scene.inertia == of_width(0.05) == Inertia(0.05**2 / 12, 0.05**2 / 12)
    scene = in_special_units(loads_scene(SI + "}\ninertia: {d3: 0.4}\n"))
    assert scene.inertia == Inertia(0.0, 0.1)
