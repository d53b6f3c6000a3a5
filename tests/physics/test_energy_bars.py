"""Bars of the energy formulation hold against the inverted form, whose equations are others.

There strains are controls of a minimum, here those of the law at the moment; no bar is shared.
Clamps C and S of the science notes: with Sadowsky's law strains jump along S, with Wunderlich's
they fade there, so that the order of convergence is low.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_natural_references import C, S, clamp

from ribbonopt import solve
from ribbonopt.accuracy.estimate import estimate_error, relative_error
from ribbonopt.cli import main
from ribbonopt.errors import ModelError
from ribbonopt.pipeline.neighbour import Neighbour
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import (
    Boundary,
    Collocation,
    End,
    Law,
    Natural,
    Scene,
    Variational,
    Wunderlich,
    load_scene,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from energy_bars import shares
from starts_clamps import clamps

CONFIGS = Path(__file__).parents[2] / "configs"
SMOOTH, WIDE = Variational(delta=0.01), Wunderlich(width=0.05)
#: random clamps of which both forms find the same equilibrium from nothing
SAME = (*range(7), 8, *range(10, 20), 21, 22)
MESH = Collocation(scheme="gauss", degree=6, intervals=20)


def pulled() -> Scene:
    """A clamped ribbon with a dead force at its end, oblique to it, which bends and twists it."""
    end = End(support="free", force=(1.0, 2.0, -0.5))
    return replace(clamp(C, None, SMOOTH), boundary=Boundary(clamp(C, None).boundary.start, end))


def half_moebius(law: Law) -> Scene:
    name = "wunderlich_moebius" if law.type == "wunderlich" else "moebius_variational"
    return replace(load_scene(CONFIGS / f"{name}.yaml"), law=law, continuation=None)


CASES = {
    "C variational": (clamp(C, None, SMOOTH), 1e-6),
    "C sadowsky": (clamp(C, None), 1e-6),
    "C wunderlich": (clamp(C, None, WIDE), 1e-5),
    "S sadowsky": (clamp(S, None), 1e-3),
    "S wunderlich": (clamp(S, None, Wunderlich(width=0.1)), 1e-2),
    "natural": (clamp(C, Natural(1.5, 0.0, 0.0, 0.3), SMOOTH), 1e-6),
    "dead force": (pulled(), 1e-6),
    "half Moebius": (half_moebius(SMOOTH), 1e-6),
    "wide half Moebius": (half_moebius(Wunderlich(width=0.1)), 1e-3),
}


def by_both(scene: Scene, tolerance: float) -> tuple[Solution, Solution]:
    scene = replace(scene, states="reduced", transcription=MESH)
    theirs = solve(replace(scene, tolerance=1e-10))
    ours = solve(replace(scene, formulation="energy", tolerance=tolerance))
    assert theirs.verified, theirs.message
    assert ours.verified, ours.message
    return ours, theirs


@pytest.mark.parametrize("case", CASES)
def test_bars_hold_and_the_tolerance_is_met(case: str) -> None:
    scene, tolerance = CASES[case]
    ours, theirs = by_both(scene, tolerance)
    found = shares(ours, theirs)
    assert max(found.values()) <= 1, found
    assert relative_error(ours)[0] <= tolerance
    loads = max(np.abs(theirs.n0).max(), np.abs(theirs.m0).max())
    assert np.abs(ours.n0 - theirs.n0).max() <= tolerance * loads
    assert np.abs(ours.u0 - theirs.u0).max() <= tolerance * np.abs(theirs.at_nodes["u"]).max()
    assert ours.energy == pytest.approx(theirs.energy, rel=tolerance)


@pytest.mark.parametrize(
    "seed",
    [pytest.param(s, marks=pytest.mark.slow if s in SAME[:3] else pytest.mark.sweep) for s in SAME],
)
def test_random_wide_clamps_by_both_forms(seed: int) -> None:
    ours, theirs = by_both(replace(clamps(seed), law=WIDE), 1e-2)
    assert max(shares(ours, theirs).values()) <= 1


def test_bars_shrink_with_the_tolerance() -> None:
    scene = replace(clamp(C, None, WIDE), transcription=MESH)
    found = {}
    for tolerance in (1e-3, 1e-5):
        bars = estimate_error(solve(replace(scene, formulation="energy", tolerance=tolerance)))
        found[tolerance] = bars
    assert found[1e-5]["u0"] < found[1e-3]["u0"] / 10
    assert found[1e-5]["n0"] < found[1e-3]["n0"] / 10


def test_a_ribbon_near_by_needs_no_finer_mesh() -> None:
    scene = replace(clamp(C, None, SMOOTH), formulation="energy", tolerance=1e-6)
    prepared = prepare(replace(scene, transcription=MESH))
    first = prepared.solve()
    near = Neighbour(prepared, first).solve(replace(prepared.scene, law=Variational(delta=0.011)))
    assert near is not None
    assert near.solution.coarser is not None
    assert near.solution.mesh.elements == first.mesh.elements


def test_on_one_mesh_there_are_no_bars_and_it_says_why() -> None:
    found = solve(replace(clamp(C, None, SMOOTH), formulation="energy", tolerance=None))
    assert found.verified and found.coarser is None
    with pytest.raises(ModelError, match=r"one mesh only.*give the scene a tolerance"):
        estimate_error(found)


def test_what_the_solver_leaves_of_a_jump_is_told() -> None:
    scene = replace(clamp(S, None), formulation="energy", tolerance=1e-9, transcription=MESH)
    found = solve(scene)
    assert found.status is Status.ROUNDED
    assert "asked was 1.0e-09" in found.message


def test_report_and_summary_show_the_bars(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "result"
    sets = ["--set", "formulation=energy", "--set", "tolerance=1e-6", "--out", str(out)]
    assert main(["solve", str(CONFIGS / "moebius_variational.yaml"), *sets]) == 0
    assert "+- not known" not in capsys.readouterr().out
    summary = json.loads((out / "summary.json").read_text())
    bars = summary["error_estimate"]
    assert all(bar is not None and 0 < bar for bar in bars.values()), bars
    # H is 57.415096 by another program, n(0) and m(0) lie across the axis of symmetry
    assert abs(summary["H0"] - 57.415096) <= 1e-6 + bars["H0"]
    assert abs(summary["n0"][0]) <= bars["n0"]
