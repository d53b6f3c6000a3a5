"""Refinement that leads nowhere keeps the best that it has met."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from ribbonopt.pipeline import refinement
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

Solved = Callable[..., Solution]


@pytest.mark.parametrize(("errors", "best"), [((1e-3, 5e-3), 0), ((1e-3, 5e-4), 1)])
def test_of_two_meshes_the_better_one_answers(
    solved: Solved, monkeypatch: pytest.MonkeyPatch, errors: tuple[float, float], best: int
) -> None:
    """No third mesh converges; which of the first two is told is the one with the least error."""
    found = [replace(solved("moebius_half"), iterations=i) for i in (0, 1)]
    left = iter([True, False])
    attempt: Any = SimpleNamespace(run=lambda *_, **__: next(left), best=found[1], iterations=1)
    monkeypatch.setattr(refinement, "relative_error", lambda s: (errors[s.iterations], "n0"))
    monkeypatch.setattr(refinement, "verified", lambda solution, _: solution)
    ribbon: Any = None
    answer = refinement.refine(found[0], 1e-6, ribbon, lambda *_: attempt)
    assert answer.iterations == best
    assert answer.status is Status.TOLERANCE_MISSED
    assert f"{errors[best]:.1e}" in answer.message
