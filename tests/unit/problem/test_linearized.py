"""Conditions on the least states: of the problem where they are the same, else rewritten."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.problem import Posed, formulate
from ribbonopt.problem.wellposed.linearized import Linearized, linearize
from ribbonopt.scene import load_scene

CONFIGS = Path(__file__).parents[3] / "configs"


def both(name: str, **changes: str) -> tuple[Linearized, Linearized]:
    """Return the conditions rewritten, and with the problem at hand."""
    posed = Posed.of(replace(load_scene(CONFIGS / f"{name}.yaml"), **changes))
    ribbon, problem = formulate(posed)
    return linearize(ribbon, posed), linearize(ribbon, posed, problem)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("moebius_half", {}),
        ("moebius_half", {"formulation": "algebraic"}),
        ("moebius_half", {"formulation": "differentiated"}),
        ("moebius_half_full", {}),
        ("heavy_cantilever", {}),
        ("hanging_strip", {}),
        ("three_supports", {}),
        ("ring_pressed", {}),
        ("wunderlich_moebius", {}),
        ("elastica_clamped", {"states": "planar"}),
        ("moebius_variational", {"formulation": "energy"}),
    ],
)
def test_the_conditions_of_the_problem_are_those_of_the_ribbon(
    name: str, changes: dict[str, str]
) -> None:
    rewritten, taken = both(name, **changes)
    assert taken.names == rewritten.names
    z = rewritten.generic(0.3)
    for one, other in zip(taken.at(z), rewritten.at(z), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-14, atol=1e-14)
