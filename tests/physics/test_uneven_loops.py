"""Closed bands that cannot slide along themselves: what they are, or what acts, varies along them.

All of their gap is prescribed; for a band that slides n1(0) = 0 stands for one component of it.
"""

import numpy as np
import pytest
from independent.confirm import confirm

from ribbonopt import loads_scene, solve
from ribbonopt.errors import ModelError
from ribbonopt.pipeline.check import check_scene

BAND = "name: t\nlaw: {type: LAW}\nboundary: {loop: {half_twists: TWISTS, piece: PIECE}}\n"


def band(law: str, half_twists: int, rest: str, piece: str = "whole") -> str:
    text = BAND.replace("LAW", law).replace("TWISTS", str(half_twists)).replace("PIECE", piece)
    return f"{text}{rest}\ntolerance: 1e-8"


@pytest.mark.parametrize(
    "law, half_twists, rest",
    [
        ("kirchhoff", 2, "natural: {curvature: 1 + 0.3*s}"),
        ("kirchhoff", 1, "natural: {curvature: 1}"),  # the other way behind half a twist
        ("kirchhoff", 1, "width: 1 - 0.3*s"),
        ("kirchhoff", 1, "width: 1 + 0.1*cos(2*pi*s)"),  # the same at both ends
        ("sadowsky", 2, "loads: {force: {x: 2, y: 1}}"),
    ],
)
def test_an_uneven_loop_is_closed(law: str, half_twists: int, rest: str) -> None:
    solution = solve(loads_scene(band(law, half_twists, rest)))
    assert solution.verified
    ends = solution.sample(np.array([0.0, 1.0]), "r")
    assert np.abs(ends[1] - ends[0]).max() < 1e-9
    assert confirm(solution) < 1e-7


@pytest.mark.parametrize(
    "half_twists, rest, said",
    [
        (1, "loads: {force: {z: 1}}", "by flips, after which loads.force is another"),
        (2, "loads: {pressure: 1}", "states: planar"),
        (2, "supports: [{at: 0.2, position: {x: 0.1}}]", "after which supports.0 is another"),
        (1, "natural: {curvature: s}", "by flips about d2, after which the natural strains"),
    ],
)
def test_a_piece_stands_for_the_whole_only_by_symmetry(
    half_twists: int, rest: str, said: str
) -> None:
    with pytest.raises(ModelError, match=said):
        check_scene(loads_scene(band("sadowsky", half_twists, rest, "half")))


def test_a_flat_ring_under_pressure_may_be_solved_by_half() -> None:
    rest = "interval: [0, 0.5]\nguess: circle\nstates: planar\nloads: {pressure: 10}"
    solution = solve(loads_scene(band("kirchhoff", 0, rest, "half")))
    assert solution.verified
    # A round ring of radius 1 / 2 pi: n3 = -p R, and no shear force.
    assert solution.n0 == pytest.approx([0, 0, -10 / (2 * np.pi)], abs=1e-10)
