"""Scenes in SI become scenes in units Dw = L = 1, once; equations have the dimensions they say."""

from dataclasses import replace

import pytest

from ribbonopt.mechanics.ends.dimensions import dimension_of_equation
from ribbonopt.scene import (
    AnyVector,
    ArcGuess,
    Boundary,
    Directors,
    End,
    LabVector,
    LoadGuess,
    Loop,
    Reference,
    RibbonSizes,
    Sadowsky,
    Scene,
    SolutionGuess,
    StrainGuess,
)
from ribbonopt.scene.formulas.parsing import parse_equation
from ribbonopt.scene.units import Units, in_special_units, units_of

# D = 12 x 1e-3 / (12 x 0.75) and w = 0.375: D w = 5e-4, and L = 2.
RIBBON = RibbonSizes(2.0, 0.375, 0.1, 12.0, 0.5)
UNITS = Units(length=2.0, force=1.25e-4, si=True)
SCENE = Scene(
    "a",
    Sadowsky(),
    Boundary(
        End(
            support="sliding",
            position=(1.0, "half", 0.0),
            directors=Directors(d1=(1.0, 0.0, 0.0), d3=(0.0, 0.0, 1.0)),
            along=(0.0, 0.0, 3.0),
            force=AnyVector(d3="2 * half"),
        ),
        End(position=LabVector(z=4.0), d1=LabVector(x=0.5), moment=(0.0, 1.0, -1.0)),
    ),
    LoadGuess((1.0, 0.0, 2.0), (0.0, 1.0, 0.0)),
    interval=(1.0, 2.0),
    parameters={"half": 0.5},
    reference=Reference((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ribbon=RIBBON,
)
F, M = 1.25e-4, 2.5e-4


def test_units_follow_from_the_sizes_of_the_ribbon() -> None:
    found = units_of(SCENE)
    assert found.length == 2.0
    assert found.force == pytest.approx(F, rel=1e-15)
    assert found.moment == pytest.approx(M, rel=1e-15)
    assert found.strain == 0.5
    assert found.name == "SI (m, N, N m, J)"
    dimensions = {"r": 2.0, "n": F, "m2": M, "u3": 0.5, "H": F, "energy": F, "n_dot_m": F * M}
    for name, unit in dimensions.items():
        assert found.of(name) == pytest.approx(unit, rel=1e-14), name
    assert found.of("eta") == found.of("d1") == 1.0


def test_a_ribbon_of_unit_size_is_still_in_si() -> None:
    ribbon = RibbonSizes(1.0, 0.1, 0.01, 12 / (0.1 * 0.01**3), 0.0)
    found = units_of(replace(SCENE, ribbon=ribbon))
    assert (found.length, found.force) == (1.0, pytest.approx(1.0))
    assert found.si
    assert found.name.startswith("SI")


def test_scenes_without_sizes_stay_themselves() -> None:
    scene = replace(SCENE, ribbon=None)
    assert in_special_units(scene) is scene
    assert units_of(scene) == Units()
    assert units_of(scene).name == "Dw = L = 1"


def test_every_number_with_a_dimension_is_divided_by_its_unit() -> None:
    found = in_special_units(SCENE)
    start, end = found.boundary.start, found.boundary.end
    assert found.ribbon is None
    assert found.interval == (0.5, 1.0)
    assert start.position == (0.5, 0.25, 0.0)
    assert start.force == AnyVector(d3=pytest.approx(1 / F))
    assert end.position == LabVector(z=2.0)
    assert end.moment == (0.0, pytest.approx(1 / M), pytest.approx(-1 / M))
    assert found.guess.force == (pytest.approx(1 / F), 0.0, pytest.approx(2 / F))
    assert found.guess.moment == (0.0, pytest.approx(1 / M), 0.0)
    assert found.reference.n0 == (0.0, pytest.approx(1 / F), 0.0)
    assert found.reference.m0 == (0.0, 0.0, pytest.approx(1 / M))
    # What has none is left alone.
    assert (start.support, start.directors, start.along) == (
        *(SCENE.boundary.start.support, SCENE.boundary.start.directors),
        SCENE.boundary.start.along,
    )
    assert end.d1 == LabVector(x=0.5)
    assert (found.parameters, found.law, found.name) == ({"half": 0.5}, SCENE.law, "a")


def test_distances_and_places_of_switches_are_lengths() -> None:
    held = replace(SCENE, boundary=Boundary(end=End(support="held", distance="3 * half")))
    assert in_special_units(held).boundary.end.distance == 0.75
    assert in_special_units(replace(SCENE, switching=(1.5,))).switching == (0.75,)
    assert in_special_units(replace(SCENE, switching="off")).switching == "off"


@pytest.mark.parametrize(
    ("guess", "expected"),
    [
        ("auto", "auto"),
        ("circle", "circle"),
        (ArcGuess("half"), ArcGuess("half")),
        (SolutionGuess("there"), SolutionGuess("there")),
        (StrainGuess((3.0, 0.5)), StrainGuess((6.0, 1.0))),
    ],
)
def test_guesses_of_strains_have_a_dimension_and_those_of_angles_none(guess, expected) -> None:
    assert in_special_units(replace(SCENE, guess=guess)).guess == expected


def test_nothing_is_converted_twice() -> None:
    once = in_special_units(SCENE)
    assert in_special_units(once) is once
    assert units_of(once) == Units()


def test_equations_keep_their_text_and_bring_the_units_along() -> None:
    also = ("norm(r(end)) = half",)
    scene = replace(SCENE, boundary=Boundary(also=also, loop=Loop(1)))
    found = in_special_units(scene)
    assert found.boundary == scene.boundary
    assert found.parameters == {
        "half": 0.5,
        "units.length": 2.0,
        "units.force": pytest.approx(F),
    }
    assert scene.parameters == {"half": 0.5}


def test_long_formulas_are_not_too_long_once_converted() -> None:
    formula = f"half + 0.{'0' * 490}"  # of at most 500 characters
    scene = replace(SCENE, boundary=Boundary(End(position=(formula, 0.0, 0.0))))
    assert in_special_units(scene).boundary.start.position == (0.25, 0.0, 0.0)


@pytest.mark.parametrize(
    ("text", "length", "force"),
    [
        ("norm(r(end)) = 0.2", 1, 0),
        ("r(end) = [0.1, 0, k]", 1, 0),
        ("r(end).z - 0.1 = 0", 1, 0),
        ("dot(r(end), r(end)) = 0.04", 2, 0),
        ("sqrt(dot(r(end), r(end))) = 0.2", 1, 0),
        ("dot(r(end) - r(start), ex) = k", 1, 0),
        ("dot(n, d1(start)) = 0", 0, 1),
        ("cross(r(end), n) = [0, 0, 1]", 1, 1),
        ("[m1(end), 0, 0] = [1, 2, 3]", 1, 1),
        ("-abs(m1(end)) = k", 1, 1),
        ("m2(end)**2 + m3(end)**2 = k**2", 2, 2),
        ("u2(end) = 3", -1, 0),
        ("1 / u2(end) = dot(r(end), ex)", 1, 0),
        ("dot(d1(start), d1(end)) = 0", 0, 0),
        ("n1(end) / n3(end) = 1", 0, 0),
        ("sin(k * u2(end)) = 0", 0, 0),
        # Parameters and numbers have any dimension: what is sure decides.
        ("n3(end) = k * dot(r(end), ez)", 0, 1),
        ("k * dot(r(end), ez) = n3(end)", 0, 1),
        ("m2(end) - k * u2(end) = 0", 1, 1),
        ("k / dot(r(end), ex) = n1(end)", 0, 1),
        ("2 * n1(end) = k", 0, 1),
        ("n2(end)**k = 1", 0, 0),
        ("n2(end)**-2 = 1", 0, -2),
    ],
)
def test_dimensions_of_equations(text: str, length: float, force: float) -> None:
    formula = parse_equation(text, ["k"])
    found = dimension_of_equation(formula.left, formula.right)
    assert (found.length, found.force) == (length, force)
