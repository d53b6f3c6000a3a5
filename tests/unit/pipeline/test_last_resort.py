"""What comes after a guess from which Newton's method leads nowhere, and in which order.

Truth: 28-digit numbers of the half Moebius ribbon.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references import HALF_MOEBIUS

from ribbonopt.arrays import Array
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import ShapeGuess
from ribbonopt.guess.shapes import Helical
from ribbonopt.pipeline import nothing
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport, Status
from ribbonopt.solvers.newton import NewtonSolver

FAR = ShapeGuess(Helical(np.zeros(3), np.eye(3), np.array([0.0, 50.0, 30.0]), 0.5))
AUTOMATIC = ("least energy", "twisted circle")  # with which the automatic start begins


@pytest.fixture(scope="module")
def half() -> Prepared:
    return prepare(load_scene(Path(__file__).parents[3] / "configs" / "moebius_half.yaml"))


@pytest.fixture
def no_newton(monkeypatch: pytest.MonkeyPatch) -> None:
    """Newton's method stalls wherever it begins."""
    whole = NewtonSolver.solve

    def stalled(self: NewtonSolver, w: Array, p: Array, *rest: Any, **more: Any) -> SolveReport:
        report = whole(self, w, p, *rest, **more)
        return replace(report, status=Status.STALLED, w=np.array(w))

    monkeypatch.setattr(NewtonSolver, "solve", stalled)


def steps(solution: Solution) -> list[str]:
    return [step["step"] for step in solution.steps]


def found_band(solution: Solution) -> bool:
    truth = np.concatenate([HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]])
    gap = np.abs(np.append(solution.n0, solution.m0)) - np.abs(truth)
    return solution.verified and bool(np.abs(gap).max() < 1e-6)


def test_the_automatic_start_comes_before_ipopt_from_the_guess(half: Prepared) -> None:
    found = half.solve(guess=FAR)
    assert found_band(found) and "automatic start" in found.given_up[0]
    assert any(step.startswith(AUTOMATIC) for step in steps(found))
    assert not any(step.startswith("ipopt") for step in steps(found))


@pytest.mark.usefixtures("no_newton")
def test_ipopt_from_the_guess_is_the_last_resort(half: Prepared) -> None:
    """Its answer is from the guess, which was not given up; what came before is told."""
    found = half.solve()
    assert found_band(found) and not found.given_up
    assert any("IPOPT did" in words for words in found.fell_back)
    least = [i for i, step in enumerate(steps(found)) if step.startswith(AUTOMATIC)]
    own = [i for i, step in enumerate(steps(found)) if step.startswith("ipopt")]
    assert len(own) == 1 and own[0] > max(least)


@pytest.mark.usefixtures("no_newton")
def test_it_comes_too_where_there_is_nothing_else_to_start_from(
    half: Prepared, monkeypatch: pytest.MonkeyPatch
) -> None:
    def nowhere(*parts: Any) -> None:
        raise ConvergenceError("nothing to start from", "no_start")

    monkeypatch.setattr(nothing, "from_nothing", nowhere)
    assert found_band(half.solve())
    with pytest.raises(ConvergenceError, match="nothing to start from"):
        half.solve(quick=True)


@pytest.mark.usefixtures("no_newton")
def test_without_the_automatic_start_it_comes_at_once(half: Prepared) -> None:
    found = half.solve(fallback=False)
    assert found_band(found) and not found.given_up and not found.fell_back
    assert not any(step.startswith(AUTOMATIC) for step in steps(found))
