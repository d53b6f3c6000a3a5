"""Loci of folds: two positions, a test function, and the walk that follows them through a cusp.

Truth: u'' + l1 exp(u / (1 + l2 u)) = 0, u(0) = u(1) = 0 has one solution for each largest value a;
its l1(a) by quadrature, whose folds meet in a cusp at l2 = 0.2457... (Frank-Kamenetskii's slab).
"""

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np
import pytest
from analytic import bvp
from dense_curves import Straight
from scipy.optimize import brentq

from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers import NewtonSolver
from ribbonopt.solvers.extended import Line
from ribbonopt.solvers.locus import LocusFactors, LocusSystem, fold_test
from ribbonopt.studies.continuation.walk.metric import Metric
from ribbonopt.studies.continuation.walk.points import FOLD, POINT, Point, Special
from ribbonopt.studies.continuation.walk.protocol import Trial
from ribbonopt.studies.continuation.walk.special import special_points
from ribbonopt.studies.continuation.walk.walk import Walk
from ribbonopt.transcription import NLP, CollocationMethod, Mesh, MultipleShooting

Array = np.ndarray
COUNT = 8
SCHEMES = {
    "gauss 6": CollocationMethod.named("gauss", 6),
    "rk8": MultipleShooting.named("rk8", steps=3),
}


def slab() -> BoundaryValueProblem:
    x, theta = ca.SX.sym("x", 2), ca.SX.sym("theta", 2)
    phase = Phase(ca.vertcat(x[1], -theta[0] * ca.exp(x[0] / (1 + theta[1] * x[0]))), ca.SX(1), {})
    return bvp(x, (phase,), lambda a, b: {"left": a[0], "right": b[0]}, theta=theta)


def load(a: float, l2: float) -> float:
    """Return l1 of the solution whose largest value is a."""
    t, weights = np.polynomial.legendre.leggauss(80)
    t, weights = (t + 1) / 2, weights / 2
    u = a * (1 - t**2)  # takes the root out of the integrand
    # F(a) - F(u) over each of [u, a], F' = exp(u / (1 + l2 u))
    inner = u[:, None] + (a - u)[:, None] * t
    gap = (a - u) * (np.exp(inner / (1 + l2 * inner)) @ weights)
    half = weights @ (2 * a * t / np.sqrt(2 * gap))
    return float((2 * half) ** 2)


def steepness(a: float, l2: float) -> float:
    h = 1e-4 * a
    return (load(a + h, l2) - load(a - h, l2)) / (2 * h)


@dataclass(frozen=True)
class FoldLocus:
    """The locus of folds in (l1, l2) on one mesh: an implementation of the protocol."""

    nlp: NLP
    line: Line
    metric: Metric

    @property
    def row(self) -> Array:
        """Of u'(0), which grows along every branch."""
        row = np.zeros(self.line.blocks.layout.nx * 2 + 2)
        row[1] = 1.0
        return row

    def test(self, z: Array) -> float:
        return fold_test(self.line, self.row, z)

    def measured(self, solution: None) -> "FoldLocus":
        return self

    def reduced(self, solution: None, vector: Array) -> Array:
        return self.line.reduced(vector)

    def linearise(self, solution: None, unknowns: Array, ahead: Array) -> LocusFactors:
        row = self.metric.dual(ahead)
        system = self.system(lambda z: row @ self.line.reduced(z))
        p = self.line.parameters(*unknowns[-2:])
        return system.factor(system.linearize(unknowns, p)[1], p)

    def heading(self, solution: None, unknowns: Array, ahead: Array) -> LocusFactors:
        return self.linearise(solution, unknowns, ahead)

    def correct_at(self, origin: None, guess: Array) -> Trial[None]:
        return self._solved(guess, lambda z: z[-1] - guess[-1])

    def correct_along(
        self, origin: Point[None], direction: Array, arc: float, guess: Array, enough: float = 0.0
    ) -> Trial[None]:
        row = self.metric.dual(self.line.reduced(direction))
        start = self.line.reduced(origin.unknowns)
        return self._solved(guess, lambda z: row @ (self.line.reduced(z) - start) - arc)

    def special(self, a: Point[None], b: Point[None]) -> Special[None]:
        return special_points(self, a, b)

    def crossings(self, a: Point[None], b: Point[None]) -> list[Point[None]]:
        return []

    def uncounted(self, a: None, b: None, changes: int) -> str:
        return ""

    def passed(self, point: Point[None], trial: Trial[None], expected: Array) -> None:
        return None

    def leaving(self, point: Point[None]) -> list[Point[None]]:
        return []

    def departure(self, point: Point[None]) -> None:
        return None

    def finer(self, origin: None, unknowns: Array) -> None:
        return None

    def enough(self, error: float, position: float) -> bool:
        return True

    def restored(self, origin: None, unknowns: Array) -> None:
        return None

    def verified(self, trial: Trial[None]) -> Trial[None]:
        return trial

    def finished(self, origin: Point[None], trial: Trial[None]) -> Trial[None]:
        return trial

    def elsewhere(self, origin: Point[None], position: float) -> None:
        return None

    def system(self, which: Callable[[Array], float]) -> LocusSystem:
        return LocusSystem(self.line, self.row, lambda z: np.array([self.test(z), which(z)]))

    def _solved(self, guess: Array, which: Callable[[Array], float]) -> Trial[None]:
        p = self.line.parameters(*guess[-2:])
        report = NewtonSolver(self.nlp, 1e-10).solve(guess, p, system=self.system(which))
        return Trial(None, report.w, report.status.converged, report.status.value)


