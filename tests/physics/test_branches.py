"""Branch points, folds and stability: columns that buckle, a strip that snaps.

Truth: Euler's loads, elliptic integrals, and the planar elastica by shooting.
"""

from collections.abc import Iterator
from itertools import groupby
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve
from scipy.special import ellipe, ellipk

from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.points import (
    BRANCH_POINT,
    BUCKLING,
    FOLD,
    POINT,
    Point,
)

Array = np.ndarray
DEGREE = np.pi / 180
SADOWSKY = "law={type: sadowsky}"


class Run:
    """All points of a scene's continuation, by branch."""

    def __init__(self, path: Path, *overrides: str) -> None:
        self.continuation = Continuation(load_scene(path, overrides))
        self.all = list(self.continuation)
        assert all(point.solution.verified for point in self.all)
        self.branches = {
            branch: list(points) for branch, points in groupby(self.all, lambda p: p.branch)
        }

    def rows(self, branch: int = 0) -> list[dict]:
        return [point.row for point in self.branches[branch] if point.kind == POINT]

    def special(self, kind: str, branch: int = 0) -> list[Point]:
        return [point for point in self.branches[branch] if point.kind == kind]


def changes(points: list[Point]) -> Iterator[tuple[int, int]]:
    """Yield by how much `negative` changes, and the special points, from point to point."""
    before, special = points[0].row["negative"], 0
    for point in points[1:]:
        if point.kind == POINT:
            yield point.row["negative"] - before, special
            before, special = point.row["negative"], 0
        else:
            special += 1


def assert_stability_agrees(run: Run) -> None:
    """Check that one direction turns over at every fold and branch point, and only there."""
    for points in run.branches.values():
        assert points[0].kind == POINT
        for change, special in changes(points):
            assert abs(change) <= special
            assert (change - special) % 2 == 0


# Columns: by hand P = (2 waves K)^2 in half waves, with k = sin of the largest angle over 2.

EULER = {"column_clamped": 4 * np.pi**2, "column_pinned": np.pi**2}
each_column = pytest.mark.parametrize("name", EULER)


@pytest.fixture(scope="module")
def columns(configs: Path) -> dict[str, Run]:
    return {name: Run(configs / f"{name}.yaml") for name in EULER}


@each_column
def test_columns_have_their_branch_point_at_euler_s_load(
    columns: dict[str, Run], name: str
) -> None:
    run, load = columns[name], EULER[name]
    (found,) = run.special(BRANCH_POINT)
    assert value_of(found.row) == pytest.approx(load, rel=1e-8)
    assert not run.special(FOLD)
    for row in run.rows():
        assert abs(row["deflection"]) < 1e-10
        assert row["negative"] == (0 if value_of(row) < load else 1)
    assert run.continuation.ending.reached
    assert_stability_agrees(run)


@each_column
def test_columns_buckle_both_ways_and_are_stable_then(columns: dict[str, Run], name: str) -> None:
    run = columns[name]
    assert sorted(run.branches) == [0, 1, 2]
    one, other = run.rows(1), run.rows(2)
    assert len(one) == len(other) >= 3
    for a, b in zip(one, other, strict=True):
        assert value_of(a) == pytest.approx(value_of(b), rel=1e-9)
        assert a["deflection"] == pytest.approx(-b["deflection"], rel=1e-7)
        for key in ("shortening", "energy"):
            assert a[key] == pytest.approx(b[key], rel=1e-7)
    assert {row["negative"] for row in one + other} == {0}
    assert value_of(one[0]) < 1.02 * EULER[name]


