"""Second variation of the energy: buckling loads in closed form, meshes, and brute force."""

from collections.abc import Callable
from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from dense_variation import dense_count, eigenvalues

from ribbonopt.checks import variation
from ribbonopt.checks.elimination import factored
from ribbonopt.checks.softest import softest
from ribbonopt.checks.stability import (
    negative_directions,
    second_variation,
    variation_of,
    why_not,
)
from ribbonopt.guess import initial_unknowns
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Ribbon
from ribbonopt.problem.energy import minimum
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.scene.frames import AnyVector
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.studies.buckling.buckling import buckling_loads
from ribbonopt.transcription import CollocationMethod, Mesh

Solved = Callable[..., Solution]
SMOOTH = "law={type: variational, delta: 0.1}"
ROD = "law={type: kirchhoff, B2: 1, B3: 2}"
CLAMPED = ("{support: clamped, position: [0, 0, 0], directors: identity}", "d1: {y: 0}, d3: {x: 0}")
HINGED = ("{position: [0, 0, 0], d2: [0, 1, 0], moment: {d2: 0}}", "d2: {x: 0}")


def column(ends: tuple[str, str], load: float, law: str = "kirchhoff") -> Scene:
    """Return a straight column whose end slides on its axis under a dead load.

    It is free to move along d2 and to turn about d1: a ribbon resists both by its shape alone.
    """
    start, end = ends
    moment = "{x: 0}" if ends is CLAMPED else "{x: 0, y: 0}"
    return loads_scene(
        f"""
        name: column
        law: {{type: {law}}}
        boundary:
          start: {start}
          end: {{position: {{x: 0}}, {end}, force: {{y: 0, z: {-load}}}, moment: {moment}}}
        guess: {{force: [0, 0, {-load}], moment: [0, 0, 0]}}
        transcription: {{type: collocation, degree: 4, intervals: 12}}
        """
    )


@pytest.fixture(scope="module")
def elastica(solved: Solved) -> Callable[..., Solution]:
    """Clamped elastica by end shortening and force at the start of Newton's method."""

    def solution(shortening: float, force: float, law: str = ROD, *more: str) -> Solution:
        moment = 6.5 if force < 60 else 8 if force < 120 else 12
        across = 0 if force < 60 else force / 15
        guess = f"guess={{force: [{across}, 0, {-force}], moment: [0, {moment}, 0]}}"
        return solved("elastica_clamped", law, guess, f"parameters.shortening={shortening}", *more)

    return solution


#: buckling loads of the first modes: (2 k pi)^2 and, in between, tan(x) = x with x = sqrt(P) / 2
CLAMPED_LOADS = (4 * np.pi**2, 4 * 4.493409457909064**2, 16 * np.pi**2)
HINGED_LOADS = (np.pi**2, 4 * np.pi**2, 9 * np.pi**2)


@pytest.mark.parametrize(
    ("ends", "loads"), [(CLAMPED, CLAMPED_LOADS), (HINGED, HINGED_LOADS)], ids=["clamped", "hinged"]
)
def test_columns_lose_their_stability_at_the_buckling_loads(
    ends: tuple[str, str], loads: tuple[float, ...]
) -> None:
    prepared = prepare(column(ends, 1))
    for below, load in enumerate(loads):
        for factor, expected in ((1 - 1e-5, below), (1 + 1e-5, below + 1)):
            found = prepared.solve(column(ends, factor * load))
            assert found.verified and np.abs(found.at_nodes["r"][:, 0]).max() < 1e-9
            assert negative_directions(found) == expected, (load, factor)


def test_straight_ribbons_have_no_second_variation() -> None:
    """The law has no derivative at m2 = m3 = 0; bending alone, they buckle as rods do."""
    scene = replace(column(CLAMPED, 30, "variational"), parameters={"P": 30.0})
    end = replace(scene.boundary.end, force=AnyVector(y=0, z="-P"))
    scene = replace(scene, boundary=replace(scene.boundary, end=end))
    found = solve(scene)
    assert negative_directions(found) is None
    assert "m2 = m3 = 0" in why_not(found)
    loads = [one.value for one in buckling_loads(scene, "parameters.P", 30, 170)]
    np.testing.assert_allclose(loads, CLAMPED_LOADS, rtol=1e-9)


