"""Magnitudes: what no arithmetic holds is refused by key and place, what is only unusual is not."""

import math
from dataclasses import replace

import numpy as np
import pytest
from half_scene import SCENE, refusal

from ribbonopt import scene as room
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene, limits, loads_scene, validate_scene
from ribbonopt.scene.units import in_special_units, units_of

CLAMPED = "{support: clamped, position: [0, 0, 0.9], directors: identity}"
SIZES = "{length: %s, width: %s, thickness: %s, youngs_modulus: %s, poisson_ratio: 0.3}"


def test_what_is_computed_of_the_largest_and_the_least_number_is_finite() -> None:
    assert math.isfinite(limits.LARGEST**7 * limits.LARGEST**3)
    assert limits.SMALLEST**7 * limits.SMALLEST**3 > np.finfo(float).tiny
    assert 1 / limits.SMALLEST**10 < math.inf
    # A frame of the largest angle, and a position at the largest distance, keep ten digits.
    assert max(limits.ANGLE, limits.REACH) * np.finfo(float).eps < 1e-9
    assert limits.HALF_TWISTS * math.pi < limits.ANGLE


@pytest.mark.parametrize(
    ("override", "found"),
    [
        ("interval=[0, 1e155]", "interval.1=: found 1e+155, expected at most 1e+30"),
        ("interval=[1e20, 100000000000000100000]", "begins further from 0 than 1e+06 times"),
        ("interval=[0, 1e-200]", "has length 1e-200, expected at least 1e-30"),
        ("law.epsilon=1e300", "found 1e+300, expected at most 1e+30 in size"),
        ("law.epsilon=1e7", "expected at most 1e+06 in size: nothing is left of the law"),
        ("law={type: kirchhoff, B2: 1e-200}", "law.B2: found 1e-200, expected at least 1e-30"),
        ("law={type: kirchhoff, B2: 1e-9, B3: 1e9}", "which is 1e+18 times law.B2"),
        ("parameters.turn=1e31", "found 1e+31, expected at most 1e+30"),
        ("boundary.end.position={x: 1e300}", "found 1e+300"),
        ("boundary.end.position={x: 1e8}", "found 1e+08, expected at most 1e+06 L in size"),
        ("boundary.end.position={x: 1e9*turn}", "found 5e+08, expected at most 1e+06 L"),
        ("boundary.end.position={x: 1e29*1e9}", "found 1e+38, expected at most 1e+30"),
        ("boundary.end.force={x: -1e13}", "found -1e+13, expected at most 1e+12 D w / L^2"),
        ("boundary.end.moment={x: 1e7}", "expected at most 1e+06 D w / L in size"),
        ("loads.force=[0, 0, 1e19]", "expected at most 1e+18 D w / L^3 in size"),
        ("guess={strains: [0, 1e7]}", "guess.strains.1: found 1e+07, expected at most 1e+06 1 / L"),
        ("guess={arc: 1e9}", "expected at most 100000 rad in size"),
        ("boundary.start.directors={turns: [{x: 1e9}]}", "expected at most 100000 rad in size"),
        ("boundary.also=['dot(n, ex) = 1e31']", "number too large, expected at most 1e+30"),
        ("boundary.also=%s" % [f"n1(end) = {i}" for i in range(101)], "at most 100 of them"),
        ("transcription={type: collocation, intervals: 1000000000}", "expected at most 20,000"),
        ("transcription={type: shooting, steps: 1000000000}", "expected at most 100"),
        ("starts=0x7fffffffffffffffffffffff", "expected at most 10,000"),
        ("seed=1" + 390 * "0", "expected at most 340,282,366"),
        ("guess={moebius: {half_twists: -1000000000}}", "expected at most 1,000"),
        ("solver={type: newton, max_iterations: 1000000000}", "expected at most 100,000"),
    ],
)
def test_numbers_too_large_or_too_small_are_refused_by_key(override: str, found: str) -> None:
    key = override.partition("=")[0]
    message = refusal(SCENE, override)
    assert key in message and "--set" in message
    for part in found.split("=: "):
        assert part in message


@pytest.mark.parametrize("digits", ["9" * 5000, "-" + "9" * 5000, "0x" + "f" * 5000, "0o7" * 5000])
@pytest.mark.parametrize("key", ["starts", "law.epsilon", "interval.1", "transcription.degree"])
def test_numbers_of_thousands_of_digits_are_refused(digits: str, key: str) -> None:
    assert key in refusal(SCENE, f"{key}={digits}")


