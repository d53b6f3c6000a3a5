"""Multiple shooting: one set of numbers from its blocks, its sparse program and collocation."""

from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from analytic import (
    bvp,
    double_integrator,
    implicit,
    layers,
    layers_exact,
    rational,
    rational_exact,
    switching,
)
from generic import nonlinear, random_data
from references import HALF_MOEBIUS

from ribbonopt.errors import TranscriptionError
from ribbonopt.guess import IntegratedLoads, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Phase, Posed, formulate
from ribbonopt.scene import load_scene
from ribbonopt.solvers import IpoptSolver, NewtonSolver, SolveReport, Status
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.transcription import NLP, CollocationMethod, Mesh, MultipleShooting
from ribbonopt.transcription.shooting.output import ShootingOutput

Array = np.ndarray
METHODS = [("rk4", 1, 1), ("rk8", 1, 1), ("rk4", 1, 3), ("gauss", 1, 1), ("gauss", 3, 2)]
MESHES = [(1,), (5,), (23,), (2, 3, 1), (1, 1, 1)]
each_method = pytest.mark.parametrize("method", METHODS, ids=str)
each_mesh = pytest.mark.parametrize("elements", MESHES, ids=str)


def ordinary(phases: int) -> BoundaryValueProblem:
    """Return a problem without algebraic variables that uses everything else of the contract."""
    problem = nonlinear(phases)
    x, c, z = problem.state, problem.constants, problem.algebraic
    instead = ca.vertcat(ca.cos(x[0] * c[1]), x[1] + problem.parameters[1])
    parts = tuple(
        replace(
            phase,
            dynamics=ca.substitute(phase.dynamics, z, instead),
            algebraic=ca.SX(0, 1),
        )
        for phase in problem.phases
    )
    return replace(problem, phases=parts, algebraic=ca.SX(0, 1))


def problem_for(method: tuple[str, int, int], phases: int) -> BoundaryValueProblem:
    return nonlinear(phases) if method[0] == "gauss" else ordinary(phases)


def shooting(
    problem: BoundaryValueProblem, method: tuple[str, int, int], elements: tuple[int, ...]
) -> NLP:
    return MultipleShooting.named(*method).transcribe(problem, elements)


def shot(
    problem: BoundaryValueProblem,
    method: tuple[str, int, int],
    *elements: int,
    start: float = 1.0,
) -> tuple[SolveReport, ShootingOutput]:
    nlp = shooting(problem, method, elements)
    p = Mesh.uniform(*elements).widths
    report = NewtonSolver(nlp).solve(np.full(nlp.unknowns, start), p)
    assert report.status is Status.CONVERGED, report.status
    dense = nlp.output(report.w, p)
    assert isinstance(dense, ShootingOutput)
    return report, dense


@each_method
@each_mesh
def test_jacobian_is_that_of_finite_differences(
    method: tuple[str, int, int], elements: tuple[int, ...]
) -> None:
    nlp = shooting(problem_for(method, len(elements)), method, elements)
    w, p = random_data(nlp, elements)
    values, jacobian = nlp.functions.jacobian(w, p)
    g = nlp.functions.constraints
    step = 1e-6 * np.eye(nlp.unknowns)
    differences = [np.array(g(w + h, p) - g(w - h, p)).ravel() / 2e-6 for h in step]
    np.testing.assert_allclose(np.array(jacobian), np.array(differences).T, atol=2e-8)
    np.testing.assert_allclose(values, g(w, p), atol=1e-13)
    assert nlp.functions.hessian.nnz_out(0) == 0


@each_method
@each_mesh
def test_jacobian_is_that_of_automatic_differentiation(
    method: tuple[str, int, int], elements: tuple[int, ...]
) -> None:
    nlp = shooting(problem_for(method, len(elements)), method, elements)
    w, p = ca.MX.sym("w", nlp.unknowns), ca.MX.sym("p", nlp.parameters)
    automatic = ca.Function("J", [w, p], [ca.jacobian(nlp.functions.constraints(w, p), w)])
    data = random_data(nlp, elements)
    found = np.array(nlp.functions.jacobian(*data)[1])
    np.testing.assert_allclose(found, np.array(automatic(*data)), atol=1e-11)


