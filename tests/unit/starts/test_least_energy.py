"""The first solve of the automatic start: on few elements, on more where those lead nowhere.

Truth: a solve from loads that are given, which knows nothing of the automatic start.
"""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.guess.placing import place_ends
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import (
    Boundary,
    Collocation,
    End,
    Ipopt,
    LoadGuess,
    RotationVector,
    Scene,
    Variational,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.starts import automatic, energy
from ribbonopt.starts.automatic import Automatic

CLAMPED = Boundary(
    start=End("clamped", (0, 0, 0), directors="identity"),
    end=End("clamped", (0.2, 0.1, 0.6), directors=RotationVector((0.3, 0.9, 0.4))),
)
SCENE = Scene("clamps", Variational(delta=0.0095), CLAMPED, transcription=Collocation())


@pytest.fixture(scope="module")
def truth() -> Solution:
    """From the loads of the solution, to two digits."""
    found = solve(SCENE)
    n, m = (tuple(float(f"{v:.2g}") for v in found.at_nodes[name][0]) for name in ("n", "m"))
    return solve(replace(SCENE, guess=LoadGuess(n, m)))


def test_more_elements_where_few_lead_nowhere(
    truth: Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(energy, "QUICK_SOLVER", Ipopt(tolerance=1e-6, max_iterations=2))
    found = solve(SCENE)
    assert truth.verified and found.verified
    assert found.energy == pytest.approx(truth.energy, rel=1e-9)
    words = [step["step"] for step in found.steps if "least energy" in step["step"]]
    assert len(words) == 2 and "(max_iterations)" in words[0] and "more elements" in words[1]


def test_more_elements_where_a_minimum_on_few_is_near_no_equilibrium(
    truth: Solution, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole, calls = automatic.follow, []

    def lost_at_first(*parts: object) -> object:
        calls.append(parts)
        found = whole(*parts)  # type: ignore[arg-type]
        return replace(found, points=(), complete=False) if len(calls) == 1 else found

    monkeypatch.setattr(automatic, "follow", lost_at_first)
    found = solve(SCENE)
    assert found.energy == pytest.approx(truth.energy, rel=1e-9)
    words = [step["step"] for step in found.steps if "least energy" in step["step"]]
    assert len(words) == 2 and "more elements" in words[1]


def test_no_step_ends_just_short_of_the_last_delta() -> None:
    """From 0.0108 to 0.0095 would be one in vain."""
    posed = Posed.of(SCENE)
    law = Variational(delta=automatic.FIRST)
    points = Automatic(posed)._points(posed, next(automatic.shapes_for(posed)), law, Ledger(), [])
    deltas = [point.scene.law.delta for point in points]
    assert deltas[0] == automatic.FIRST and deltas[-1] == pytest.approx(0.0095)
    assert all(after < 0.8 * before for before, after in pairwise(deltas))


def test_ends_are_found_by_the_mechanics_of_any_scene_of_the_structure() -> None:
    """Functions are of the structure, numbers of the scene."""
    other = replace(CLAMPED, end=replace(CLAMPED.end, position=(0.0, -0.3, 0.6)))
    posed = Posed.of(replace(SCENE, boundary=other))
    (_, (end, frame)) = place_ends(Ribbon.of(Posed.of(SCENE)), posed)
    np.testing.assert_allclose(end, [0.0, -0.3, 0.6], atol=1e-12)
    (_, (_, own)) = place_ends(Ribbon.of(posed), posed)
    np.testing.assert_allclose(frame, own, atol=1e-12)