@each_column
def test_buckled_columns_are_elasticas(columns: dict[str, Run], name: str) -> None:
    for row in columns[name].rows(1):
        # sqrt(P) = 2 K for one half wave, 4 K for the clamped column's two
        K = np.sqrt(value_of(row) / EULER[name]) * np.pi / 2
        m = brentq(lambda m, K=K: ellipk(m) - K, 0, 0.9, xtol=1e-15)
        assert abs(row["deflection"]) == pytest.approx(np.sqrt(m) / K, rel=1e-7)
        assert row["shortening"] == pytest.approx(2 - 2 * ellipe(m) / K, rel=1e-7)
        assert row["energy"] == pytest.approx(2 * value_of(row) * (ellipe(m) / K - 1 + m), rel=1e-7)


@pytest.mark.slow
def test_columns_buckle_again_and_again(configs: Path) -> None:
    # Clamped, in its plane: (2 k pi)^2 and between them tan(x) = x with x = sqrt(P) / 2.
    stage = "{parameter: parameters.P, from: 30, to: 100, largest: 5, switch: true}"
    run = Run(configs / "column_clamped.yaml", f"continuation={stage}")
    loads = [value_of(point.row) for point in run.special(BRANCH_POINT)]
    np.testing.assert_allclose(loads, [4 * np.pi**2, 4 * 4.493409457909064**2], rtol=1e-8)
    assert sorted(run.branches) == [0, 1, 2, 3, 4]
    assert_stability_agrees(run)
    for one, other in ((1, 2), (3, 4)):
        for kind in (FOLD, BRANCH_POINT):
            a, b = ([value_of(p.row) for p in run.special(kind, i)] for i in (one, other))
            np.testing.assert_allclose(a, b, rtol=1e-8)
    assert run.special(BRANCH_POINT, 1) and run.special(FOLD, 3)


@each_column
def test_a_straight_ribbon_of_sadowsky_has_no_branch_points_and_buckles_as_a_rod(
    columns: dict[str, Run], configs: Path, name: str
) -> None:
    run, rod = Run(configs / f"{name}.yaml", SADOWSKY), columns[name]
    assert run.special(BRANCH_POINT) == []
    (point,) = run.special(BUCKLING)
    assert value_of(point.row) == pytest.approx(EULER[name], rel=1e-9)
    for row in run.rows(1):
        K = np.sqrt(value_of(row) / EULER[name]) * np.pi / 2
        m = brentq(lambda m, K=K: ellipk(m) - K, 0, 0.9, xtol=1e-15)
        assert abs(row["deflection"]) == pytest.approx(np.sqrt(m) / K, rel=1e-7)
    assert sorted(run.branches) == sorted(rod.branches)


# The strip that snaps.


@pytest.fixture(scope="module")
def snap(configs: Path) -> Run:
    return Run(configs / "snap.yaml")