@each_method
@each_mesh
def test_blocks_are_those_of_the_sparse_program(
    method: tuple[str, int, int], elements: tuple[int, ...]
) -> None:
    nlp = shooting(problem_for(method, len(elements)), method, elements)
    assert nlp.square
    w, p = random_data(nlp, elements)
    residuals, derivatives = nlp.blocks.linearize(w, p)
    expected, jacobian = (np.array(part) for part in nlp.functions.jacobian(w, p))
    np.testing.assert_allclose(residuals.vector(), expected.ravel(), atol=1e-14)
    np.testing.assert_allclose(nlp.blocks.residuals(w, p).vector(), expected.ravel(), atol=1e-13)
    step = CondensedSystem(nlp.blocks, derivatives, p).solve(residuals)
    direct = np.linalg.solve(jacobian, -expected.ravel())
    tolerance = 1e-14 * np.linalg.cond(jacobian) * np.abs(direct).max()
    np.testing.assert_allclose(step, direct, rtol=0, atol=tolerance)


@each_method
def test_evaluations_do_not_share_memory(method: tuple[str, int, int]) -> None:
    nlp = shooting(problem_for(method, 1), method, (3,))
    w, p = random_data(nlp, (3,))
    residuals, derivatives = nlp.blocks.linearize(w, p)
    before = [residuals.vector(), derivatives.stages.copy(), derivatives.conditions.copy()]
    nlp.blocks.linearize(2 * w, p)
    nlp.blocks.residuals(3 * w, p)
    after = [residuals.vector(), derivatives.stages, derivatives.conditions]
    for a, b in zip(before, after, strict=True):
        np.testing.assert_array_equal(a, b)


def test_only_nodes_and_constants_are_unknown() -> None:
    nlp = shooting(nonlinear(2), ("gauss", 2, 1), (3, 4))
    assert nlp.unknowns == 8 * 2 + 2
    assert not nlp.inequality.any()
    nodes, stages, constants = nlp.layout.unpack(np.arange(float(nlp.unknowns)))
    assert (nodes.shape, stages.shape, constants.shape) == ((8, 2), (7, 0, 4), (2,))
    np.testing.assert_array_equal(
        nlp.layout.pack(nodes, stages, constants), np.arange(nlp.unknowns)
    )
    p = random_data(nlp, (3, 4))[1]
    assert nlp.blocks.stage_positions(p).shape == (7, 0)
    np.testing.assert_array_equal(nlp.blocks.widths(p), p[2:])


SQUARE = {
    "layers": (layers(10.0), (6,)),
    "rational": (rational(), (5,)),
    "switching": (switching(), (3, 2)),
}


@each_method
@pytest.mark.parametrize("name", SQUARE)
def test_condensed_and_sparse_newton_and_ipopt_give_one_answer(
    name: str, method: tuple[str, int, int]
) -> None:
    problem, elements = SQUARE[name]
    nlp = shooting(problem, method, elements)
    p = Mesh.uniform(*elements).widths
    w = np.full(nlp.unknowns, 0.6)
    condensed = NewtonSolver(nlp).solve(w, p)
    for other in (
        NewtonSolver(replace(nlp, structure=None)).solve(w, p),
        IpoptSolver(nlp).solve(w, p),
    ):
        assert condensed.status is other.status is Status.CONVERGED
        np.testing.assert_allclose(other.w, condensed.w, rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("problem", [implicit(), rational()], ids=["implicit", "rational"])
@pytest.mark.parametrize("degree", [1, 2, 3, 5])
def test_implicit_steps_are_collocation_without_its_stages(
    problem: BoundaryValueProblem, degree: int
) -> None:
    _, dense = shot(problem, ("gauss", degree, 1), 4)
    nlp = CollocationMethod.named("gauss", degree).transcribe(problem, (4,))
    p = Mesh.uniform(4).widths
    report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p)
    assert report.status is Status.CONVERGED
    expected, stages, _ = nlp.layout.unpack(report.w)
    s = dense.nodes(0)
    np.testing.assert_allclose(dense.states(0, s), expected, rtol=1e-12)
    assert stages.size


def test_several_steps_are_several_elements() -> None:
    _, one = shot(rational(), ("rk4", 1, 3), 4)
    _, other = shot(rational(), ("rk4", 1, 1), 12)
    s = one.nodes(0)
    np.testing.assert_allclose(one.states(0, s), other.states(0, s), rtol=1e-12)


@pytest.mark.parametrize("method", [("rk8", 1, 16), ("gauss", 4, 16)], ids=str)
def test_one_interval_is_single_shooting(method: tuple[str, int, int]) -> None:
    report, dense = shot(rational(), method, 1, start=0.1)
    assert report.w.shape == (4,)
    s = np.linspace(0, 1, 7)
    np.testing.assert_allclose(dense.states(0, s), rational_exact(s), rtol=1e-9)


