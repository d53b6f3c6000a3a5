"""Stretch of the centre line: what is known in closed form, and planar elasticas shot again."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ribbonopt import continue_scene, loads_scene, solve
from ribbonopt.checks.conserved import conserved
from ribbonopt.checks.stability import negative_directions
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.scene import Membrane, Scene

EA = 500.0
PULLED = """name: pulled
law: {{type: {law}}}
membrane: {{stretching: 500}}
boundary:
  start: {{position: [0, 0, 0], directors: identity}}
  end: {end}
tolerance: 1e-9
"""


@pytest.mark.parametrize("law", ["kirchhoff", "sadowsky", "variational"])
def test_a_straight_pull(law: str) -> None:
    """N = 20: the length is 1 + N / EA; and the same by its length."""
    dead = "{force: [0, 0, 20], moment: [0, 0, 0]}"
    found = solve(loads_scene(PULLED.format(law=law, end=dead)))
    assert found.verified
    np.testing.assert_allclose(found.sample(1.0, "r"), (0, 0, 1 + 20 / EA), atol=1e-13)
    assert found.energy == pytest.approx(20**2 / (2 * EA), abs=1e-12)
    assert found.sample(0.3, "H") == pytest.approx(20 + 20**2 / (2 * EA), abs=1e-11)
    held = solve(loads_scene(PULLED.format(law=law, end=held_at(1.03))))
    assert held.verified and held.sample(0.5, "extension") == pytest.approx(0.03, abs=1e-13)
    np.testing.assert_allclose(held.n0, (0, 0, 0.03 * EA), atol=1e-10)


def held_at(z: float) -> str:
    return f"{{position: [0, 0, {z}], directors: identity}}"


def test_held_further_apart_than_it_stretches() -> None:
    scene = loads_scene(PULLED.format(law="kirchhoff", end=held_at(1.3)))
    with pytest.raises(ConvergenceError, match=r"1 long \(interval\), which may stretch by 10%"):
        solve(scene)
    with pytest.raises(ConvergenceError, match=r"1\.03 apart .* 1 long \(interval\); bring"):
        solve(loads_scene(PULLED.format(law="kirchhoff", end=held_at(1.03))
                          .replace("stretching: 500", "bending: 500")))
    text = PULLED.format(law="kirchhoff", end=held_at(0.9))
    text += "continuation: {parameter: boundary.end.position.z, to: 1.3}\n"
    with pytest.raises(ModelError, match=r"1\.3 .* may stretch by 10%; .* = 1\.1$"):
        continue_scene(loads_scene(text))


COLUMN = """name: column
law: {{type: kirchhoff, B2: 1, B3: 2}}
membrane: {{stretching: {EA}}}
parameters: {{P: 9.5}}
boundary:
  start: {{support: hinged, position: [0, 0, 0], axis: d2, along: [0, 1, 0]}}
  end: {{position: {{x: 0}}, force: {{y: 0, z: -P}}, d2: {{x: 0}}, moment: {{x: 0, y: 0}}}}
guess: {{force: [0, 0, -9.5], moment: [0, 0, 0]}}
tolerance: 1e-9
record: {{shortening: "1 - dot(r, ez)", deflection: "dot(r, ex) at 0.5"}}
continuation: {{parameter: parameters.P, from: 9.5, to: 11.5, switch: true}}
"""


@pytest.mark.parametrize("stiffness", [100.0, 500.0, 1e5])
def test_a_column_that_shortens_before_it_buckles(stiffness: float) -> None:
    """P (1 - P / EA) = pi^2: the linearised equation B y'' + P (1 - P / EA) y = 0."""
    branch = continue_scene(loads_scene(COLUMN.format(EA=stiffness)))
    (point,) = branch.special
    critical = stiffness / 2 * (1 - np.sqrt(1 - 4 * np.pi**2 / stiffness))
    assert point.value == pytest.approx(critical, abs=1e-8)
    counts = [negative_directions(one.solution) for one in branch.points]
    assert counts[0] == 0 and max(counts) == 1