def shot(nx: float, nz: float, moment: float) -> tuple[Array, Array]:
    """Return x, z and the angle of a planar elastica at its end, and their Jacobian."""

    def rates(_: float, y: Array) -> Array:
        x, z, angle = y[:3]
        J = np.array([[0, 0, np.cos(angle)], [0, 0, -np.sin(angle)], [nz, -nx, 0]])
        by_loads = np.array([[0, 0, 0], [0, 0, 0], [-z, x, 1]])
        bend = moment + nz * x - nx * z
        along = [np.sin(angle), np.cos(angle), bend]
        return np.concatenate([along, (J @ y[3:].reshape(3, 3) + by_loads).ravel()])

    y = solve_ivp(rates, (0, 1), np.zeros(12), method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    return y[:3], y[3:].reshape(3, 3)


def test_fold_is_that_of_the_planar_elastica(snap: Run) -> None:
    def singular(unknowns: Array) -> list[float]:
        end, J = shot(*unknowns[:3])
        return [end[0], end[1] - 0.9, end[2] - unknowns[3], float(np.linalg.det(J))]

    (fold,) = snap.special(FOLD)
    row = fold.row
    truth = fsolve(singular, [4.6, -60, 4.9, 32 * DEGREE], xtol=1e-13)
    assert value_of(row) * DEGREE == pytest.approx(truth[3], rel=1e-8)
    np.testing.assert_allclose([row["n0x"], row["n0z"], row["m0y"]], truth[:3], rtol=1e-6)


def test_snapping_strip_loses_its_stability_at_the_fold(snap: Run) -> None:
    points = snap.branches[0]
    at = next(i for i, point in enumerate(points) if point.kind == FOLD)
    assert {point.row["negative"] for point in points[:at]} == {0}
    assert {point.row["negative"] for point in points[at + 1 :]} == {1}
    assert_stability_agrees(snap)
    angles = [value_of(point.row) for point in points]
    assert max(angles) == angles[at]
    assert (np.diff(angles[: at + 1]) > 0).all() and (np.diff(angles[at:]) < 0).all()


def test_fold_is_the_same_from_both_directions(configs: Path, snap: Run) -> None:
    (fold,) = snap.special(FOLD)
    unstable = [row for row in snap.rows() if row["negative"] == 1]
    begin = min(unstable, key=lambda row: abs(value_of(row) - 20))
    angle = value_of(begin)
    back = Run(
        configs / "snap.yaml",
        f"guess={{force: [{begin['n0x']}, 0, {begin['n0z']}], moment: [0, {begin['m0y']}, 0]}}",
        f"continuation={{parameter: parameters.angle, from: {angle}, to: 40, largest: 4}}",
    )
    (again,) = back.special(FOLD)
    assert value_of(again.row) == pytest.approx(value_of(fold.row), rel=1e-8)
    np.testing.assert_allclose(again.solution.n0, fold.solution.n0, rtol=1e-6, atol=1e-6)
    rows = back.rows()
    assert (rows[0]["negative"], rows[-1]["negative"]) == (1, 0)
    assert rows[0]["middle"] < fold.row["middle"] < rows[-1]["middle"]
    assert_stability_agrees(back)


def test_two_equilibria_below_the_fold_and_none_above(configs: Path, snap: Run) -> None:
    (fold,) = snap.special(FOLD)
    at = snap.branches[0].index(fold)
    prepared = prepare(load_scene(configs / "snap.yaml"))

    def beside(gap: float, guess: Point) -> float | None:
        angle = value_of(fold.row) + gap
        scene = load_scene(configs / "snap.yaml", [f"parameters.angle={angle!r}"])
        found = prepared.solve(scene, guess=guess.solution, fallback=False)
        return float(found.sample(0.5, "dot(r, ex)")) if found.verified else None

    middle = fold.row["middle"]
    stable, unstable = (beside(-1e-4, snap.branches[0][i]) for i in (at - 1, at + 1))
    assert stable is not None and unstable is not None
    # Apart by the square root of the distance, on both sides of the fold.
    assert stable - middle == pytest.approx(middle - unstable, rel=0.05)
    assert stable - middle > 1e-5
    assert all(beside(1e-4, snap.branches[0][i]) is None for i in (at - 1, at, at + 1))


def test_goal_beyond_a_fold_is_not_reached_and_the_branch_is_kept(configs: Path) -> None:
    run = Run(configs / "snap.yaml", "continuation.stop=[]")
    ending = run.continuation.ending
    assert not ending.reached
    assert "fold" in ending.reason and "32.363354" in ending.reason
    assert value_of(run.rows()[-1]) < 0


def test_parameter_that_no_condition_uses_is_refused(configs: Path) -> None:
    stage = "continuation={parameter: parameters.unused, from: 1, to: 2}"
    scene = load_scene(configs / "snap.yaml", ["parameters={angle: 0, unused: 1}", stage])
    with pytest.raises(ModelError, match="changes nothing"):
        next(iter(Continuation(scene)))


def test_stiffness_changes_nothing_where_only_positions_are_given(configs: Path) -> None:
    stage = "continuation={parameter: ribbon.youngs_modulus, from: 4.5e9, to: 9e9}"
    scene = load_scene(configs / "ribbon_si.yaml", [stage])
    with pytest.raises(ModelError, match="changes nothing"):
        next(iter(Continuation(scene)))