@pytest.mark.parametrize("method", [("rk8", 1, 2), ("gauss", 6, 1)], ids=str)
def test_unknown_switching_point(method: tuple[str, int, int]) -> None:
    _, dense = shot(switching(), method, 5, 4, start=0.5)
    switch = np.pi / 6
    assert dense.constants[0] == pytest.approx(switch, abs=1e-11)
    s = np.linspace(0, 1, 33)
    np.testing.assert_allclose(dense.states(0, s)[:, 0], np.sin(switch * s), atol=1e-11)
    t = (1 - switch) * s
    second = np.cos(2 * t) / 2 + np.cos(switch) / 2 * np.sin(2 * t)
    np.testing.assert_allclose(dense.states(1, s)[:, 0], second, atol=1e-11)
    for phase in (0, 1):
        _, positions, weights = dense.stages(phase)
        assert weights.sum() == pytest.approx(1, abs=1e-14)
        assert ((positions > 0) & (positions < 1)).all()
    assert dense.residual_between_nodes().shape == (9, 1)
    assert dense.residual_between_nodes().max() < 1e-9


@pytest.mark.parametrize("method", [("rk8", 1, 2), ("gauss", 1, 2)], ids=str)
def test_position_enters_the_equations(method: tuple[str, int, int]) -> None:
    x, s = ca.SX.sym("x"), ca.SX.sym("s")
    halves = (Phase(2 * s, ca.SX(0.5), {}), Phase(4 * s, ca.SX(1.5), {}))
    problem = bvp(x, halves, lambda a, b, c: {"start": a}, s=s)
    _, dense = shot(problem, method, 3, 4)
    ends = dense.states(0, np.array([1.0])), dense.states(1, np.array([1.0]))
    np.testing.assert_allclose(ends, [[[0.25]], [[0.25 + 8 - 0.5]]], atol=1e-13)


def test_stiff_layers_by_implicit_steps() -> None:
    _, dense = shot(layers(1000.0), ("gauss", 8, 1), 401)
    s = dense.nodes(0)
    np.testing.assert_allclose(dense.states(0, s), layers_exact(1000.0, s), atol=1e-10)


def test_algebraic_variables_follow_from_the_states() -> None:
    _, dense = shot(implicit(), ("gauss", 4, 1), 6)
    s = np.linspace(0, 1, 33)
    x, z = dense.states(0, s), dense.algebraic(0, s)
    np.testing.assert_allclose(x[:, 0], np.exp(s), rtol=1e-11)
    np.testing.assert_allclose(z, x, rtol=1e-13)
    assert dense.algebraic(0, np.empty(0)).shape == (0, 1)
    assert dense.states(0, np.empty(0)).shape == (0, 1)


def two_sheets() -> BoundaryValueProblem:
    """x' = z, z^2 = x^2: z = x or z = -x, depending on where its search starts."""
    x, z = ca.SX.sym("x"), ca.SX.sym("z")
    phase = Phase(z, ca.SX(1), {}, algebraic=z**2 - x**2)
    return bvp(x, (phase,), lambda a, b: {"left": a - 1}, z=z)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_start_of_algebraic_variables_chooses_their_sheet(sign: float) -> None:
    problem = two_sheets()
    problem = replace(problem, algebraic_start=2 * sign * problem.state)
    nlp = MultipleShooting.named("gauss", 4).transcribe(problem, (5,))
    p = Mesh.uniform(5).widths
    report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p)
    assert report.status is Status.CONVERGED
    s = np.linspace(0, 1, 9)
    dense = nlp.output(report.w, p)
    np.testing.assert_allclose(dense.states(0, s)[:, 0], np.exp(sign * s), rtol=1e-9)


def test_inner_equations_without_solution_are_not_a_number() -> None:
    x, z = ca.SX.sym("x"), ca.SX.sym("z")
    phase = Phase(z, ca.SX(1), {}, algebraic=z**2 + 1 + x**2)
    problem = bvp(x, (phase,), lambda a, b: {"left": a - 1}, z=z)
    nlp = shooting(problem, ("gauss", 2, 1), (3,))
    report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), Mesh.uniform(3).widths)
    assert report.status is Status.INVALID_NUMBER


