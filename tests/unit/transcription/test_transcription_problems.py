"""Transcription and solvers on problems that are not ribbons, against their closed forms."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from analytic import (
    bvp,
    by_newton,
    double_integrator,
    implicit,
    layers,
    layers_exact,
    rational,
    rational_exact,
    switching,
    transcribed,
)

from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers import IpoptSolver, NewtonSolver, Status
from ribbonopt.transcription.collocation.output import DenseOutput

SWITCH = np.pi / 6


@pytest.mark.parametrize("rate", [1.0, 100.0, 1000.0])
@pytest.mark.parametrize("elements", [400, 401])
def test_boundary_layers_grow_no_error(rate: float, elements: int) -> None:
    report, dense = by_newton(layers(rate), "gauss", 10, elements)
    s = dense.nodes(0)
    assert np.abs(dense.states(0, s) - layers_exact(rate, s)).max() < 1e-12
    assert report.factorizations <= 2


def test_linear_problems_take_one_step() -> None:
    report, _ = by_newton(layers(10.0), "gauss", 4, 20)
    assert report.iterations <= 1


@pytest.mark.parametrize("scheme", ["gauss", "radau"])
def test_nonlinear_problem(scheme: str) -> None:
    _, dense = by_newton(rational(), scheme, 8, 20)
    s = np.linspace(0, 1, 77)
    assert np.abs(dense.states(0, s) - rational_exact(s)).max() < 1e-12


def test_unknown_switching_point() -> None:
    _, dense = by_newton(switching(), "gauss", 6, 5, 4, start=0.5)
    assert dense.constants[0] == pytest.approx(SWITCH, abs=1e-13)
    s = np.linspace(0, 1, 33)
    np.testing.assert_allclose(dense.states(0, s)[:, 0], np.sin(SWITCH * s), atol=1e-13)
    t = (1 - SWITCH) * s
    second = np.cos(2 * t) / 2 + np.cos(SWITCH) / 2 * np.sin(2 * t)
    np.testing.assert_allclose(dense.states(1, s)[:, 0], second, atol=1e-13)


def test_algebraic_variables() -> None:
    _, dense = by_newton(implicit(), "gauss", 8, 10)
    s = np.linspace(0, 1, 33)
    np.testing.assert_allclose(dense.states(0, s)[:, 0], np.exp(s), rtol=1e-12)
    np.testing.assert_allclose(dense.algebraic(0, s)[:, 0], np.exp(s), rtol=1e-10)


def test_position_enters_the_equations() -> None:
    x, s = ca.SX.sym("x"), ca.SX.sym("s")
    halves = (Phase(2 * s, ca.SX(0.5), {}), Phase(3 * s**2, ca.SX(1.5), {}))
    problem = bvp(x, halves, lambda a, b, c: {"start": a}, s=s)
    _, dense = by_newton(problem, "gauss", 2, 3, 4)
    ends = dense.states(0, np.array([1.0])), dense.states(1, np.array([1.0]))
    np.testing.assert_allclose(ends, [[[0.25]], [[0.25 + 8 - 0.125]]], atol=1e-14)


def optimum(
    problem: BoundaryValueProblem, scheme: str, elements: int
) -> tuple[IpoptSolver, np.ndarray, DenseOutput]:
    """Return the solver, the multipliers and the numbers of a minimum found from zeros."""
    nlp, p = transcribed(problem, scheme, 3, elements)
    solver = IpoptSolver(nlp, tolerance=1e-11)
    report = solver.solve(np.zeros(nlp.unknowns), p)
    assert report.status is Status.CONVERGED
    return solver, report.multipliers, DenseOutput(nlp.blocks, report.w, p)


def test_minimum_energy_has_its_exact_control_and_cost() -> None:
    solver, _, dense = optimum(double_integrator(), "gauss", 5)
    s = np.linspace(0, 1, 21)
    np.testing.assert_allclose(dense.algebraic(0, s)[:, 0], 6 - 12 * s, atol=1e-10)
    np.testing.assert_allclose(dense.states(0, s)[:, 0], 3 * s**2 - 2 * s**3, atol=1e-11)
    assert float(solver.nlp.functions.cost(dense.w, dense.p)) == pytest.approx(6, abs=1e-10)


def test_multipliers_are_the_costates() -> None:
    _, multipliers, dense = optimum(double_integrator(), "gauss", 5)
    lay = dense.blocks.layout
    # H = u^2 / 2 + p1 v + p2 u: p1 = -12, p2 = -u; a multiplier of x_{e+1} - x_e - ... is -p.
    body = multipliers[: lay.conditions_at].reshape(5, -1)[:, -2:]
    s = dense.nodes(0)[1:]
    np.testing.assert_allclose(body, -np.stack([-12 + 0 * s, 12 * s - 6], axis=1), atol=1e-9)
    np.testing.assert_allclose(multipliers[lay.conditions_at :], [12, 6, -12, 6], atol=1e-9)


def test_an_active_inequality_holds_the_state_at_its_limit() -> None:
    # Bryson and Denham: for a limit l <= 1/6 the cost is 4 / (9 l), x = l from 3 l to 1 - 3 l,
    # and the costate jumps by 2 / (9 l^2) on entering. Radau has stages on these points.
    limit = 1 / 9
    solver, multipliers, dense = optimum(double_integrator(limit), "radau", 12)
    assert float(solver.nlp.functions.cost(dense.w, dense.p)) == pytest.approx(4, abs=1e-8)
    held = dense.states(0, np.linspace(1 / 3, 2 / 3, 13))[:, 0]
    np.testing.assert_allclose(held, limit, atol=1e-6)
    s = np.linspace(0, 1 / 3, 9)
    control = dense.algebraic(0, s)[:, 0]
    np.testing.assert_allclose(control, -2 / (3 * limit) * (1 - s / (3 * limit)), atol=1e-4)
    pushing = multipliers[solver.nlp.inequality]
    assert pushing.min() > -1e-8
    assert pushing[: 4 * 3].sum() == pytest.approx(2 / (9 * limit**2), rel=1e-4)


@pytest.mark.parametrize("limit", [None, 0.2])
def test_newton_refuses_to_minimise(limit: float | None) -> None:
    nlp, p = transcribed(double_integrator(limit), "gauss", 3, 4)
    report = NewtonSolver(nlp).solve(np.zeros(nlp.unknowns), p)
    assert report.status is Status.NOT_SQUARE
    assert "ipopt" in report.status.value
    assert report.iterations == 0


SQUARE = {
    "layers": (layers(10.0), (6,)),
    "rational": (rational(), (5,)),
    "implicit": (implicit(), (5,)),
    "switching": (switching(), (3, 2)),
}


@pytest.mark.parametrize("name", SQUARE)
def test_sparse_and_condensed_newton_and_ipopt_give_one_answer(name: str) -> None:
    problem, elements = SQUARE[name]
    nlp, p = transcribed(problem, "radau", 3, *elements)
    w = np.full(nlp.unknowns, 0.6)
    condensed = NewtonSolver(nlp).solve(w, p)
    sparse = NewtonSolver(replace(nlp, structure=None)).solve(w, p)
    interior = IpoptSolver(nlp).solve(w, p)
    reports = (condensed, sparse, interior)
    assert all(r.status is Status.CONVERGED for r in reports)
    assert condensed.iterations == sparse.iterations
    np.testing.assert_allclose(sparse.w, condensed.w, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(interior.w, condensed.w, rtol=1e-11, atol=1e-11)
    assert all(np.abs(r.residuals).max() < 1e-11 for r in reports)


def undetermined() -> BoundaryValueProblem:
    """x'' = 0 with x'(0) = x'(1) = 0: x itself is free."""
    x = ca.SX.sym("x", 2)
    phase = Phase(ca.vertcat(x[1], 0), ca.SX(1), {})
    return bvp(x, (phase,), lambda a, b: {"left": a[1] - 1, "right": b[1] - 2})


@pytest.mark.parametrize("condensed", [True, False], ids=["condensed", "sparse"])
def test_singular_equations_are_told(condensed: bool) -> None:
    nlp, p = transcribed(undetermined(), "gauss", 2, 4)
    nlp = nlp if condensed else replace(nlp, structure=None)
    assert NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p).status is Status.SINGULAR


@pytest.mark.parametrize("condensed", [True, False], ids=["condensed", "sparse"])
def test_numbers_that_are_not_finite_are_told(condensed: bool) -> None:
    nlp, p = transcribed(rational(), "gauss", 2, 4)
    nlp = nlp if condensed else replace(nlp, structure=None)
    w = np.full(nlp.unknowns, np.nan)
    assert NewtonSolver(nlp).solve(w, p).status is Status.INVALID_NUMBER


@pytest.mark.parametrize("solver", [NewtonSolver, IpoptSolver])
def test_iterations_that_run_out_are_told(solver: type[NewtonSolver] | type[IpoptSolver]) -> None:
    nlp, p = transcribed(rational(), "gauss", 4, 4)
    report = solver(nlp, max_iterations=1).solve(np.full(nlp.unknowns, 50.0), p)
    assert report.status is Status.MAX_ITERATIONS
    assert not report.status.converged
    assert report.w.shape == (nlp.unknowns,)
    assert report.residuals.shape == (nlp.equations,)


def test_newton_leaves_the_guess_alone() -> None:
    nlp, p = transcribed(rational(), "gauss", 2, 4)
    w = np.full(nlp.unknowns, 1.0)
    NewtonSolver(nlp).solve(w, p)
    np.testing.assert_array_equal(w, 1.0)


def test_newton_is_damped_where_full_steps_diverge() -> None:
    # arctan(10 x) = 0 through a problem without dynamics: full steps diverge from x = 1.
    x = ca.SX.sym("x")
    problem = bvp(x, (Phase(ca.SX(0), ca.SX(1), {}),), lambda a, b: {"root": ca.atan(10 * a)})
    report, dense = by_newton(problem, "gauss", 1, 1, start=1.0)
    assert abs(dense.states(0, np.array([0.0]))[0, 0]) < 1e-12
    assert report.iterations > 2


def test_kept_factors_save_factorisations() -> None:
    nlp, p = transcribed(rational(), "gauss", 6, 10)
    report = NewtonSolver(nlp).solve(np.full(nlp.unknowns, 1.5), p)
    assert report.status is Status.CONVERGED
    assert report.factorizations < report.iterations
