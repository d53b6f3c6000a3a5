"""Symmetric and antisymmetric modes: those of arches alternate, and a skew shape has neither."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from made_modes import made_modes

from ribbonopt import load_scene, loads_scene, solve
from ribbonopt.checks.modes import Modes, modes_of
from ribbonopt.checks.parity import parities
from ribbonopt.solution.solution import Solution

CONFIGS = Path(__file__).parents[3] / "configs"
SHEARED = """\
name: sheared
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0.1, 0.75], directors: identity}
tolerance: 1e-9
"""


@cache
def arch(angle: float = 0.0) -> Solution:
    return solve(load_scene(CONFIGS / "snap.yaml", [f"parameters.angle={angle}", "planar=true"]))


def in_plane(solution: Solution, count: int) -> Modes:
    found = modes_of(solution, count, planar=True)
    assert isinstance(found, Modes)
    return found


def test_modes_of_an_arch_alternate() -> None:
    """In the plane the first is antisymmetric (table of the buckled strip)."""
    words = parities(arch(), in_plane(arch(), 5))
    assert words == ("antisymmetric", "symmetric") * 2 + ("antisymmetric",)


def test_waves_across_the_plane_are_judged_by_what_is_seen() -> None:
    """One bump to the side is symmetric, as one in the plane is; two are not."""
    words = parities(arch(), made_modes(arch()))
    assert words == ("symmetric", "symmetric", "antisymmetric", "antisymmetric")


def test_what_moves_nothing_is_judged_by_how_it_turns() -> None:
    """Twist that is the same both ways from the middle, about a tangent that is mirrored."""
    modes, d3 = made_modes(arch()), arch().outputs(made_modes(arch()).s)["d3"]
    ways = np.stack([np.sin(k * np.pi * modes.s)[:, None] * d3 for k in (1, 2, 1, 2)])
    twist = replace(modes, displacement=1e-12 * modes.displacement, rotation=ways)
    words = parities(arch(), twist)
    assert words[:2] == words[2:]
    assert set(words) == {"symmetric", "antisymmetric"}


def test_a_skew_shape_has_neither() -> None:
    assert parities(arch(20.0), in_plane(arch(20.0), 3)) == ("", "", "")


def test_a_mode_that_is_neither_says_nothing() -> None:
    modes = made_modes(arch())
    both = modes.displacement[0] + modes.displacement[2]
    mixed = replace(modes, displacement=np.stack([both, *modes.displacement[1:]]))
    assert parities(arch(), mixed)[0] == ""


def test_half_a_turn_is_a_symmetry_too() -> None:
    solution = solve(loads_scene(SHEARED))
    assert solution.verified
    found = modes_of(solution, 6)
    assert isinstance(found, Modes)
    words = parities(solution, found)
    assert set(words) == {"symmetric", "antisymmetric"}
    # By the half turn itself: about the axis x through the middle.
    turn = np.diag([1.0, -1.0, -1.0])
    s = np.linspace(0, 1, 101)
    for word, moved in zip(words, found.displacement, strict=True):
        at = np.stack([np.interp(s, found.s, column) for column in moved.T], axis=1)
        sign = 1 if word == "symmetric" else -1
        assert np.abs(at[::-1] @ turn - sign * at).max() < 0.02 * np.abs(at).max()


@pytest.mark.parametrize("count", [0, 1])
def test_as_many_words_as_modes(count: int) -> None:
    assert len(parities(arch(), made_modes(arch(), count))) == count