@each_method
def test_finer_is_the_same_problem_on_halved_elements(method: tuple[str, int, int]) -> None:
    problem = problem_for(method, 2)
    blocks, split = shooting(problem, method, (3, 2)).blocks.finer
    fine = shooting(problem, method, (6, 4))
    w, p = random_data(fine, (6, 4))
    assert split == 2
    assert blocks.name == fine.blocks.name
    np.testing.assert_array_equal(
        blocks.residuals(w, p).vector(), fine.blocks.residuals(w, p).vector()
    )


def test_facts_for_reports() -> None:
    facts = [
        (b.name, b.degree, b.order, b.symplectic)
        for b in (shooting(rational(), method, (2,)).blocks for method in METHODS)
    ]
    assert facts == [
        ("rk4 x 1", 4, 4, False),
        ("rk8 x 1", 12, 8, False),
        ("rk4 x 3", 4, 4, False),
        ("gauss 1 x 1", 1, 2, True),
        ("gauss 3 x 2", 3, 6, True),
    ]
    assert MultipleShooting.named("rk8", steps=2).name == "rk8 x 2"
    assert CollocationMethod.named("lobatto", 4).name == "lobatto 4"
    blocks = CollocationMethod.named("gauss", 6).transcribe(rational(), (2,)).blocks
    assert (blocks.name, blocks.degree, blocks.order, blocks.symplectic) == ("gauss 6", 6, 12, True)


REFUSED = {
    "cost": (double_integrator(), "gauss", "cannot minimise a cost; use collocation"),
    "control": (
        replace(
            double_integrator(),
            phases=tuple(
                replace(p, cost=None, path=p.dynamics[:1]) for p in double_integrator().phases
            ),
        ),
        "gauss",
        "1 algebraic variables from as many equations, found 0",
    ),
    "path": (
        replace(
            implicit(),
            phases=tuple(replace(p, path=p.dynamics) for p in implicit().phases),
        ),
        "gauss",
        "no unknowns inside the intervals on which path inequalities could act",
    ),
    "explicit": (
        implicit(),
        "rk4",
        "rk4 is explicit and integrates ordinary differential equations only, found 1 algebraic "
        "variables; use shooting with scheme gauss, or collocation",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_shooting_cannot_do_is_refused_in_one_sentence(name: str) -> None:
    problem, scheme, words = REFUSED[name]
    with pytest.raises(TranscriptionError, match=words) as found:
        MultipleShooting.named(scheme, 2).transcribe(problem, (3,))
    assert ". " not in str(found.value)
    assert "\n" not in str(found.value)


def test_unknown_schemes_steps_and_meshes_are_refused() -> None:
    with pytest.raises(TranscriptionError, match="'rk5', expected one of rk4, rk8, gauss"):
        MultipleShooting.named("rk5")
    with pytest.raises(TranscriptionError, match="found 0, expected >= 1"):
        MultipleShooting.named("rk4", steps=0)
    with pytest.raises(TranscriptionError, match="found 11, expected a whole number from 1 to 10"):
        MultipleShooting.named("gauss", 11)
    with pytest.raises(TranscriptionError, match="mesh has 2 phases, the problem has 1"):
        MultipleShooting.named("rk4").transcribe(rational(), (3, 3))


MOEBIUS = {
    ("rk8", 1, 1): (40, 1e-11),
    ("rk4", 1, 10): (20, 1e-6),
    ("gauss", 6, 1): (10, 1e-11),
}


@pytest.mark.parametrize("method", MOEBIUS, ids=str)
def test_half_moebius_ribbon_is_that_of_the_reference(
    configs: Path, method: tuple[str, int, int]
) -> None:
    # The analytic law: explicit methods have a stage where Sadowsky's law jumps, s = 1/2.
    scene = load_scene(configs / "moebius_half.yaml", ["law={type: single_sheet, chi: 1}"])
    posed = Posed.of(scene)
    ribbon, problem = formulate(posed)
    intervals, tolerance = MOEBIUS[method]
    nlp = shooting(problem, method, (intervals,))
    p = np.concatenate([posed.values, Mesh.uniform(intervals).widths])
    guess = IntegratedLoads(ribbon, posed, scene.guess)
    report = NewtonSolver(nlp).solve(initial_unknowns(guess, ribbon, problem, nlp.blocks, p), p)
    assert report.status is Status.CONVERGED
    reference = np.concatenate([HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]])
    constants = nlp.output(report.w, p).constants
    np.testing.assert_allclose(constants, reference, rtol=0, atol=tolerance * 44)
