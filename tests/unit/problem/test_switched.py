"""Ribbons in phases: as many conditions as unknowns, whatever follows what."""

from itertools import pairwise, product

import pytest

from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.switched import switched
from ribbonopt.scene import loads_scene

CLAMPED = """
name: clamps
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0.05, 0.8], directors: {turns: [{z: 0.4}]}}
"""
SEQUENCES = [
    kinds
    for count in (1, 2, 3, 4)
    for kinds in product((-1, 0, 1), repeat=count)
    if all(a != b for a, b in pairwise(kinds))
]


@pytest.mark.parametrize("kinds", SEQUENCES, ids=str)
def test_any_sequence_of_phases_is_square(kinds: tuple[int, ...]) -> None:
    ribbon = Ribbon.of(Posed.of(loads_scene(CLAMPED)))
    problem = switched(ribbon, kinds)
    assert problem.square
    assert len(problem.conditions) == problem.unknown_count
