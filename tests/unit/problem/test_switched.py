"""Ribbons in phases: as many conditions as unknowns, whatever follows what."""

from dataclasses import replace
from itertools import pairwise, product
from typing import Any

import casadi as ca
import numpy as np
import pytest

from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw
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


def test_what_holds_at_a_switch_is_asked_where_the_switch_is() -> None:
    """A law may depend on the arclength: the one of a switch is that of all phases before it."""
    ribbon = Ribbon.of(Posed.of(loads_scene(CLAMPED)))
    s = ribbon.position

    class Placed(SadowskyLaw):
        def entering(self, kinds: Any, i: int, stress: Any) -> dict[str, ca.SX]:
            return {"arclength": s}

    problem = switched(replace(ribbon, law=Placed(), _kept={}), (1, -1, 1, -1))
    asked = [problem.conditions[f"switch {i}: arclength"] for i in (1, 2, 3)]
    numbers = [problem.constants, problem.parameters]
    places = ca.Function("places", numbers, [ca.vertcat(*asked)])
    constants = np.zeros(problem.constants.numel())
    at = [i for i, name in enumerate(problem.constant_names) if name.startswith("length")]
    constants[at] = 0.1, 0.25, 0.5
    theta = np.zeros(len(problem.parameter_names))
    theta[problem.parameter_names.index("interval.start")] = 2.0
    found = np.array(places(constants, theta)).ravel()
    np.testing.assert_allclose(found, [2.1, 2.35, 2.85], atol=1e-15)
