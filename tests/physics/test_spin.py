"""Rods that are the same about all axes: a neutral direction that is named, and no failure."""

from typing import Any

import numpy as np
import pytest

from ribbonopt import loads_scene, solve, summarize
from ribbonopt.accuracy.spin import spins
from ribbonopt.checks.softest import softest
from ribbonopt.checks.stability import SecondVariation, negative_range, second_variation
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation

#: an arch whose clamps are on one axis, turned against one another
ARCH = """
name: arch
law: {{type: rod, B: {B}, natural: {natural}}}
parameters: {{twist: {twist}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: {end}, directors: {{turns: [{{z: twist}}]}}}}
tolerance: 1e-8
"""
FAMILY = "the rod, isotropic, turns about the tangent of its clamp"


def arch(
    B: str = "[1, 1, 0.8]",
    natural: str = "[0, 0, 0]",
    twist: float = 2.0,
    end: str = "[0, 0, 0.7]",
    more: str = "",
) -> Solution:
    text = ARCH.format(B=B, natural=natural, twist=twist, end=end)
    return solve(loads_scene(text + more))


def judged(solution: Solution) -> SecondVariation:
    found = second_variation(solution)
    assert isinstance(found, SecondVariation), found
    return found


def test_an_isotropic_rod_turns_about_its_clamps() -> None:
    found = arch()
    assert found.verified and spins(found)
    assert judged(found).verdict == f"stable; neutral: {FAMILY}"
    assert negative_range(found) == (0, 0)
    soft = softest(found)
    assert not isinstance(soft, str)
    assert abs(soft.eigenvalue) < 1e-6 * judged(found).largest


def test_the_neutral_mode_is_that_turn() -> None:
    """Displacement along e x r, rotation e - d3, e along the axis of the clamps."""
    found = arch()
    soft = softest(found)
    assert not isinstance(soft, str)
    expected = np.cross([0, 0, 1], found.sample(soft.s, "r"))
    size = np.linalg.norm(expected, axis=1).max()
    turn = (np.array([0, 0, 1]) - found.sample(soft.s, "d3")) / size
    sign = np.sign((expected * soft.displacement).sum())
    np.testing.assert_allclose(sign * soft.displacement, expected / size, atol=1e-4)
    np.testing.assert_allclose(sign * soft.rotation, turn, atol=1e-3)


def test_bars_are_those_of_the_member_that_was_found() -> None:
    """Its energy, and what does not depend on the turn, are those of a much finer mesh."""
    found = arch()
    bars = summarize(found)["error_estimate"]
    fine = arch(more="transcription: {type: collocation, intervals: 60}\n")
    assert bars["energy"] is not None and bars["energy"] < 1e-6
    assert abs(found.energy - fine.energy) <= bars["energy"] + 1e-11
    axial = [(one.n0[2], one.m0[2], np.hypot(*one.n0[:2])) for one in (found, fine)]
    assert np.abs(np.subtract(*axial)).max() <= bars["n0"] + bars["m0"] + 1e-9
    assert any(FAMILY in text for text in summarize(found)["warnings"])


@pytest.mark.parametrize(
    "other",
    [
        {"B": "[1, 1.01, 0.8]"},
        {"natural": "[0, 0.1, 0]"},
        {"end": "[0.1, 0, 0.7]"},
        {"twist": 0.0, "more": "states: planar\n"},
    ],
)
def test_what_does_not_spin(other: dict[str, Any]) -> None:
    found = arch(**other)
    assert found.verified and not spins(found)
    assert not any(FAMILY in text for text in summarize(found)["warnings"])
    if other.get("twist") != 0:
        assert judged(found).verdict == "stable"


def test_natural_twist_does_not_hinder_it() -> None:
    """It is a turn of the end: k3 = 2 with the end turned by 2 is a rod without, not turned."""
    found, plain = arch(natural="[0, 0, 2]"), arch(twist=0.0)
    assert spins(found) and spins(plain)
    assert found.energy == pytest.approx(plain.energy, abs=1e-7)


def test_a_straight_rod_that_turns_about_itself_is_no_family() -> None:
    text = ARCH.format(B="[1, 1, 0.8]", natural="[0, 0, 0]", twist=3, end="[0, 0, 1]")
    sliding = "{support: sliding, along: [0, 0, 1], position: [0, 0, 1]"
    found = solve(loads_scene(text.replace("{support: clamped, position: [0, 0, 1]", sliding)))
    assert found.verified and not spins(found)
    assert judged(found).verdict == "stable"


def test_a_family_is_followed() -> None:
    """Its determinant is zero all along, so that no branch points are told from it."""
    text = ARCH.format(B="[1, 1, 0.8]", natural="[0, 0, 0]", twist=2, end="[0, 0, 0.7]")
    more = "continuation: {parameter: parameters.twist, from: 2, to: 6, largest: 2, first: 2}\n"
    points = list(Continuation(loads_scene(text + more)))
    assert points[-1].position == 6
    assert {point.kind for point in points} == {"point"}
    assert {point.row["negative"] for point in points} == {0}
    assert not any("not resolved" in point.row["note"] for point in points)
    # dW/dtwist is the axial moment, which is conserved.
    wanted = solve(loads_scene(text.replace("twist: 2}", "twist: 5.99}"))).energy
    energy, moment = points[-1].row["energy"], points[-1].row["m0z"]
    assert (energy - wanted) / 0.01 == pytest.approx(moment, abs=0.02)


@pytest.mark.parametrize("twist", [0.0, 1.0, 3.0])
def test_a_family_under_a_load_is_found_from_nothing(twist: float) -> None:
    """A dead load along the axis leaves the turn free, one across it does not."""
    found = arch(twist=twist, more="loads: {force: {z: -5}}\n")
    assert found.verified and spins(found)
    s = np.linspace(0, 1, 9)
    kept = found.sample(s, "H - 5 * dot(r, ez)")
    np.testing.assert_allclose(kept, kept[0], rtol=0, atol=1e-8)
    assert judged(found).spins and negative_range(found) == (judged(found).negative,) * 2
    across = arch(twist=twist, more="loads: {force: {x: -5}}\n")
    assert across.verified and not spins(across)
