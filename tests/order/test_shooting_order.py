"""Orders of shooting and of Lobatto collocation, measured against those that they declare."""

from pathlib import Path

import numpy as np
import pytest
from analytic import by_newton, implicit, rational, rational_exact
from references import HALF_MOEBIUS

from ribbonopt.guess import IntegratedLoads, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Posed, formulate
from ribbonopt.scene import load_scene
from ribbonopt.solvers import NewtonSolver, Status
from ribbonopt.transcription import Mesh, MultipleShooting, Output, lobatto

#: (scheme, degree, steps): intervals whose errors are asymptotic and above rounding
SHOOTING = {
    ("rk4", 1, 1): (16, 32, 64),
    ("rk4", 1, 3): (8, 16, 32),
    ("rk8", 1, 1): (8, 12, 16),
    ("rk8", 1, 2): (4, 6, 8),
    ("gauss", 1, 1): (32, 64),
    ("gauss", 2, 1): (16, 32),
    ("gauss", 3, 1): (12, 24),
    ("gauss", 3, 2): (6, 12),
}
LOBATTO = {2: (64, 128), 3: (16, 32, 64), 4: (12, 24), 5: (8, 12)}
each_method = pytest.mark.parametrize(("scheme", "degree", "steps"), SHOOTING, ids=lambda x: str(x))
each_lobatto = pytest.mark.parametrize("degree", LOBATTO)


def slope(counts: tuple[int, ...], errors: list[float]) -> float:
    """Return the order: minus the slope of log error over log number of intervals."""
    return -float(np.polyfit(np.log(counts), np.log(errors), 1)[0])


def shot(problem: BoundaryValueProblem, method: tuple[str, int, int], elements: int) -> Output:
    nlp = MultipleShooting.named(*method).transcribe(problem, (elements,))
    p = Mesh.uniform(elements).widths
    report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p)
    assert report.status is Status.CONVERGED
    return nlp.output(report.w, p)


def between(nodes: np.ndarray) -> np.ndarray:
    """Return points inside every element."""
    share = np.array([0.21, 0.55, 0.83])
    return (nodes[:-1, None] + np.diff(nodes)[:, None] * share).ravel()


def error(dense: Output, s: np.ndarray) -> float:
    return float(np.abs(dense.states(0, s) - rational_exact(s)).max())


@each_method
def test_nodes_and_points_between_converge_at_the_declared_order(
    scheme: str, degree: int, steps: int
) -> None:
    method = (scheme, degree, steps)
    nodes, points = [], []
    for intervals in SHOOTING[method]:
        dense = shot(rational(), method, intervals)
        nodes.append(error(dense, dense.nodes(0)))
        points.append(error(dense, between(dense.nodes(0))))
    order = dense.blocks.order
    assert dense.order == order
    assert slope(SHOOTING[method], nodes) == pytest.approx(order, abs=0.35)
    assert slope(SHOOTING[method], points) == pytest.approx(order, abs=0.35)


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_algebraic_variables_have_the_order_of_the_states(degree: int) -> None:
    meshes, x, z = (3, 6, 12), [], []
    for intervals in meshes:
        dense = shot(implicit(), ("gauss", degree, 1), intervals)
        s = between(dense.nodes(0))
        x.append(np.abs(dense.states(0, s)[:, 0] - np.exp(s)).max())
        z.append(np.abs(dense.algebraic(0, s)[:, 0] - np.exp(s)).max())
    assert slope(meshes, x) == pytest.approx(2 * degree, abs=0.3)
    assert slope(meshes, z) == pytest.approx(2 * degree, abs=0.3)


INTEGRALS = {("rk4", 1, 1): (24, 32, 48), ("rk8", 1, 1): (16, 24), ("gauss", 2, 1): (16, 32)}


@pytest.mark.parametrize("method", INTEGRALS, ids=str)
def test_integrals_and_the_residual_have_the_order_of_the_scheme(
    method: tuple[str, int, int],
) -> None:
    integrals, residuals = [], []
    for intervals in INTEGRALS[method]:
        dense = shot(rational(), method, intervals)
        v, sigma, weights = dense.stages(0)
        np.testing.assert_allclose(v[:, :2], dense.states(0, sigma), atol=1e-15)
        integrals.append(abs(weights @ v[:, 0] ** 2 - 14 / 3))  # of 16 / (1 + s)^4
        residuals.append(dense.residual_between_nodes().max())
    order = dense.blocks.order
    assert slope(INTEGRALS[method], integrals) == pytest.approx(order, abs=0.5)
    assert slope(INTEGRALS[method], residuals) == pytest.approx(order, abs=0.5)


RIBBON = {
    ("rk4", 1, 1): (64, 128),
    ("rk8", 1, 1): (5, 10),
    ("gauss", 2, 1): (16, 32),
    ("gauss", 3, 1): (10, 20),
}


@pytest.mark.parametrize("method", RIBBON, ids=str)
def test_the_ribbon_converges_at_the_declared_order(
    configs: Path, method: tuple[str, int, int]
) -> None:
    # The analytic law: explicit methods have a stage where Sadowsky's law jumps, s = 1/2.
    scene = load_scene(configs / "moebius_half.yaml", ["law={type: single_sheet, chi: 1}"])
    posed = Posed.of(scene)
    ribbon, problem = formulate(posed)
    reference = np.concatenate([HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]])
    errors = []
    for intervals in RIBBON[method]:
        nlp = MultipleShooting.named(*method).transcribe(problem, (intervals,))
        p = np.concatenate([posed.values, Mesh.uniform(intervals).widths])
        guess = IntegratedLoads(ribbon, posed, scene.guess)
        report = NewtonSolver(nlp).solve(initial_unknowns(guess, ribbon, problem, nlp.blocks, p), p)
        assert report.status is Status.CONVERGED
        # Reduced states: n, and m at the origin, are the constants.
        constants = nlp.output(report.w, p).constants
        errors.append(np.abs(constants - reference).max())
    assert slope(RIBBON[method], errors) == pytest.approx(nlp.blocks.order, abs=0.5)


@each_lobatto
def test_lobatto_nodes_converge_at_the_declared_order(degree: int) -> None:
    nodes, points = [], []
    for intervals in LOBATTO[degree]:
        _, dense = by_newton(rational(), "lobatto", degree, intervals)
        nodes.append(error(dense, dense.nodes(0)))
        points.append(error(dense, between(dense.nodes(0))))
    order = lobatto(degree).order
    assert dense.order == dense.blocks.order == order == 2 * degree - 2
    assert slope(LOBATTO[degree], nodes) == pytest.approx(order, abs=0.3)
    assert slope(LOBATTO[degree], points) == pytest.approx(order, abs=0.35)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_lobatto_solves_algebraic_variables_at_both_ends(degree: int) -> None:
    meshes, errors = (3, 6, 12), []
    for intervals in meshes:
        _, dense = by_newton(implicit(), "lobatto", degree, intervals)
        v, s, _ = dense.stages(0)
        assert s[0] == 0
        assert s[-1] == pytest.approx(1, abs=1e-15)
        # x = z satisfies the algebraic equation: at every stage, ends included.
        np.testing.assert_allclose(v[:, 0], v[:, 1], rtol=1e-12)
        ends = dense.nodes(0)
        errors.append(np.abs(dense.algebraic(0, ends)[:, 0] - np.exp(ends)).max())
    assert slope(meshes, errors) == pytest.approx(2 * degree - 2, abs=0.3)
