"""A planar answer of a scene in space, and a centre line in its own way: said, and only there."""

from collections.abc import Callable

import numpy as np
import pytest

from ribbonopt.checks.approach import nearest_approach
from ribbonopt.checks.validity import warnings_of
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import loads_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]

COIL = """
name: coil
law: {{type: kirchhoff, B2: 1, B3: 1}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: [0, 0, 0], moment: {{d1: 0, d2: {bend}, d3: {twist}}}}}
transcription: {{type: collocation, intervals: 40}}
"""
CANTILEVER = """
name: bent
law: {{type: {law}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: [{x}, {y}, 0]}}
{more}
"""


def planar(found: Solution) -> list[str]:
    return [text for text in warnings_of(found) if "lies in a plane" in text]


def contact(found: Solution) -> list[str]:
    return [text for text in warnings_of(found) if "self-contact" in text]


@pytest.mark.parametrize(
    ("law", "x"), [("sadowsky", 1), ("variational, delta: 0.1", -2), ("kirchhoff, B2: 2, B3: 1", 3)]
)
def test_what_is_planar_and_not_held_there_is_said(law: str, x: float) -> None:
    found = solve(loads_scene(CANTILEVER.format(law=law, x=x, y=0, more="")))
    assert len(planar(found)) == 1
    assert f"\n  warning: {planar(found)[0]}" in report(summarize(found))
    held = solve(loads_scene(CANTILEVER.format(law=law, x=x, y=0, more="states: planar")))
    assert held.energy == pytest.approx(found.energy, rel=1e-6)
    assert planar(held) == []


def test_what_leaves_the_plane_or_is_straight_is_not_planar(solved: Solved) -> None:
    law = "kirchhoff, B2: 1, B3: 1"
    aside = solve(loads_scene(CANTILEVER.format(law=law, x=1, y=0.01, more="")))
    assert planar(aside) == []
    straight = solve(loads_scene(CANTILEVER.format(law=law, x=0, y=0, more="")))
    assert planar(straight) == []
    assert planar(solved("helix_clamped")) == []


def coil(bend: float, twist: float) -> Solution:
    return solve(loads_scene(COIL.format(bend=bend, twist=twist)))


def test_the_pitch_of_a_helix_is_how_near_it_comes_to_itself() -> None:
    """An isotropic rod under an end moment is a helix: u2 = bend, u3 = twist."""
    for turns, twist, warned in ((8, 1.0, True), (8, 12.0, False), (15, 3.0, True)):
        bend = 2 * np.pi * turns
        found = coil(bend, twist)
        total = np.hypot(bend, twist)
        radius, pitch = bend / total**2, 2 * np.pi * twist / total**2
        # Turns next to one another are nearest a little off the straight line across.
        t = np.linspace(0.9, 1.1, 20001) * 2 * np.pi
        chord = np.hypot(2 * radius * np.sin(t / 2), pitch * t / (2 * np.pi)).min()
        points = found.outputs(np.linspace(0, 1, 2001))["r"]
        approach = nearest_approach(points, 1.0, 0.5 / turns, False)
        assert approach is not None
        assert approach.distance == pytest.approx(chord, rel=2e-3)
        far = nearest_approach(points, 1.0, 1.5 / turns, False)
        assert far is not None
        assert far.distance > 1.5 * chord
        assert bool(contact(found)) == (warned or chord < 0.1)


def test_a_ring_wound_twice_meets_itself() -> None:
    (text,) = contact(coil(4 * np.pi, 0.0))
    assert "meets itself" in text
    assert contact(coil(1.6 * np.pi, 0.0)) == []


def test_bands_are_judged_whole(solved: Solved) -> None:
    # Half of it is solved, and the warning counts s along all of it.
    half = solved("moebius_half")
    assert contact(half) == []
    assert solved("ribbon_si").scene.ribbon is not None
    assert contact(solved("ribbon_si")) == []


def test_distances_between_segments() -> None:
    t = np.linspace(0, 1, 400, endpoint=False) * 2 * np.pi
    eight = np.stack([np.sin(t), np.sin(2 * t), 0 * t], axis=1)
    found = nearest_approach(eight, 0.1, 0.2, True)
    assert found is not None
    assert found.distance < 1e-12
    assert sorted(found[1:]) == pytest.approx([0.0, 0.5], abs=3e-3)
    lifted = np.stack([np.sin(t), np.sin(2 * t), 0.02 * np.cos(t)], axis=1)
    found = nearest_approach(lifted, 0.1, 0.2, True)
    assert found is not None
    assert found.distance == pytest.approx(0.04, rel=1e-3)
    assert nearest_approach(lifted, 0.039, 0.2, True) is None
    circle = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    assert nearest_approach(circle, 1.0, 0.2, True) is None
    found = nearest_approach(circle, 2.5, 0.25, True)
    assert found is not None
    assert found.distance == pytest.approx(np.sqrt(2), rel=0.02)
    # Two legs of an open hairpin, 0.05 from one another.
    legs = np.array([[0, 0, 0], [0.25, 0, 0], [0.5, 0, 0], [0.5, 0.05, 0], [0.25, 0.05, 0]])
    found = nearest_approach(legs, 0.1, 0.5, False)
    assert found is not None
    assert found.distance == pytest.approx(0.05)
