"""What a scene may say of stiffness in the ribbon's plane: units, sizes, paths, messages."""

from dataclasses import replace

import pytest

from ribbonopt import prepare, solve
from ribbonopt.errors import SceneError
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.problem import Posed
from ribbonopt.scene import Kirchhoff, Membrane, Rod, dump_scene, loads_scene
from ribbonopt.scene.lens import paths_of, value_at, with_value
from ribbonopt.scene.units import in_special_units

PLAIN = """
name: edge
law: {{type: {law}}}
membrane: {membrane}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free}}
"""
SIZES = "{length: 0.5, width: 0.01, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.4}"
SI = PLAIN + f"ribbon: {{{SIZES}}}\n"


def test_numbers_are_parameters_that_can_be_continued() -> None:
    scene = loads_scene(PLAIN.format(law="sadowsky", membrane="{bending: 900, stretching: 1e5}"))
    assert scene.membrane == Membrane(900.0, 1e5)
    assert {"membrane.bending", "membrane.stretching"} <= set(paths_of(scene))
    moved = with_value(scene, "membrane.bending", 800.0)
    assert value_at(moved, "membrane.bending") == 800
    one, other = Posed.of(scene), Posed.of(moved)
    assert one.structure == other.structure
    assert (one.theta["membrane.bending"], other.theta["membrane.bending"]) == (900, 800)
    assert loads_scene(dump_scene(scene)) == scene
    half = loads_scene(PLAIN.format(law="sadowsky", membrane="{bending: 900}"))
    assert "membrane.stretching" not in {*paths_of(half), *Posed.of(half).theta}
    assert Posed.of(half).structure != one.structure


def test_without_one_there_are_no_numbers_of_it() -> None:
    scene = loads_scene(PLAIN.format(law="sadowsky", membrane="{bending: 900}"))
    bare = replace(scene, membrane=None)
    assert not [name for name in Posed.of(bare).theta if "membrane" in name]
    assert capabilities(bare).components == (1, 2)


def test_numbers_are_in_units_of_the_ribbons_own_d_w_and_length() -> None:
    """As law.B2 is: what is solved is the same, whatever the sizes."""
    numbers = "{bending: 900, stretching: 1e5}"
    for law in ("sadowsky", "kirchhoff"):
        scene = loads_scene(SI.format(law=law, membrane=numbers))
        assert in_special_units(scene).membrane == Membrane(900.0, 1e5)
        assert loads_scene(dump_scene(scene)) == scene


def test_a_ribbon_of_one_material_has_that_of_its_sizes() -> None:
    """E h w^3 / 12 over Dw, and E h w over Dw / L^2, D = E h^3 / (12 (1 - nu^2))."""
    scene = loads_scene(SI.format(law="sadowsky", membrane="ribbon"))
    found = in_special_units(scene).membrane
    assert isinstance(found, Membrane)
    E, h, w, L, nu = 2e9, 1e-4, 0.01, 0.5, 0.4
    D = E * h**3 / (12 * (1 - nu**2))
    assert found.bending == pytest.approx(E * h * w**3 / 12 / (D * w), rel=1e-14)
    assert found.stretching == pytest.approx(E * h * w / (D * w / L**2), rel=1e-14)
    assert loads_scene(dump_scene(scene)) == scene
    assert capabilities(scene).components == (0, 1, 2) and capabilities(scene).stretches


def test_where_the_unit_inside_is_another() -> None:
    """A long ribbon, a stiff law: the same ratios to law.B2 and to B2 / L^2."""
    scene = replace(
        loads_scene(PLAIN.format(law="kirchhoff", membrane="{bending: 9e5, stretching: 2e4}")),
        law=Kirchhoff(B2=1e4, B3=2e4),
        interval=(0.0, 100.0),
    )
    special = in_special_units(scene)
    assert isinstance(special.membrane, Membrane) and isinstance(special.law, Kirchhoff)
    _, length = special.interval
    B1, EA = special.membrane.bending, special.membrane.stretching
    assert B1 is not None and EA is not None
    assert B1 / special.law.B2 == pytest.approx(9e5 / 1e4)
    assert EA * length**2 / special.law.B2 == pytest.approx(2e4 * 100**2 / 1e4)
    assert in_special_units(special) == special


BAD = [
    ("sadowsky", "ribbon", r"line 4, membrane: found 'ribbon', .*from `ribbon`, which this scene"),
    ("sadowsky", "{}", r"line 4, membrane: found {}, says nothing; expected bending \(B1\), str"),
    ("sadowsky", "{bending: 0}", r"line 4, membrane\.bending: found 0, .*(greater|> 0)"),
    ("sadowsky", "{bending: -1}", r"line 4, membrane\.bending: found -1"),
    ("sadowsky", "{bend: 1}", r"line 4, membrane\.bend: .*bending"),
    ("sadowsky", "stiff", r"line 4, membrane: found 'stiff', expected .*ribbon"),
    ("sadowsky", "{bending: 1e13}", r"membrane\.bending: found 1e\+13, which is 1e\+13 Dw; expec"),
    ("sadowsky", "{stretching: 1e-40}", r"membrane\.stretching: found 1e-40, expected at least"),
    ("rod", "{bending: 2}", r"membrane\.bending: found 2, stands beside law\.B, .*; remove this"),
]


@pytest.mark.parametrize(("law", "membrane", "message"), BAD)
def test_one_message_each(law: str, membrane: str, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        loads_scene(PLAIN.format(law=law, membrane=membrane))


def test_beside_a_rod_a_ribbons_sizes_say_too_much() -> None:
    with pytest.raises(SceneError, match=r'law\.B, .* write "membrane: {stretching: \.\.\.}"'):
        loads_scene(SI.format(law="rod", membrane="ribbon"))
    scene = loads_scene(SI.format(law="rod", membrane="{stretching: 9}"))
    assert isinstance(scene.law, Rod) and capabilities(scene).stretches


CLAMPS = """
name: clamps
law: {type: sadowsky}
membrane: ribbon
ribbon: {length: 0.3, width: 0.01, thickness: 1e-4, youngs_modulus: 4.5e9, poisson_ratio: 0.38}
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end: {position: [0.204, 0.045, 0.093], directors: {rotation_vector: [0, 2.4, 0.6]}}
tolerance: 1e-9
"""


def test_si_and_special_units_say_the_same() -> None:
    scene = loads_scene(CLAMPS)
    found = solve(scene)
    special = prepare(in_special_units(scene)).solve()
    assert found.verified and special.verified
    force = 4.5e9 * 1e-12 / (12 * (1 - 0.38**2)) * 0.01 / 0.3**2
    assert found.n0 == pytest.approx(special.n0 * force, rel=1e-8)
    assert found.sample(0.15, "u1") == pytest.approx(special.sample(0.5, "u1") / 0.3, rel=1e-7)
