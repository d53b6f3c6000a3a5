"""What a scene may say of natural strains: units, defaults, continuation, and one message each."""

from dataclasses import replace

import numpy as np
import pytest

from ribbonopt.errors import ModelError, SceneError
from ribbonopt.mechanics.laws.catalogue import capabilities, curvature_across, fields_of
from ribbonopt.problem import Posed
from ribbonopt.scene import Kirchhoff, Natural, dump_scene, loads_scene
from ribbonopt.scene.lens import paths_of, value_at, with_value
from ribbonopt.scene.units import in_special_units

PLAIN = """
name: curl
law: {{type: {law}}}
natural: {{{natural}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free}}
"""
SI = (
    PLAIN
    + """
ribbon: {{length: 0.5, width: 0.01, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.4}}
"""
)


def test_numbers_are_parameters_that_can_be_continued() -> None:
    scene = loads_scene(PLAIN.format(law="sadowsky", natural="curvature: 2, poisson_ratio: 0.3"))
    assert scene.natural == Natural(2.0, 0.0, 0.0, 0.3)
    paths = {f"natural.{name}" for name in ("curvature", "twist", "across", "poisson_ratio")}
    assert paths <= set(paths_of(scene))
    moved = with_value(scene, "natural.curvature", 3.0)
    assert value_at(moved, "natural.curvature") == 3
    one, other = Posed.of(scene), Posed.of(moved)
    assert one.structure == other.structure
    assert (one.theta["natural.curvature"], other.theta["natural.curvature"]) == (2, 3)
    assert loads_scene(dump_scene(scene)) == scene


def test_without_natural_strains_there_are_no_numbers_of_them() -> None:
    scene = loads_scene(PLAIN.format(law="sadowsky", natural="curvature: 2"))
    bare = replace(scene, natural=None)
    assert not [name for name in Posed.of(bare).theta if "natural" in name]
    assert not capabilities(bare).natural
    assert capabilities(scene).natural


def test_si_curvatures_are_per_metre_and_poissons_ratio_is_the_ribbons() -> None:
    scene = loads_scene(SI.format(law="sadowsky", natural="curvature: 8, twist: '2*s', across: 1"))
    special = in_special_units(scene).natural
    assert special is not None
    assert (special.curvature, special.across, special.poisson_ratio) == (4.0, 0.5, 0.4)
    assert curvature_across(scene) == pytest.approx(1 + 0.4 * 8)
    posed = Posed.of(scene)
    (twist,) = (field for field in fields_of(posed.scene) if field.name == "natural.twist")
    # At s = 0.25 m it is 0.5 per metre, 0.25 per length of the ribbon.
    np.testing.assert_allclose(twist.sampled(np.array([0.5]), posed.theta), 0.25)
    said = loads_scene(SI.format(law="sadowsky", natural="curvature: 8, poisson_ratio: 0"))
    assert in_special_units(said).natural == Natural(4.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("text", "law", "natural", "words"),
    [
        (
            PLAIN,
            "kirchhoff",
            "across: 1",
            ["natural.across", "found 1", "kirchhoff", "variational"],
        ),
        (PLAIN, "regularized", "across: 's'", ["natural.across", "found s", "regularized"]),
        (
            PLAIN,
            "homotopy",
            "curvature: 1, poisson_ratio: 0.3",
            ["natural.poisson_ratio", "found 0.3", "poisson_ratio: 0"],
        ),
        (SI, "kirchhoff", "curvature: 1", ["natural.poisson_ratio", "0.4", "poisson_ratio: 0"]),
        (PLAIN, "rod", "curvature: 1", ["natural", "law.natural", "rod"]),
        (PLAIN, "sadowsky", "curvature: '1/s'", ["natural.curvature", "s = 0"]),
        (PLAIN, "sadowsky", "curvature: 'q*s'", ["natural.curvature", "q"]),
        (PLAIN, "sadowsky", "curvature: 1e8", ["natural.curvature", "1e+06"]),
        (PLAIN, "sadowsky", "poisson_ratio: 0.7", ["natural.poisson_ratio", "0.5"]),
        (PLAIN, "sadowsky", "curvatur: 1", ["natural.curvatur", "curvature"]),
    ],
)
def test_one_message_each(text: str, law: str, natural: str, words: list[str]) -> None:
    with pytest.raises(SceneError) as caught:
        loads_scene(text.format(law=law, natural=natural))
    message = str(caught.value)
    assert message.count("natural") >= 1
    for word in words:
        assert word in message


@pytest.mark.parametrize("law", ["kirchhoff", "regularized", "homotopy"])
def test_laws_that_are_no_plates_bend_and_twist_by_themselves(law: str) -> None:
    natural = "curvature: 1, twist: '0.3*s', poisson_ratio: 0"
    for text in (PLAIN, SI):
        scene = loads_scene(text.format(law=law, natural=natural))
        assert capabilities(in_special_units(scene)).natural


def test_scenes_that_were_not_checked_are_refused_too() -> None:
    scene = loads_scene(PLAIN.format(law="sadowsky", natural="across: 2"))
    with pytest.raises(ModelError, match=r"natural\.across: found 2"):
        capabilities(replace(scene, law=Kirchhoff()))
