"""From ribbon to ribbon: kept factors and continued unknowns change the cost, not the answer."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.accuracy.estimate import analyse, relative_error
from ribbonopt.pipeline.neighbour import Neighbour
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.pipeline.search import Search
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.studies.batch.family import solve_beside

CONFIGS = Path(__file__).parents[3] / "configs"
ARCH = """
name: arch
law: {type: sadowsky}
parameters: {turn: 1.0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0.05, 0.8], directors: {turns: [{z: turn}]}}
tolerance: 1e-6
"""


def half(epsilon: float, *more: str) -> Scene:
    law = f"law={{type: regularized, epsilon: {epsilon}}}"
    return load_scene(CONFIGS / "moebius_half.yaml", [law, "tolerance=1e-9", *more])


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return prepare(half(0.05))


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[tuple[int, int]]]:
    """Count iterations and factorisations of every Newton solve."""
    found: list[tuple[int, int]] = []
    whole = NewtonSolver.solve

    def solve(self: NewtonSolver, *arguments: object, **options: object) -> object:
        report = whole(self, *arguments, **options)  # type: ignore[arg-type]
        found.append((report.iterations, report.factorizations))
        return report

    monkeypatch.setattr(NewtonSolver, "solve", solve)
    yield found


def walk(prepared: Prepared, epsilons: list[float], *more: str) -> list[Neighbour]:
    first = Neighbour(prepared, prepared.solve(half(epsilons[0], *more)))
    found = [first]
    for epsilon in epsilons[1:]:
        beside = found[-1].solve(half(epsilon, *more))
        assert beside is not None
        found.append(beside)
    return found


def test_a_phase_without_length_is_no_neighbour() -> None:
    """From one arch to the next a phase of Sadowsky's ribbon shrinks beyond nothing."""
    built, family, phases = prepare(loads_scene(ARCH)), None, []
    for number, turn in enumerate((1.5, 1.0, 0.2)):
        scene = loads_scene(ARCH, overrides=[f"parameters.turn={turn}"])
        found, _, family = solve_beside(built, scene, number, family)
        assert found.verified
        phases.append(len(found.sheets))
    assert phases[-1] < phases[0]


def test_neighbours_are_the_solutions_of_their_scenes(prepared: Prepared) -> None:
    for beside in walk(prepared, [0.05, 0.048, 0.046, 0.044, 0.042])[1:]:
        epsilon = beside.solution.scene.law.epsilon  # type: ignore[union-attr]
        alone = prepared.solve(half(epsilon, "tolerance=1e-12"))
        assert beside.solution.verified
        assert np.allclose(beside.solution.n0, alone.n0, rtol=1e-9, atol=0)
        assert beside.solution.energy == pytest.approx(alone.energy, rel=1e-9)


def test_factors_are_made_once_for_many(prepared: Prepared, counted: list[tuple[int, int]]) -> None:
    walk(prepared, np.linspace(0.05, 0.045, 12).tolist())
    counted = counted[-11:]
    assert sum(factorizations for _, factorizations in counted) <= 2


def test_continued_unknowns_save_iterations(
    prepared: Prepared, counted: list[tuple[int, int]]
) -> None:
    near = walk(prepared, [0.05, 0.049, 0.048])[-1]
    assert near.before is not None
    for source in (near, replace(near, before=None)):
        assert source.solve(half(0.047)) is not None
    (continued, _), (plain, _) = counted[-2:]
    assert continued < plain


def test_far_neighbours_need_factors_of_their_own(
    prepared: Prepared, counted: list[tuple[int, int]]
) -> None:
    near = walk(prepared, [0.05, 0.049])[-1]
    far = near.solve(half(2.0))
    assert far is not None
    assert counted[-1][1] >= 1
    alone = prepared.solve(half(2.0, "tolerance=1e-12"))
    assert np.allclose(far.solution.n0, alone.n0, rtol=1e-9, atol=1e-12)  # n1 is zero


def test_a_mesh_too_coarse_is_refined(prepared: Prepared) -> None:
    rough = Neighbour(prepared, prepared.solve(half(0.05, "tolerance=1e-4")))
    beside = rough.solve(half(0.049, "tolerance=1e-12"))
    assert beside is not None
    error, _ = relative_error(beside.solution)
    assert error <= 1e-12
    # What was kept belongs to the mesh before.
    assert beside.finer is None
    assert beside.before is None


