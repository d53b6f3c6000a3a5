"""What a search has cost, where it resists, and how far it goes."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.resistance import where_it_resists
from ribbonopt.checks.verify import TOLERANCE
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport, Status
from ribbonopt.solvers.auto import AutoSolver

Solved = Callable[..., Solution]
EMPTY = np.empty(0)
FIRST = SolveReport(Status.STALLED, EMPTY, EMPTY, EMPTY, 7, 3, 1.0, 2.0, 4.0, "newton")
SECOND = replace(FIRST, status=Status.CONVERGED, iterations=11, total=8.0, solver="ipopt")


def test_parts_of_the_time_add_up_to_all_of_it() -> None:
    ledger = Ledger()
    ledger.enter(replace(SECOND, earlier=(FIRST,)), "10 intervals")
    spent = ledger.timings(build=0.5, seconds=20.0)
    assert (spent["evaluate"], spent["linear"], spent["build"]) == (2.0, 4.0, 0.5)
    assert sum(v for name, v in spent.items() if name != "total") == spent["total"] == 20.5


def test_what_failed_first_is_paid_for_too() -> None:
    """IPOPT takes over where Newton's method stalls; both are steps on the way."""
    nlp: Any = SimpleNamespace(square=True)
    solver = AutoSolver(nlp)
    parts = {"newton": FIRST, "ipopt": SECOND}
    for name, report in parts.items():
        one = SimpleNamespace(solve=lambda *_, report=report, **__: report)
        vars(solver)[name] = one
    report = solver.solve(EMPTY, EMPTY)
    assert [tried.solver for tried in report.tried] == ["newton", "ipopt"]
    ledger = Ledger()
    ledger.enter(report, "10 intervals")
    assert ledger.iterations == 18
    assert [step["seconds"] for step in ledger.steps] == [4.0, 8.0]
    assert ledger.steps[0]["step"] == "newton, 10 intervals (stalled)"


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e3])
def test_where_equations_have_no_number_they_resist_most(solved: Solved, value: float) -> None:
    found = solved("moebius_half")
    layout = found.dense.blocks.layout
    residuals = np.full(layout.equations, 1e-3)
    residuals[2 * layout.element_equations + 1] = value
    told = where_it_resists(residuals, layout, found)
    a, b = found.nodes[2:4]
    assert told.startswith(f"What resists most is the ribbon between s = {a:.4g} and s = {b:.4g}")
    residuals[:] = 1e-3
    residuals[-1] = value
    name = list(found.problem.conditions)[-1]
    assert f"is the condition {name}" in where_it_resists(residuals, layout, found)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-6, 1e-12])
def test_the_last_step_shows_neither_in_the_answer_nor_in_its_conditions(
    configs: Path, tolerance: float
) -> None:
    scene = load_scene(configs / "moebius_half.yaml", [f"tolerance={tolerance}"])
    enough = prepare(scene).search().plain.enough
    assert 0 < enough <= tolerance / 50
    assert enough <= TOLERANCE / 50
