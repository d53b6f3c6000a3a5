"""A ring under outer pressure: it buckles at p R^3 = 3 and is pressed flat until it touches."""

from pathlib import Path

import numpy as np
import pytest

from ribbonopt import Continuation, solve
from ribbonopt.checks.stability import SecondVariation, second_variation
from ribbonopt.checks.validity import warnings_of
from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.studies.continuation.recorded import value_of

# Quarter of it from its sharp end; in what is printed L = 1 is the length of the ring.

RING = """
name: ring
law: {{type: kirchhoff}}
states: {states}
interval: [0, 1.5707963267948966]
boundary:
  start: {{position: {{y: 0, z: 0}}, directors: {{d1: [-1, 0, 0], d3: [0, 0, 1]}}, force: {{x: 0}}}}
  end: {{position: {{x: 0}}, directors: {{d1: [0, 0, -1], d3: [-1, 0, 0]}}, force: {{z: 0}}}}
loads: {{pressure: 2.8}}
tolerance: 1e-11
record: {{long: "dot(r, ex) at 0"}}
continuation: {{parameter: loads.pressure, to: {p}, switch: true}}
"""
PRESSED = {
    3.2: ((0.195539899228, 0.109338613551), (11.7751802244, 1.3447998081), -155.2118839684),
    5: ((0.218300474065, 0.006996327050), (23.6380729447, -5.8837152254), -270.7473959323),
}
H = {3.2: -85.884449310, 5: 8.631850337}


@pytest.mark.slow
@pytest.mark.parametrize("p", PRESSED)
def test_a_ring_is_pressed_flat(p: float) -> None:
    points = list(Continuation(loads_scene(RING.format(p=p, states="planar"))))
    (buckled,) = [one.row for one in points if one.row["kind"] == "branch point"]
    assert value_of(buckled) == pytest.approx(3, abs=1e-8)
    found = next(one for one in reversed(points) if one.row["long"] > 1.05).solution
    assert value_of(points[-1].row) == p
    axes, moments, force = PRESSED[p]
    o, length = found.outputs(np.array([0, np.pi / 2])), 2 * np.pi
    np.testing.assert_allclose([o["r"][0, 0], o["r"][1, 2]], length * np.array(axes), atol=1e-10)
    np.testing.assert_allclose(o["m2"], np.array(moments) / length, atol=1e-10)
    np.testing.assert_allclose(o["n3"][0], force / length**2, atol=1e-10)
    np.testing.assert_allclose(o["H"], H[p] / length**2, atol=1e-10)
    assert found.verification.drift["n^2/2 - p m2"] < 1e-12
    assert found.verification.drift["H"] < 1e-12


@pytest.mark.slow
def test_opposite_sides_touch(configs: Path) -> None:
    points = list(Continuation(load_scene(configs / "ring_pressed.yaml")))
    last = [one for one in points if min(one.row["gap"], one.row["long"]) < 0]
    assert len(last) == 2  # one on each side of the pitchfork
    for one in last:
        near = sorted(
            (other for other in points if other.row["branch"] == one.row["branch"]),
            key=lambda other: abs(value_of(other.row) - value_of(one.row)),
        )
        other = near[1].row
        name = "gap" if one.row["gap"] < 0 else "long"
        slope = (one.row[name] - other[name]) / (value_of(one.row) - value_of(other))
        touch = value_of(one.row) - one.row[name] / slope
        assert touch == pytest.approx(5.2468869625, abs=3e-10)
        assert any("self-contact is not modelled" in w for w in warnings_of(one.solution))


@pytest.mark.parametrize(("p", "count"), [(2.999, 0), (3.001, 1), (7.99, 1), (8.01, 2)])
def test_modes_of_half_a_ring_lose_stability(configs: Path, p: float, count: int) -> None:
    # Of k waves around the ring at p R^3 = k^2 - 1: two at 3, three at 8.
    text = (configs / "ring_pressed.yaml").read_text(encoding="utf-8")
    found = second_variation(solve(loads_scene(text.replace("pressure: 2.5", f"pressure: {p}"))))
    assert isinstance(found, SecondVariation)
    assert found.negative == count
    unstable = f"unstable in its plane, {count} direction"
    assert found.verdict.startswith(unstable if count else "stable in its plane")


def test_a_pressure_that_varies_has_no_potential_in_the_plane_either(configs: Path) -> None:
    text = (configs / "ring_pressed.yaml").read_text(encoding="utf-8").partition("continuation:")[0]
    found = solve(loads_scene(text.replace("pressure: 2.5", 'pressure: "0.5*sin(s)"')))
    assert found.verified
    assert second_variation(found) == "loads.pressure follows the ribbon"