def test_another_point_of_reference_is_minded(prepared: Prepared) -> None:
    first = Neighbour(prepared, prepared.solve(half(0.05)))
    moved = "boundary.start.position=[1, 0, 0]"
    beside = first.solve(half(0.049, moved))
    assert beside is not None
    assert beside.solution.start["r"].tolist() == pytest.approx([1, 0, 0])
    alone = prepared.solve(half(0.049, "tolerance=1e-12"))
    # The ribbon may start anywhere on the x axis: the same loads.
    assert np.allclose(beside.solution.n0, alone.n0, rtol=1e-8, atol=1e-8)


def test_estimate_by_factors_of_a_neighbour(prepared: Prepared) -> None:
    with_factors = walk(prepared, [0.05, 0.0499, 0.0498, 0.0497], "tolerance=1e-6")[-1].solution
    errors = analyse(with_factors).errors
    with_factors.trajectory.found.clear()
    exact = analyse(with_factors).errors
    for name, error in exact.items():
        assert errors[name] == pytest.approx(error, rel=0.45), name  # q / (1 - q), q = 0.3


def test_factors_that_do_not_fit_are_given_up(prepared: Prepared) -> None:
    newton = NewtonSolver(prepared.nlp)
    w, p = prepared.start()
    good = newton.solve(w, p)

    class Wrong:
        def solve(self, residuals: object) -> np.ndarray:
            return np.full(len(w), np.nan)

    for factors in (Wrong(), newton.solve(w + 0.5, p).factors):
        found = newton.solve(w, p, factors=factors)
        assert found.status.converged
        assert np.allclose(found.w, good.w, rtol=0, atol=1e-9)
    again = newton.solve(good.w + 1e-4, p, factors=good.factors)
    assert again.status.converged
    assert again.factorizations == 0
    assert np.allclose(again.w, good.w, rtol=0, atol=1e-9)


@pytest.mark.parametrize("star", [False, True], ids=["chain", "star"])
def test_a_loop_of_ones_own_keeps_factors_too(
    prepared: Prepared, counted: list[tuple[int, int]], star: bool
) -> None:
    epsilons = np.linspace(0.05, 0.045, 12).tolist()
    guess = first = prepared.solve(half(epsilons[0]))
    begun, found = len(counted), []
    for epsilon in epsilons[1:]:
        found.append(prepared.solve(half(epsilon), guess=first if star else guess))
        guess = found[-1]
    assert len(counted) - begun == len(found)
    assert sum(factorizations for _, factorizations in counted[begun:]) <= 2
    assert all(each.verified and relative_error(each)[0] <= 1e-9 for each in found)
    alone = prepared.solve(half(epsilons[-1], "tolerance=1e-12"))
    np.testing.assert_allclose(found[-1].n0, alone.n0, rtol=1e-9)


def test_a_loop_of_ones_own_says_what_it_did(prepared: Prepared) -> None:
    first = prepared.solve(half(0.05))
    found = prepared.solve(half(0.049), guess=first)
    assert found.steps[0]["step"] == "guess: given"
    assert len(found.steps) == 2 and found.iterations == found.steps[1]["iterations"] > 0
    assert found.timings["total"] >= found.timings["evaluate"] > 0
    assert any("guess is given" in words for words in found.skipped)
    assert not found.given_up


def test_without_a_tolerance_the_mesh_is_the_scenes_own() -> None:
    path = CONFIGS / "moebius_half.yaml"
    law = "law={type: regularized, epsilon: 0.01}"
    fine = load_scene(path, [law, "tolerance=1e-12"])
    built = prepare(fine)
    found = built.solve(fine)
    assert sum(found.mesh.elements) > fine.transcription.intervals
    plain = built.solve(replace(fine, tolerance=None), guess=found)
    assert plain.verified
    assert plain.mesh.elements == (fine.transcription.intervals,)


def test_where_nothing_is_near_the_whole_search_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """Phases of Sadowsky's ribbon that shrink beyond nothing, in a loop of one's own."""
    whole, found = Neighbour.beside, []

    def beside(self: Neighbour, search: Search) -> Neighbour | None:
        found.append(whole(self, search))
        return found[-1]

    monkeypatch.setattr(Neighbour, "beside", beside)
    built, solution = prepare(loads_scene(ARCH)), None
    for turn in (1.5, 1.0, 0.2):
        scene = loads_scene(ARCH, overrides=[f"parameters.turn={turn}"])
        solution = built.solve(scene, guess=solution)
        assert solution.verified and solution.posed.theta["parameters.turn"] == turn
    assert len(found) == 2 and None in found