@pytest.mark.parametrize("law", [ROD, SMOOTH])
def test_only_the_first_mode_of_the_elastica_is_stable(
    elastica: Callable[..., Solution], law: str
) -> None:
    for shortening in (0.1, 0.5):
        assert negative_directions(elastica(shortening, 45, law)) == 0
    assert negative_directions(elastica(0.1, 90, law)) == 1
    assert negative_directions(elastica(0.1, 150, law)) == 2


def test_an_elastica_that_twists_easily_leaves_its_plane(
    elastica: Callable[..., Solution],
) -> None:
    soft = "law={type: kirchhoff, B2: 1, B3: 0.05}"
    assert negative_directions(elastica(0.5, 45, soft)) == 0
    assert negative_directions(elastica(0.7, 45, soft)) == 1


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("clamped_loop", SMOOTH),
        ("moebius_half", SMOOTH),
        ("moebius_whole", SMOOTH),
        ("elastica_clamped", "law={type: kirchhoff, B2: 1, B3: 0.05}"),
    ],
)
def test_the_mesh_does_not_matter(solved: Solved, name: str, law: str) -> None:
    changes = [law] + ["parameters.shortening=0.7"] * (name == "elastica_clamped")
    meshes = ((4, 24), (4, 40), (6, 20), (8, 14))
    found = [
        solved(
            name,
            *changes,
            "tolerance=null",
            f"transcription={{type: collocation, degree: {degree}, intervals: {intervals}}}",
        )
        for degree, intervals in meshes
    ]
    expected = int(name == "elastica_clamped")
    first = eigenvalues(found[0])
    # Isolated ones: beyond them is a continuous spectrum, one value for each place of the ribbon.
    isolated = 1 if name == "clamped_loop" else 2
    for each in found:
        assert negative_directions(each) == expected
        values = eigenvalues(each)
        # The eigenvalues themselves are those of the continuous problem.
        np.testing.assert_allclose(values[:isolated], first[:isolated], atol=2e-3)
        judged, lowest = second_variation(each), softest(each)
        assert not isinstance(judged, str) and not isinstance(lowest, str)
        assert 0.4 < judged.largest / np.abs(values).max() < 1.01
        np.testing.assert_allclose(lowest.eigenvalue, values[0], atol=1e-9)


def test_other_schemes_and_states_agree(solved: Solved) -> None:
    """What is judged is the shape, whichever equations led to it."""
    reduced = eigenvalues(solved("moebius_half", SMOOTH))
    others = (
        ("states=full",),
        ("transcription={type: shooting, scheme: rk8, intervals: 20}",),
        ("transcription={type: collocation, scheme: radau, degree: 5, intervals: 16}",),
        ("formulation=energy", "transcription.intervals=16"),
        ("formulation=algebraic",),
    )
    for changes in others:
        found = solved("moebius_half", SMOOTH, *changes)
        assert negative_directions(found) == 0
        np.testing.assert_allclose(eigenvalues(found)[0], reduced[0], rtol=1e-3)


def test_a_loop_that_slides_along_itself_is_not_unstable(solved: Solved) -> None:
    found = solved("moebius_whole", SMOOTH)
    values = eigenvalues(found)
    assert abs(values[0]) < 1e-5 < 0.1 < values[1]
    assert negative_directions(found) == 0


