"""A parameter from one value to another: what the equations read, and errors of its values."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from ribbonopt.scene import loads_scene
from ribbonopt.scene.stages import stages_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation import counts
from ribbonopt.studies.continuation.coordinates import reduced
from ribbonopt.studies.continuation.curve import Curve

Solved = Callable[..., Solution]
ARCH = """
name: arch
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {a: 0.2, b: 0.5}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, %s, 0.8], directors: identity}
continuation: {parameter: %s, from: 0.1, to: 0.4%s}
"""
MOVES = [
    ("0.05", "boundary.end.position.y"),  # itself
    ("-2*a", "parameters.a"),  # in proportion
    ("0.3 - a", "parameters.a"),  # affine
    ("a**2", "parameters.a"),  # bent
    ("a + a*b", "parameters.a"),
]


def curve_of(place: str, parameter: str, more: str = "") -> Curve:
    scene = loads_scene(ARCH % (place, parameter, more))
    return Curve(scene, stages_of(scene)[0])


@pytest.mark.parametrize("scale", ["", ", scale: log"])
@pytest.mark.parametrize(("place", "parameter"), MOVES)
def test_equations_read_what_the_scene_says(place: str, parameter: str, scale: str) -> None:
    """However the numbers of the equations depend on what moves."""
    curve = curve_of(place, parameter, scale)
    for value in (0.1, 0.17, 0.25, 0.333, 0.4, 0.6):
        position = curve.position(value)
        expected = curve.posed_at(position).values
        np.testing.assert_allclose(curve._theta(position), expected, rtol=1e-15)


@pytest.mark.parametrize("scale", ["", ", scale: log"])
def test_errors_of_positions_are_told_as_errors_of_values(scale: str) -> None:
    curve = curve_of("0.05", "boundary.end.position.y", scale)
    for value in (0.1, 0.2, 0.4):
        position, moved = curve.position(value), 1e-6
        change = abs(curve.value(position + moved) - curve.value(position)) / value
        assert curve.relative(moved, position) == pytest.approx(change, rel=1e-4)


def test_errors_of_small_values_are_relative_to_the_span() -> None:
    curve = curve_of("0.05", "boundary.end.position.y")
    assert curve.relative(1e-6, 1e-9) == pytest.approx(1e-6 / (0.1 * 0.3))


@pytest.mark.parametrize(
    ("before", "after", "changes", "explained"),
    [
        (0, 0, 0, True),
        (0, 1, 1, True),
        (2, 1, 1, True),
        (0, 0, 2, True),  # there and back
        (0, 2, 2, True),
        (0, 1, 0, False),
        (0, 2, 1, False),
        (0, 0, 1, False),  # one test function changes its sign, and no direction does
        (1, 2, 2, False),
    ],
)
def test_each_special_point_changes_the_count_by_one(
    monkeypatch: pytest.MonkeyPatch, before: int, after: int, changes: int, explained: bool
) -> None:
    monkeypatch.setattr(counts, "negative_directions", lambda solution: solution.count)
    monkeypatch.setattr(counts, "negative_range", lambda solution: (solution.count,) * 2)
    scene = loads_scene(ARCH % ("0.05", "parameters.a", ""))
    a, b = (type("Counted", (), {"count": count, "scene": scene}) for count in (before, after))
    first: Any = a
    second: Any = b
    told = counts.unexplained(first, second, changes)
    assert (told == "") == explained
    if told:
        assert told.endswith(f"from {before} to {after}")


def test_an_equilibrium_is_told_by_both_ends_its_loads_and_where_it_is(solved: Solved) -> None:
    found = solved("clamped_arch")
    told = reduced(found, np.append(found.dense.w, 0.7))
    nodes, constants = found.dense.at_nodes, found.constants[:6]
    np.testing.assert_array_equal(told, [*nodes[0], *nodes[-1], *constants, 0.7])
