"""What acts on a solution adds up to zero, and is what independent codes found."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import casadi as ca
import numpy as np
import pytest

from ribbonopt import loads_scene, solve
from ribbonopt.accuracy.carried import reaction_errors
from ribbonopt.mechanics.loads.load import Load, Theta
from ribbonopt.mechanics.section import Section
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.scene import Collocation, Loads, Scene
from ribbonopt.solution.acting import at_places, forces_along, reactions, resultants
from ribbonopt.solution.solution import Solution

MIDDLE = 12.910335551573857  # of 20, by Taylor series of the elastica with 30 digits

PUSHED = """
name: pushed
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [0, -1, 0]}
loads: {force: {x: -3}, points: [{at: 0.5, force: {d1: 2, d3: -1}}, {at: 0.7, force: [0, 1, 2]}]}
"""

SI = """
name: hung
law: {type: sadowsky}
states: planar
ribbon: {length: 0.3, width: 0.01, thickness: 1e-4, youngs_modulus: 4.5e9, poisson_ratio: 0.38}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free}
loads: {force: {x: -2e-3}, points: [{at: 0.1, force: [-1e-4, 0, 0]}]}
"""


def beam(formulation: str = "inverted", **changes: object) -> Scene:
    states = "reduced" if formulation == "energy" else "planar"
    scene = loads_scene("""
        name: beam
        law: {type: kirchhoff, B2: 1, B3: 2}
        boundary:
          start: {support: pinned, position: [0, 0, 0]}
          end: {position: {x: 0, y: 0}, force: {z: 0}, moment: [0, 0, 0]}
        loads: {force: {x: -20}}
        supports: [{at: 0.4, position: {x: 0}}]
        """)
    return replace(scene, formulation=formulation, states=states, **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize("formulation", ["inverted", "energy"])
def test_supports_carry_the_load(formulation: str) -> None:
    found = solve(beam(formulation))
    start, middle, end = reactions(found)
    assert [start.path, middle.path, end.path] == ["boundary.start", "supports.0", "boundary.end"]
    assert (middle.at, middle.support) == (0.4, True)
    assert middle.force == pytest.approx([MIDDLE, 0, 0], abs=1e-9)
    force, couple = resultants(found)["loads.force"]
    assert force == pytest.approx([-20, 0, 0], rel=1e-13) and not couple.any()
    assert start.force + middle.force + end.force == pytest.approx([20, 0, 0], abs=1e-9)


def test_the_bar_of_a_reaction_covers() -> None:
    coarse = solve(beam(transcription=Collocation(degree=2, intervals=3)))
    off = abs(reactions(coarse)[1].force[0] - MIDDLE)
    assert 1e-7 < off < reaction_errors(coarse)[1] < 1e4 * off


def test_dead_and_following_forces_on_a_ribbon_in_space() -> None:
    found = solve(loads_scene(PUSHED))
    following, dead = at_places(found)
    d1, d3 = (found.sample(0.5, name) for name in ("d1", "d3"))
    assert following.force == pytest.approx(2 * d1 - d3, abs=1e-10)
    assert dead.force == pytest.approx([0, 1, 2])
    start, end = reactions(found)
    assert end.force == pytest.approx([0, -1, 0], abs=1e-10)
    acting = [start.force, following.force, dead.force, end.force, [-3, 0, 0]]
    assert np.sum(acting, axis=0) == pytest.approx([0, 0, 0], abs=1e-10)


def test_forces_along_are_in_the_units_of_the_scene() -> None:
    found = solve(loads_scene(SI))
    forces = forces_along(found, np.array([0.0, 0.12, 0.3]))
    np.testing.assert_allclose(forces["loads.force"], [[-2e-3, 0, 0]] * 3, rtol=1e-12)
    assert reactions(found)[0].force == pytest.approx([7e-4, 0, 0], abs=1e-14)
    (point,) = at_places(found)
    assert (point.at, point.force[0]) == pytest.approx((0.1, -1e-4))
    text = report(summarize(found))
    assert "on the ribbon (N, N m, lab frame)" in text
    assert "loads.force            (-0.0006, 0, 0) in all" in text
    assert "loads.points.0         (-0.0001, 0, 0) at s = 0.1" in text


def test_summary_and_report_say_what_is_carried() -> None:
    summary = summarize(solve(beam()))
    (load,), (start, middle, end) = summary["loads"], summary["reactions"]
    assert (load["path"], load["at"]) == ("loads.force", None)
    assert load["force"] == pytest.approx([-20, 0, 0])
    assert (middle["path"], middle["at"]) == ("supports.0", 0.4)
    assert abs(middle["force"][0] - MIDDLE) < middle["error"] + 5e-13
    assert start["force"] == pytest.approx([-v for v in summary["n0"]])
    assert end["at"] == 1.0
    assert "carried at supports.0  (12.91033555" in report(summary)


def test_nothing_is_said_where_nothing_acts_between(solved: Callable[..., Solution]) -> None:
    summary = summarize(solved("clamped_arch"))
    assert summary["loads"] == []
    start, end = summary["reactions"]
    np.testing.assert_allclose(start["force"], [-v for v in end["force"]], atol=1e-12)
    assert "on the ribbon (" not in report(summary)
    # A piece of a loop has no ends.
    assert summarize(solved("band_three"))["reactions"] == []


@dataclass(frozen=True)
class Stirred(Load):
    """A couple per length about y, on ribbons in the plane of x and z."""

    c: float
    name = "stirred"

    def numbers(self) -> dict[str, float]:
        return {"stirred.c": self.c}

    def force(self, section: Section, theta: Theta) -> ca.SX:
        return ca.SX.zeros(3)

    def couple(self, section: Section, theta: Theta) -> ca.SX:
        return ca.vertcat(0, theta("stirred.c"), 0)

    def symmetries(self, motions: np.ndarray) -> np.ndarray:
        return np.eye(motions.shape[1])  # those of the plane


def test_a_couple_along_the_ribbon_is_what_the_clamp_holds() -> None:
    # Numbers of a load declared in Python are in units Dw = L = 1.
    scene = replace(loads_scene(SI), loads=Loads(own=(Stirred(0.7),)))
    found = solve(scene)
    force, couple = resultants(found)["stirred"]
    assert not force.any()
    unit = 4.5e9 * 1e-4**3 / (12 * (1 - 0.38**2)) * 0.01 / 0.3
    assert couple == pytest.approx([0, 0.7 * unit, 0], rel=1e-12)
    assert found.m0 == pytest.approx(couple, rel=1e-10, abs=1e-15)
