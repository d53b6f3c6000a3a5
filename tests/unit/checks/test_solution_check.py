"""What verification asks of a solution, whatever its mesh and whatever vanishes on it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.checks.verify import _moment_error as moment_error
from ribbonopt.checks.verify import verify
from ribbonopt.mechanics.rotations import turns_about
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory

Array = np.ndarray
Solved = Callable[..., Solution]
COARSE = "transcription={type: collocation, degree: 3, intervals: 4}"


def test_a_coarse_mesh_excuses_no_end_that_is_not_met(configs: Path) -> None:
    prepared = prepare(load_scene(configs / "moebius_half.yaml", [COARSE]))
    found = prepared.solve()
    assert found.verified and verify(found, prepared.ribbon).residual_between_nodes > 1e-3
    # The same numbers for an end that is elsewhere.
    names, p = list(found.problem.parameter_names), found.dense.p.copy()
    moved = next(name for name in names if name.startswith("boundary.end.position"))
    p[names.index(moved)] += 1e-6
    elsewhere = replace(found, trajectory=Trajectory(found.problem, replace(found.dense, p=p)))
    (problem,) = verify(elsewhere, prepared.ribbon).problems
    assert problem.startswith(f"{moved} is off by")


def test_what_is_zero_by_symmetry_does_not_drift() -> None:
    """In a plane n . m is zero but for rounding, which must not be judged by its own size."""
    turn = turns_about(np.array([[0.4, -0.9, 0.3]]))[0]
    axes = ", ".join(f"d{i + 1}: {turn[:, i].tolist()}" for i in range(3))
    ends = [f"{{position: {(z * turn[:, 2]).tolist()}, directors: {{{axes}}}}}" for z in (0, 0.75)]
    boundary = "boundary: {{start: {}, end: {}}}\n".format(*ends)
    found = solve(loads_scene("name: plane\nlaw: {type: kirchhoff, B2: 1, B3: 2}\n" + boundary))
    assert found.verified
    assert 0 < np.abs(found.at_nodes["n_dot_m"]).max() < 1e-8
    assert found.verification.drift["n_dot_m"] < 1e-9


@pytest.mark.parametrize("intervals", [3, 5, 8])
def test_moments_in_phases_are_as_exact_as_their_bar(solved: Solved, intervals: int) -> None:
    """Signs of m2 are judged by it: one that is too small refuses phases that are right."""
    law, mesh = "law={type: sadowsky}", "{{type: collocation, degree: 3, intervals: {}}}"
    exact = solved("moebius_regularized", law)
    found = solved("moebius_regularized", law, f"transcription={mesh.format(intervals)}")
    assert len(found.sheets) == len(exact.sheets) == 2
    there = exact.outputs(found.nodes)["m"]
    off = float(np.abs(found.at_nodes["m"] - there).max())
    assert 1e-9 < off < moment_error(found) < 100 * off


def test_what_is_measured_once_is_judged_again(
    configs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Phases are judged again when the error is known; all else is as it was."""
    law = ["law={type: sadowsky}", "tolerance=1e-8"]
    prepared = prepare(load_scene(configs / "moebius_regularized.yaml", law))
    found = prepared.solve()
    assert found.verified and len(found.sheets) == 2
    # Of what is another question the answer is another: sheets, or what was asked.
    turned = verify(replace(found, sheets=found.sheets[::-1]), prepared.ribbon)
    assert len(turned.problems) >= 2
    posed = replace(found.posed, scene=replace(found.posed.scene))
    output = type(found.dense)
    monkeypatch.delattr(output, "residual_between_nodes")
    again = verify(found, prepared.ribbon)
    assert not again.problems
    kept = found.verification
    assert (again.worst_condition, again.law_residual) == (kept.worst_condition, kept.law_residual)
    assert again.residual_between_nodes == kept.residual_between_nodes
    with pytest.raises(AttributeError, match="residual_between_nodes"):
        verify(replace(found, posed=posed), prepared.ribbon)