def inertia(solution: Solution, degree: int, intervals: int) -> int:
    """Negative eigenvalues of the whole KKT matrix, less the number of constraints."""
    posed = solution.posed.under(formulation="energy")
    ribbon = Ribbon.of(posed)
    problem = minimum(ribbon)
    nlp = CollocationMethod.named("gauss", degree).transcribe(problem, (intervals,))
    p = np.concatenate([posed.values, Mesh.uniform(intervals).widths])
    w = initial_unknowns(solution, ribbon, problem, nlp.blocks, p)
    at, of = ca.MX.sym("w", len(w)), ca.MX.sym("p", len(p))
    slope = ca.Function("slope", [at, of], [ca.gradient(nlp.functions.cost(at, of), at)])(w, p)
    A = np.array(nlp.functions.jacobian(w, p)[1])
    multipliers = np.linalg.lstsq(A.T, -np.array(slope).ravel(), rcond=None)[0]
    upper = np.array(nlp.functions.hessian(w, p, 1.0, multipliers))
    H = upper + np.triu(upper, 1).T
    K = np.block([[H, A.T], [A, np.zeros((len(A), len(A)))]])
    return int((np.linalg.eigvalsh(K) < 0).sum()) - len(A)


@pytest.mark.parametrize(
    ("force", "shortening", "B3", "expected"),
    [(45, 0.25, 2, 0), (90, 0.1, 2, 1), (150, 0.1, 0.3, 3), (45, 0.7, 0.05, 1)],
)
def test_brute_force_agrees(
    elastica: Callable[..., Solution], force: float, shortening: float, B3: float, expected: int
) -> None:
    found = elastica(shortening, force, f"law={{type: kirchhoff, B2: 1, B3: {B3}}}")
    assert negative_directions(found) == inertia(found, 3, 12) == expected


@pytest.mark.parametrize("law", [ROD, SMOOTH, "law={type: sadowsky}"])
@pytest.mark.parametrize(
    "name", ["clamped_loop", "clamped_twist", "elastica_clamped", "heavy_cantilever", "band_three"]
)
def test_dense_matrices_agree(solved: Solved, name: str, law: str) -> None:
    """At every shift up to the largest eigenvalue, so that all orders of elimination occur."""
    found = variation_of(solved(name, law))
    assert not isinstance(found, str)
    for part in (-0.3, -0.1, -0.01, 1e-6, 0.03):
        shift = part * found.largest
        assert factored(found.form, shift).negative == dense_count(found.form, shift)


def test_clamped_ribbons_found_by_least_energy_are_stable(solved: Solved) -> None:
    names = ("arch", "loop", "quarter", "twist")
    assert [negative_directions(solved(f"clamped_{name}", SMOOTH)) for name in names] == [0] * 4


def test_units_do_not_matter(solved: Solved) -> None:
    si, plain = (eigenvalues(solved(name, SMOOTH)) for name in ("ribbon_si", "moebius_half"))
    np.testing.assert_allclose(si, plain, rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "change", "reason"),
    [
        ("moebius_regularized", "starts=1", "the law regularized has no energy"),
        ("end_moment", ROD, "boundary.end.moment.y, other than zero, has no potential"),
        ("elastica_pinned", ROD, "the energy is not stationary"),
    ],
)
def test_why_there_is_none(solved: Solved, name: str, change: str, reason: str) -> None:
    found = solved(name, change)
    assert negative_directions(found) is None
    assert reason in why_not(found)
    assert ";" not in why_not(found)


def test_what_did_not_converge_is_not_judged(solved: Solved) -> None:
    lost = replace(solved("cantilever", ROD), status=Status.MAX_ITERATIONS)
    assert negative_directions(lost) is None
    assert why_not(lost) == "this is no equilibrium"
    assert why_not(solved("cantilever", ROD)) == ""
    assert negative_directions(solved("cantilever", ROD)) == 0


def test_structures_are_built_once(monkeypatch: pytest.MonkeyPatch) -> None:
    built = []
    genuine = variation.minimum
    monkeypatch.setattr(variation, "minimum", lambda r: built.append(r) or genuine(r))
    prepared = prepare(column(HINGED, 11.0))
    for load in (11.0, 12.0, 13.0):
        found = prepared.solve(column(HINGED, load))
        assert negative_directions(found) == 1
        assert negative_directions(found) == 1
    assert len(built) == 1
