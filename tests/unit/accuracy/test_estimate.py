"""Bars of phases and of records, against much finer solutions."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import SAFETY, Analysis, analyse, estimate_error
from ribbonopt.accuracy.gaps import _shifted
from ribbonopt.accuracy.recorded import recorded_errors
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import loads_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
JUMPS = (
    "clamped_twist",
    "law={type: sadowsky}",
    "boundary.end={support: clamped, position: [0.3, 0.06, 0.9], "
    "directors: {turns: [{y: -0.6}, {z: 0.5}]}}",
)


@pytest.mark.parametrize("intervals", [6, 16])
def test_in_phases_the_estimate_is_the_error_at_the_same_arclength(
    solved: Solved, intervals: int
) -> None:
    """Phases of two solutions are not as long: positions move by more than shapes differ."""
    mesh = f"transcription={{type: collocation, degree: 3, intervals: {intervals}}}"
    exact, found = solved(*JUMPS, "tolerance=1e-10"), solved(*JUMPS, "tolerance=1e-6", mesh)
    assert len(found.switch_points) == len(exact.switch_points) == 2
    # Strains jump at the switches, which are known to an error of their own.
    away = np.abs(found.nodes[:, None] - found.switch_points).min(axis=1) > 1e-9
    ours, true = (each.outputs(found.nodes[away]) for each in (found, exact))
    gaps = {name: float(np.abs(ours[name] - true[name]).max()) for name in ("r", "d1", "d2", "d3")}
    off = {"states": max(gaps.values()), "u": float(np.abs(ours["u"] - true["u"]).max())}
    bars = estimate_error(found)
    for name, error in off.items():
        assert error > 1e-10
        assert bars[name] == pytest.approx(SAFETY * error, rel=0.1), name


@pytest.mark.parametrize(
    "law", ["{type: kirchhoff, B2: 1, B3: 2}", "{type: variational, delta: 0.3}"]
)
def test_under_loads_bars_are_known_and_tight(law: str) -> None:
    """H changes along a ribbon that bears its own weight, and is no witness of its errors."""
    text = f"""
name: heavy
law: {law}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [0.1, 0.05, 0.8], directors: identity}}
loads: {{force: [5, 2, 0]}}
"""
    mesh = "transcription={{type: collocation, degree: {}, intervals: {}}}"
    found, exact = (
        solve(loads_scene(text, overrides=[mesh.format(*size)])) for size in ((3, 8), (8, 20))
    )
    assert float(np.ptp(exact.at_nodes["H"])) > 0.1
    bars = estimate_error(found)
    for name, off in (("n0", found.n0 - exact.n0), ("m0", found.m0 - exact.m0)):
        error = float(np.abs(off).max())
        assert 1e-9 < error <= bars[name] < 20 * error


def test_what_schemes_overlook_is_in_the_bars_of_records_too(solved: Solved) -> None:
    """What a scene records is as uncertain as the loads that it is computed from."""
    mesh = "transcription={type: collocation, degree: 3, intervals: 5}"
    found = solved("moebius_half", mesh, "record={load: 'norm(m) at 0'}")
    whole = analyse(found)
    overlooked = {name: 2.5 * error for name, error in whole.errors.items()}
    worse = replace(whole, more=2.5 * whole.more, errors=overlooked)
    bars = []
    for analysis in (whole, worse):
        found.trajectory.found[Analysis] = analysis
        bars.append((recorded_errors(found)["load"], estimate_error(found)["n0"]))
    found.trajectory.found[Analysis] = whole
    assert bars[0][0] > 0
    for more, less in zip(bars[1], bars[0], strict=True):
        assert more == pytest.approx(2.5 * less)


def test_what_is_compared_elsewhere_is_what_is_there(solved: Solved) -> None:
    """Phases of two solutions are not as long: to first order that changes nothing."""
    found = solved("moebius_regularized", "law={type: sadowsky}").trajectory
    nodes = found.nodes
    for by in (1e-4, -1e-4, 1e-5, -1e-5):
        # Ends stay, and so does where phases meet, beside which strains jump.
        moved = nodes + by * np.sin(np.pi * nodes) * (np.abs(nodes - found.ends[1]) > 0.1)
        there = found.outputs(moved)
        expected = np.hstack([there[name] for name in ("r", "d1", "d2", "d3")])
        off = np.abs(_shifted(found, moved)[:, :12] - expected).max()
        assert 0 < off < 100 * by**2
        strains = np.abs(_shifted(found, moved)[:, 12:] - found.at_nodes["u"]).max()
        assert 0 < strains < 100 * abs(by)


@pytest.mark.parametrize("law", ["kirchhoff", "kirchhoff, B2: 1, B3: 1.3"])
def test_an_exact_answer_has_bars_of_rounding(each_way: None, law: str) -> None:
    """A straight column under its load: defects are none at all, and no measure of anything."""
    column = f"""
name: column
law: {{type: {law}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: {{x: 0, y: 0, z: -2}}}}
states: reduced
tolerance: 1e-9
"""
    found = solve(loads_scene(column))
    assert found.verified, found.message
    bars = estimate_error(found)
    assert np.abs(found.n0 - [0, 0, -2]).max() <= bars["n0"] < 1e-11
    assert np.abs(found.m0).max() <= bars["m0"] < 1e-11
    assert all(0 < bar < 1e-11 for bar in bars.values())