@pytest.fixture(scope="module", params=SCHEMES)
def locus(request: pytest.FixtureRequest) -> FoldLocus:
    nlp = SCHEMES[request.param].transcribe(slab(), (COUNT,))
    widths = Mesh.uniform(COUNT).widths
    line = Line(nlp.blocks, lambda l1, l2: np.concatenate([[l1, l2], widths]), 1e-4, 2)
    sizes = np.array([1.0, 5.0, 1.0, 5.0, 3.0, 0.25])
    return FoldLocus(nlp, line, Metric(sizes))


def begun(locus: FoldLocus, l2: float) -> Array:
    """Return [w, l1, l2] at the first fold."""
    w = (
        NewtonSolver(locus.nlp)
        .solve(np.zeros(locus.nlp.unknowns), locus.line.parameters(3.4, l2))
        .w
    )
    trial = locus.correct_at(None, np.append(w, [3.4, l2]))
    assert trial.converged
    return trial.unknowns


def highest(locus: FoldLocus, z: Array) -> float:
    """Return the largest value of a solution, by the first integral of the equation."""
    l1, l2 = z[-2:]
    slope = locus.line.blocks.layout.unpack(z[:-2])[0][0, 1]
    t, weights = np.polynomial.legendre.leggauss(80)
    u = (t + 1) / 2

    def off(a: float) -> float:
        return float(l1 * a * (np.exp(a * u / (1 + l2 * a * u)) @ weights) - slope**2)

    return brentq(off, 1e-6, 50, xtol=1e-13)


@pytest.mark.parametrize("l2", [0.0, 0.1, 0.2])
def test_fold_is_that_of_the_quadrature(locus: FoldLocus, l2: float) -> None:
    a = brentq(steepness, 0.5, 3.5, (l2,), xtol=1e-12)
    z = begun(locus, l2)
    assert z[-1] == pytest.approx(l2, abs=1e-15)
    assert z[-2] == pytest.approx(load(a, l2), rel=1e-8)
    assert highest(locus, z) == pytest.approx(a, rel=1e-6)


@pytest.mark.parametrize("locus", ["gauss 6"], indirect=True)
def test_walk_follows_the_locus_through_the_cusp_and_back(locus: FoldLocus) -> None:
    walk = Walk(locus, Straight(0, (0.25,), 0.03, 0.01, name="l2"), 1)
    first = walk.begin(None, begun(locus, 0.0))
    points = [first]
    for point in walk.points(first):
        points.append(point)
        if point.kind == POINT and point.position < 0.2 and point.tangent[-1] < 0:
            break
    (special,) = [point for point in points if point.kind != POINT]
    assert special.kind == FOLD  # of the locus itself, where l2 turns
    cusp = special.unknowns
    assert cusp[-1] == pytest.approx(0.24578, abs=5e-6)
    for point in points:
        z = point.unknowns
        a = highest(locus, z)
        assert load(a, z[-1]) == pytest.approx(z[-2], rel=1e-7)
        assert abs(steepness(a, z[-1])) < 1e-5
    highs = [highest(locus, point.unknowns) for point in points]
    assert highs == sorted(highs)
    assert len(points) < 40


def test_steps_converge_quadratically(locus: FoldLocus) -> None:
    z = begun(locus, 0.1)
    system = locus.system(lambda z: z[-1] - 0.1)
    p = locus.line.parameters(*z[-2:])
    y = z + 1e-3 * np.cos(np.arange(len(z)))
    errors = []
    for _ in range(3):
        residuals, derivatives = system.linearize(y, p)
        y = y + system.factor(derivatives, p).solve(residuals)
        errors.append(np.abs(y - z).max())
    assert errors[1] < 100 * errors[0] ** 2 + 1e-9
    assert errors[-1] < 1e-9
    np.testing.assert_allclose(system.vector(y, p), 0, atol=1e-9)
