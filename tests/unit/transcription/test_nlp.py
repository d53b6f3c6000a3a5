"""The sparse program laid out by hand, the element blocks, and automatic differentiation agree."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from generic import nonlinear, random_data

from ribbonopt.errors import TranscriptionError
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.transcription import NLP, CollocationMethod

Array = np.ndarray


SCHEMES = [("gauss", 1), ("gauss", 3), ("radau", 2)]
MESHES = [(1,), (4,), (5,), (23,), (2, 3, 1), (4, 12, 7), (1, 1, 1)]
each_scheme = pytest.mark.parametrize(("scheme", "degree"), SCHEMES)
each_mesh = pytest.mark.parametrize("elements", MESHES, ids=str)
each_kind = pytest.mark.parametrize("minimised", [False, True], ids=["square", "minimised"])


def automatic(nlp: NLP) -> tuple[ca.Function, ca.Function]:
    """Return Jacobian and Hessian of the Lagrangian by differentiation of the whole program."""
    f = nlp.functions
    w, p = ca.MX.sym("w", nlp.unknowns), ca.MX.sym("p", nlp.parameters)
    sigma, multipliers = ca.MX.sym("sigma"), ca.MX.sym("lambda", nlp.equations)
    g = f.constraints(w, p)
    lagrangian = sigma * f.cost(w, p) + ca.dot(multipliers, g)
    return (
        ca.Function("J", [w, p], [ca.jacobian(g, w)]),
        ca.Function("H", [w, p, sigma, multipliers], [ca.hessian(lagrangian, w)[0]]),
    )


@each_scheme
@each_mesh
@each_kind
def test_jacobian_is_that_of_automatic_differentiation(
    scheme: str, degree: int, elements: tuple[int, ...], minimised: bool
) -> None:
    problem = nonlinear(len(elements), minimised)
    nlp = CollocationMethod.named(scheme, degree).transcribe(problem, elements)
    w, p = random_data(nlp, elements)
    values, jacobian = nlp.functions.jacobian(w, p)
    expected = automatic(nlp)[0](w, p)
    np.testing.assert_allclose(np.array(jacobian), np.array(expected), atol=1e-14)
    np.testing.assert_allclose(values, nlp.functions.constraints(w, p), atol=1e-14)


@each_kind
def test_jacobian_is_that_of_finite_differences(minimised: bool) -> None:
    elements = (2, 3, 1)
    nlp = CollocationMethod.named("gauss", 2).transcribe(nonlinear(3, minimised), elements)
    w, p = random_data(nlp, elements)
    step = 1e-6 * np.eye(nlp.unknowns)
    g = nlp.functions.constraints
    differences = [np.array(g(w + h, p) - g(w - h, p)).ravel() / 2e-6 for h in step]
    jacobian = np.array(nlp.functions.jacobian(w, p)[1])
    np.testing.assert_allclose(jacobian, np.array(differences).T, atol=1e-8)


@each_scheme
@each_mesh
def test_hessian_is_that_of_automatic_differentiation(
    scheme: str, degree: int, elements: tuple[int, ...]
) -> None:
    problem = nonlinear(len(elements), minimised=True)
    nlp = CollocationMethod.named(scheme, degree).transcribe(problem, elements)
    w, p = random_data(nlp, elements)
    multipliers = np.random.default_rng(1).uniform(-1, 1, nlp.equations)
    hessian = np.array(nlp.functions.hessian(w, p, 0.7, multipliers))
    expected = np.triu(np.array(automatic(nlp)[1](w, p, 0.7, multipliers)))
    np.testing.assert_allclose(hessian, expected, atol=1e-13)
    assert np.abs(expected).max() > 0.1


def test_square_programs_need_no_hessian() -> None:
    nlp = CollocationMethod.named("gauss", 2).transcribe(nonlinear(1), (3,))
    assert nlp.functions.hessian.nnz_out(0) == 0


@each_scheme
@each_mesh
@each_kind
def test_blocks_give_the_constraints_of_the_program(
    scheme: str, degree: int, elements: tuple[int, ...], minimised: bool
) -> None:
    problem = nonlinear(len(elements), minimised)
    nlp = CollocationMethod.named(scheme, degree).transcribe(problem, elements)
    w, p = random_data(nlp, elements)
    expected = np.array(nlp.functions.constraints(w, p)).ravel()
    np.testing.assert_allclose(nlp.blocks.residuals(w, p).vector(), expected, atol=1e-14)
    np.testing.assert_allclose(nlp.blocks.linearize(w, p)[0].vector(), expected, atol=1e-14)


@each_scheme
@pytest.mark.parametrize("elements", [*MESHES, (101,), (50, 90)], ids=str)
def test_condensed_step_is_that_of_the_whole_jacobian(
    scheme: str, degree: int, elements: tuple[int, ...]
) -> None:
    problem = nonlinear(len(elements))
    nlp = CollocationMethod.named(scheme, degree).transcribe(problem, elements)
    assert nlp.square
    w, p = random_data(nlp, elements)
    residuals, derivatives = nlp.blocks.linearize(w, p)
    step = CondensedSystem(nlp.blocks, derivatives, p).solve(residuals)
    jacobian = np.array(nlp.functions.jacobian(w, p)[1])
    expected = np.linalg.solve(jacobian, -residuals.vector())
    tolerance = 1e-15 * np.linalg.cond(jacobian) * np.abs(expected).max()
    np.testing.assert_allclose(step, expected, rtol=0, atol=tolerance)


def test_evaluations_do_not_share_memory() -> None:
    nlp = CollocationMethod.named("gauss", 2).transcribe(nonlinear(1), (3,))
    w, p = random_data(nlp, (3,))
    residuals, derivatives = nlp.blocks.linearize(w, p)
    before = [residuals.vector().copy(), derivatives.stages.copy(), derivatives.conditions.copy()]
    nlp.blocks.linearize(2 * w, p)
    nlp.blocks.residuals(3 * w, p)
    after = [residuals.vector(), derivatives.stages, derivatives.conditions]
    for a, b in zip(before, after, strict=True):
        np.testing.assert_array_equal(a, b)


def test_a_finer_scheme_is_the_same_problem() -> None:
    problem = nonlinear(2)
    coarse = CollocationMethod.named("gauss", 2).transcribe(problem, (3, 2))
    fine = CollocationMethod.named("gauss", 3).transcribe(problem, (3, 2))
    blocks, split = coarse.blocks.finer
    w, p = random_data(fine, (3, 2))
    assert split == 1
    np.testing.assert_array_equal(
        blocks.residuals(w, p).vector(), fine.blocks.residuals(w, p).vector()
    )


def test_square_means_as_many_equations_as_unknowns() -> None:
    def transcribe(problem: BoundaryValueProblem) -> NLP:
        return CollocationMethod.named("gauss", 2).transcribe(problem, (3,))

    problem = nonlinear(1)
    assert transcribe(problem).square
    assert not transcribe(nonlinear(1, minimised=True)).square
    fewer = dict(list(problem.conditions.items())[1:])
    assert not transcribe(replace(problem, conditions=fewer)).square


def test_a_program_without_elements_has_no_blocks() -> None:
    nlp = CollocationMethod.named("gauss", 2).transcribe(nonlinear(1), (3,))
    with pytest.raises(TranscriptionError, match="not made of collocation elements"):
        _ = replace(nlp, structure=None).blocks


def test_a_mesh_needs_as_many_phases_as_the_problem() -> None:
    with pytest.raises(TranscriptionError, match="mesh has 1 phases, the problem has 2"):
        CollocationMethod.named("gauss", 2).transcribe(nonlinear(2), (3,))


def test_unknown_schemes_are_refused() -> None:
    with pytest.raises(TranscriptionError, match="found 'chebyshev', expected one of gauss, "):
        CollocationMethod.named("chebyshev", 2)
