"""Stretch of the centre line: what is known in closed form, and planar elasticas shot again."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from ribbonopt import Continuation, loads_scene, solve
from ribbonopt.checks.conserved import conserved
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, POINT, Point

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


@pytest.mark.parametrize("law", ["kirchhoff", "variational"])
def test_held_longer_than_it_is(law: str) -> None:
    """Clamps straighten it, and B1 must be finite for them to bear no force across it."""
    text = PULLED.format(law=law, end=held_at(1.03))
    held = solve(loads_scene(text.replace("500}", "500, bending: 100}")))
    assert held.verified and held.sample(0.5, "extension") == pytest.approx(0.03, abs=1e-13)
    np.testing.assert_allclose(held.n0, (0, 0, 0.03 * EA), atol=1e-10)
    with pytest.raises(ConvergenceError, match="held straight: it cannot bend in its own plane"):
        solve(loads_scene(text))


def test_one_that_cannot_stretch_and_is_straight_bears_any_force_along_it() -> None:
    text = PULLED.format(law="variational", end=held_at(1.0)).replace("stretching", "bending")
    with pytest.raises(ConvergenceError, match="it cannot stretch, so that the force along it is"):
        solve(loads_scene(text))


def held_at(z: float) -> str:
    return f"{{position: [0, 0, {z}], directors: identity}}"


def test_held_further_apart_than_it_stretches() -> None:
    scene = loads_scene(PULLED.format(law="kirchhoff", end=held_at(1.3)))
    with pytest.raises(ConvergenceError, match=r"1 long \(interval\), which may stretch by 10%"):
        solve(scene)
    with pytest.raises(ConvergenceError, match=r"1\.03 apart .* 1 long \(interval\); bring"):
        solve(
            loads_scene(
                PULLED.format(law="kirchhoff", end=held_at(1.03)).replace(
                    "stretching: 500", "bending: 500"
                )
            )
        )
    text = PULLED.format(law="kirchhoff", end=held_at(0.9))
    text += "continuation: {parameter: boundary.end.position.z, to: 1.3}\n"
    with pytest.raises(ModelError, match=r"1\.3 .* may stretch by 10%; .* = 1\.1$"):
        Continuation(loads_scene(text))


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


@cache
def walked(scene: str) -> tuple[Point, ...]:
    found = tuple(Continuation(loads_scene(scene)))
    assert all(point.solution.verified for point in found)
    return found


@pytest.mark.parametrize("stiffness", [100.0, 500.0, 1e5])
def test_a_column_that_shortens_before_it_buckles(stiffness: float) -> None:
    """P (1 - P / EA) = pi^2, from the linearised equation B y'' + P (1 - P / EA) y = 0."""
    points = walked(COLUMN.format(EA=stiffness))
    (found,) = (point for point in points if point.kind == BRANCH_POINT)
    critical = stiffness / 2 * (1 - np.sqrt(1 - 4 * np.pi**2 / stiffness))
    assert value_of(found.row) == pytest.approx(critical, abs=1e-8)
    straight = [point for point in points if point.branch == 0 and point.kind == POINT]
    for point in straight:
        assert point.row["negative"] == (value_of(point.row) > critical)
        shortening = value_of(point.row) / stiffness
        assert point.row["shortening"] == pytest.approx(shortening, abs=1e-11)


def shot(P: float, stiffness: float) -> tuple[float, float]:
    """Shortening and deflection of the buckled column: x, z, angle and its rate, shot from 0."""

    def rates(s: float, y: np.ndarray) -> list[float]:
        _, _, angle, bent = y
        axial = -P * np.cos(angle)
        stretch = 1 + axial / stiffness
        return [
            stretch * np.sin(angle),
            stretch * np.cos(angle),
            bent,
            -stretch * P * np.sin(angle),
        ]

    def at(s: float, angle: float) -> np.ndarray:
        run = solve_ivp(rates, (0, s), [0, 0, angle, 0], "DOP853", rtol=1e-12, atol=1e-13)
        return run.y[:, -1]

    angle = brentq(lambda a: at(1.0, a)[3], 0.3, 2.0, xtol=1e-13)
    return 1 - at(1.0, angle)[1], at(0.5, angle)[0]


def test_the_buckled_column_by_shooting() -> None:
    points = walked(COLUMN.format(EA=500.0))
    last = {point.branch: point for point in points if point.kind == POINT and point.branch}
    assert len(last) == 2
    for point in last.values():
        assert value_of(point.row) == 11.5 and point.row["negative"] == 0
        shortening, deflection = shot(11.5, 500.0)
        assert point.row["shortening"] == pytest.approx(shortening, abs=1e-9)
        assert abs(point.row["deflection"]) == pytest.approx(deflection, abs=1e-9)


RING = """name: ring
law: {{type: kirchhoff}}
states: planar
membrane: {{stretching: {EA}}}
interval: [0, 3.141592653589793]
boundary:
  start: {{position: [0, 0, 0], directors: {{d1: [0, 0, 1], d3: [1, 0, 0]}}}}
  end: {{position: {{x: 0}}, directors: {{d1: [0, 0, -1], d3: [-1, 0, 0]}}, force: {{z: 0}}}}
loads: {{pressure: 2.8}}
tolerance: 1e-9
record: {{across: "dot(r, ez) at 3.141592653589793"}}
continuation: {{parameter: loads.pressure, to: 3.4, switch: true}}
"""


@pytest.mark.parametrize("stiffness", [50.0, 500.0])
def test_a_ring_under_pressure(stiffness: float) -> None:
    """Pressure acts on the stretched length: round, 1 + e = 1 / (1 + p / EA), k = B = 1.

    Linearised about that, strains vary as cos(2 s) where 3 = p / EA + p (1 + e)^2.
    """
    points = walked(RING.format(EA=stiffness))
    (found,) = (point for point in points if point.kind == BRANCH_POINT)

    def mode(p: float) -> float:
        return p / stiffness + p / (1 + p / stiffness) ** 2 - 3

    assert value_of(found.row) == pytest.approx(brentq(mode, 2.0, 3.5, xtol=1e-14), abs=1e-8)
    for point in points:
        if point.branch == 0 and point.kind == POINT:
            across = 2 / (1 + value_of(point.row) / stiffness)
            assert point.row["across"] == pytest.approx(across, abs=1e-10)
            assert point.row["negative"] == (value_of(point.row) > value_of(found.row))
    last = points[-1].solution
    known = conserved(last, uniform=True)
    assert {"H", "n^2/2 - p m2"} <= set(known)
    assert all(one.drift < 1e-8 for one in known.values())


def test_as_one_over_the_stiffness() -> None:
    """Buckled under the same load, from the rigid column: elliptic integrals."""
    k = brentq(lambda k: 4 * ellipk(k**2) ** 2 - 11.5, 0.1, 0.9)
    rigid = 2 - 2 * ellipe(k**2) / ellipk(k**2), k / ellipk(k**2)
    gaps = [np.array(shot(11.5, EA)) - rigid for EA in (1e4, 1e5)]
    np.testing.assert_allclose(gaps[0], 10 * gaps[1], rtol=0.05)
    points = walked(COLUMN.format(EA=1e5))
    for point in points:
        if point.kind == POINT and point.branch and value_of(point.row) == 11.5:
            gap = np.array([point.row["shortening"], abs(point.row["deflection"])]) - rigid
            np.testing.assert_allclose(gap, gaps[1], rtol=1e-3)