@pytest.mark.parametrize(
    ("to", "parameter", "why"),
    [
        ("1e300", "law.epsilon", "found 1e+300, expected at most 1e+30"),
        ("1e7", "law.epsilon", "found 1e+07, which makes no valid scene"),
        ("1e200", "parameters.turn", "found 1e+200, expected at most 1e+30"),
        ("1e8", "parameters.turn", "found 1e+08, which makes no valid scene"),
    ],
)
def test_continuations_lead_to_no_such_number(to: str, parameter: str, why: str) -> None:
    stage = f"continuation: {{parameter: {parameter}, to: {to}}}\n"
    message = refusal(SCENE + stage)
    assert f"line 15, continuation.to: {why}" in message


def test_an_end_of_a_stage_counts_few_points() -> None:
    stage = "continuation: {parameter: law.epsilon, to: 0.1, stop: [%s folds]}\n"
    loads_scene(SCENE + stage % 1000)
    for count in (1001, 10**6, "9" * 400):
        assert "expected at most 1000" in refusal(SCENE + stage % count)


@pytest.mark.parametrize(
    ("length", "width", "thickness", "modulus"),
    [
        (1e-8, 1e-9, 3.35e-10, 1e12),  # graphene
        (3.4e-6, 2e-9, 1e-9, 3e8),  # a plasmid of 10,000 base pairs
        (0.3, 0.01, 1e-4, 4.5e9),  # polyester film
        (1e3, 1e-3, 1e-4, 2e11),  # a kilometre of steel tape
        (4e7, 1.0, 1e-2, 2e11),  # around the Earth
    ],
)
def test_real_ribbons_are_all_sound(
    length: float, width: float, thickness: float, modulus: float
) -> None:
    text = (
        f"name: a\nlaw: {{type: sadowsky}}\nribbon: {SIZES % (length, width, thickness, modulus)}"
    )
    text += "\nboundary: {start: {support: clamped, position: [0, 0, 0], directors: identity},"
    scene = loads_scene(
        f"{text} end: {{support: clamped, position: [0, 0, {0.8 * length}], directors: identity}}}}"
    )
    units = units_of(scene)
    assert math.isfinite(units.force) and in_special_units(scene).interval == (0, 1)
    # A load that bends it to a thousandth of its length, in newtons.
    free = room.End("free", force=(0.0, 1e6 * units.force, 0.0))
    validate_scene(replace(scene, boundary=replace(scene.boundary, end=free)))


def test_what_counts_are_sizes_in_units_of_the_ribbon() -> None:
    text = "name: a\nlaw: {type: sadowsky}\nribbon: " + SIZES % (1e-8, 1e-9, 3e-10, 1e12)
    text += f"\nboundary: {{start: {CLAMPED.replace('0.9', '0')}, end: {{support: free, force: "
    unit = units_of(loads_scene(text + "[0, 0, 0]}}")).force
    loads_scene(f"{text}[0, {9e11 * unit}, 0]}}}}")
    message = refusal(f"{text}[0, {2e12 * unit}, 0]}}}}")
    assert "line 4, boundary.end.force.1: found" in message
    assert "which is 2e+12 D w / L^2, expected at most 1e+12 D w / L^2" in message
    assert "look at ribbon as well" in message


def built(**changes: object) -> Scene:
    return replace(loads_scene(SCENE), **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "changes",
    [
        {"interval": (0.0, math.inf)},
        {"interval": (0.0, math.nan)},
        {"interval": (0.0, np.float64(1e200))},
        {"interval": (0.0, True)},
        {"starts": 10**5000},
        {"starts": True},
        {"starts": np.int64(3)},
        {"tolerance": 10**400},
        {"parameters": {"turn": -(10**5000)}},
        {"switching": (0.1,) * 101},
        {"switching": [0.1] * 20_000},
        {"law": room.Regularized(epsilon=1e200)},
    ],
)
def test_scenes_of_python_are_checked_as_strictly(changes: dict[str, object]) -> None:
    with pytest.raises(SceneError, match=f"scene: {next(iter(changes))}"):
        validate_scene(built(**changes))


def test_numbers_of_numpy_are_numbers() -> None:
    assert validate_scene(built(interval=(np.float64(0), np.float64(0.5)))).interval == (0, 0.5)
