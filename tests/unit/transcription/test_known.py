"""Known fields k(s): numbers that enter as parameters do, in every scheme and solver."""

import gc
import weakref
from collections.abc import Callable
from dataclasses import replace
from math import log2

import casadi as ca
import numpy as np
import pytest
from analytic import bvp

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError, TranscriptionError
from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solvers import IpoptSolver, NewtonSolver, SolveReport, Status
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.solvers.extended import ExtendedSystem, Line
from ribbonopt.transcription import NLP, CollocationMethod, Mesh, MultipleShooting, Output
from ribbonopt.transcription.known import Known

Scheme = CollocationMethod | MultipleShooting
NONE = np.empty(0)
SCHEMES: dict[str, Scheme] = {
    **{
        f"{name} {degree}": CollocationMethod.named(name, degree)
        for name, degree in (("gauss", 1), ("gauss", 3), ("radau", 2), ("lobatto", 3))
    },
    "rk4": MultipleShooting.named("rk4"),
    "rk8 x 2": MultipleShooting.named("rk8", steps=2),
    "shooting gauss 2 x 2": MultipleShooting.named("gauss", 2, 2),
}
HIGHEST = {"radau 10": CollocationMethod.named("radau", 10)}  # refined by halves
each_scheme = pytest.mark.parametrize("scheme", SCHEMES.values(), ids=SCHEMES)
IMPLICIT = {k: s for k, s in SCHEMES.items() if not k.startswith("rk")}
UNEVEN = Mesh((np.array([0.2, 0.1, 0.3, 0.15, 0.25]),))


def wave(phase: int, sigma: Array) -> Array:
    """k = cos 3s, on one phase of length 1."""
    return np.cos(3 * sigma)[:, None]


def known(problem: BoundaryValueProblem, k: ca.SX) -> BoundaryValueProblem:
    return replace(problem, known=k, known_names=tuple(f"k{i}" for i in range(k.numel())))


def growth(k: ca.SX | None = None) -> BoundaryValueProblem:
    """x' = k x, x(0) = 1, with k known or written as cos 3s: x = exp(sin(3s) / 3)."""
    x, s = ca.SX.sym("x"), ca.SX.sym("s")
    rate = ca.cos(3 * s) if k is None else k
    phase = Phase(rate * x, ca.SX(1), {"x": x, "k": rate, "energy": rate**2})
    problem = bvp(x, (phase,), lambda a, b: {"left": a - 1}, s=s)
    return problem if k is None else known(problem, k)


def exact(s: Array) -> Array:
    return np.exp(np.sin(3 * s) / 3)


def solved(
    nlp: NLP, mesh: Mesh, fields: Known | None, start: float = 1.0
) -> tuple[SolveReport, Output]:
    p = nlp.layout.parameters(NONE, mesh.widths, fields)
    report = NewtonSolver(nlp).solve(np.full(nlp.unknowns, start), p)
    assert report.status is Status.CONVERGED
    return report, nlp.output(report.w, p, fields)


@pytest.mark.parametrize("scheme", (SCHEMES | HIGHEST).values(), ids=SCHEMES | HIGHEST)
def test_a_known_field_is_what_it_would_be_as_an_expression(scheme: Scheme) -> None:
    k = ca.SX.sym("k")
    parts = []
    for problem, fields in ((growth(k), wave), (growth(), None)):
        nlp = scheme.transcribe(problem, UNEVEN.elements)
        report, output = solved(nlp, UNEVEN, fields)
        finer, _ = output.refined()
        residuals, derivatives = finer.blocks.linearize(finer.w, finer.p)
        better = finer.moved(CondensedSystem(finer.blocks, derivatives, finer.p).solve(residuals))
        trajectory = Trajectory(problem, output)
        where = np.linspace(0, 1, 23)
        named = trajectory.outputs(where)
        parts.append(
            {
                "unknowns": report.w,
                "jacobian": np.array(nlp.functions.jacobian(report.w, output.p)[1].nonzeros()),
                "constraints": np.array(nlp.functions.constraints(report.w, output.p)).ravel(),
                "stages": output.blocks.linearize(report.w, output.p)[1].stages,
                "states": output.states(0, where),
                "between": output.residual_between_nodes(),
                "finer": finer.w,
                "better": better.states(0, where),
                "energy": np.array(trajectory.energy),
                **named,
                **{f"stages {n}": v for n, v in trajectory.at_stages.items()},
                **{f"nodes {n}": v for n, v in trajectory.at_nodes.items()},
            }
        )
    ours, theirs = parts
    for name, values in theirs.items():
        np.testing.assert_allclose(ours[name], values, rtol=1e-12, atol=1e-13, err_msg=name)


@each_scheme
def test_orders_are_those_declared(scheme: Scheme) -> None:
    problem = growth(ca.SX.sym("k"))
    errors = []
    for count in (4, 8):
        nlp = scheme.transcribe(problem, (count,))
        _, output = solved(nlp, Mesh.uniform(count), wave)
        where = np.linspace(0, 1, 41)
        errors.append(float(np.abs(output.states(0, where)[:, 0] - exact(where)).max()))
    assert errors[1] < 1e-10 or log2(errors[0] / errors[1]) > output.blocks.order - 0.4


@each_scheme
def test_one_program_serves_other_fields(scheme: Scheme) -> None:
    nlp = scheme.transcribe(growth(ca.SX.sym("k")), (12,))
    mesh, end = Mesh.uniform(12), np.array([1.0])

    def constant(phase: int, sigma: Array) -> Array:
        return np.full((len(sigma), 1), -2.0)

    for fields, value in ((wave, exact(end)[0]), (constant, np.exp(-2.0)), (wave, exact(end)[0])):
        _, output = solved(nlp, mesh, fields)
        assert output.states(0, end)[0, 0] == pytest.approx(value, rel=1e-2)
    nlp = CollocationMethod.named("gauss", 6).transcribe(growth(ca.SX.sym("k")), (12,))
    assert solved(nlp, mesh, constant)[1].at_nodes[-1, 0] == pytest.approx(np.exp(-2), rel=1e-13)


@each_scheme
def test_another_mesh_reads_the_field_anew(scheme: Scheme) -> None:
    mesh, found = Mesh.uniform(9), []
    for problem, fields in ((growth(ca.SX.sym("k")), wave), (growth(), None)):
        _, output = solved(scheme.transcribe(problem, UNEVEN.elements), UNEVEN, fields)
        other = scheme.transcribe(problem, mesh.elements)
        p = other.layout.parameters(NONE, mesh.widths, fields)
        w = other.blocks.sampled(output, p)
        found.append((w, other.blocks.residuals(w, p).vector()))
    for ours, theirs in zip(*found, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-13)


@each_scheme
def test_ipopt_and_sparse_newton_agree(scheme: Scheme) -> None:
    nlp = scheme.transcribe(growth(ca.SX.sym("k")), UNEVEN.elements)
    report, output = solved(nlp, UNEVEN, wave)
    for other in (NewtonSolver(replace(nlp, structure=None)), IpoptSolver(nlp)):
        found = other.solve(np.ones(nlp.unknowns), output.p)
        assert found.status is Status.CONVERGED
        np.testing.assert_allclose(found.w, report.w, rtol=1e-11)


@each_scheme
def test_the_error_is_estimated_with_the_field_itself(scheme: Scheme) -> None:
    nlp = scheme.transcribe(growth(ca.SX.sym("k")), UNEVEN.elements)
    _, output = solved(nlp, UNEVEN, wave)
    finer, split = output.refined()
    residuals, derivatives = finer.blocks.linearize(finer.w, finer.p)
    better = finer.moved(CondensedSystem(finer.blocks, derivatives, finer.p).solve(residuals))
    error = output.at_nodes[:, 0] - exact(output.nodes(0))
    estimate = output.at_nodes[:, 0] - better.at_nodes[::split, 0]
    largest = np.abs(error).max()
    assert largest > 1e-12
    np.testing.assert_allclose(estimate, error, atol=0.35 * largest + 1e-13)


@pytest.mark.parametrize("scheme", IMPLICIT.values(), ids=IMPLICIT)
def test_algebraic_equations_contain_fields(scheme: Scheme) -> None:
    # z^3 + z = k^3 + k, x' = z: z = k everywhere, x = sin(3s) / 3.
    x, z, k = ca.SX.sym("x"), ca.SX.sym("z"), ca.SX.sym("k")
    phase = Phase(z, ca.SX(1), {}, algebraic=z**3 + z - k**3 - k)
    problem = known(bvp(x, (phase,), lambda a, b: {"left": a}, z=z), k)
    nlp = scheme.transcribe(problem, (8,))
    _, output = solved(nlp, Mesh.uniform(8), wave, start=0.5)
    where = np.linspace(0, 1, 17)
    np.testing.assert_allclose(output.algebraic(0, where), wave(0, where), atol=1e-6)
    np.testing.assert_allclose(output.states(0, where)[:, 0], np.sin(3 * where) / 3, atol=5e-3)
    assert np.isfinite(output.residual_between_nodes()).all()
    refined, _ = output.refined()
    assert np.abs(refined.states(0, where)[:, 0] - np.sin(3 * where) / 3).max() < 5e-3


def jumping(phase: int, sigma: Array) -> Array:
    """Two fields: (1 + sigma, 3) in the first phase, (-2, 5) in the second."""
    first = 1 + sigma if phase == 0 else np.full_like(sigma, -2.0)
    return np.column_stack([first, np.full_like(sigma, 3.0 if phase == 0 else 5.0)])


@each_scheme
def test_phases_have_fields_of_their_own_and_conditions_read_them(scheme: Scheme) -> None:
    # Lengths 1/2 and theta = 1; x(0) = k1(0) = 3, y ends at the sum of k1 of all points.
    x, k, theta = ca.SX.sym("x", 2), ca.SX.sym("k", 2), ca.SX.sym("theta")
    at = tuple(ca.SX.sym(f"k{i}", 2) for i in range(3))
    rates = ca.vertcat(k[0], k[1])
    phases = (Phase(rates, ca.SX(0.5), {}), Phase(rates, theta, {}))

    def conditions(a: ca.SX, b: ca.SX, c: ca.SX) -> dict[str, ca.SX]:
        return {"x": a[0] - at[0][1], "y": c[1] - (at[0][1] + at[1][1] + at[2][1])}

    problem = replace(known(bvp(x, phases, conditions, theta=theta), k), known_at=at)
    nlp = scheme.transcribe(problem, (2, 3))
    p = nlp.layout.parameters(np.array([1.0]), Mesh.uniform(2, 3).widths, jumping)
    for solver in (NewtonSolver(nlp), NewtonSolver(replace(nlp, structure=None)), IpoptSolver(nlp)):
        report = solver.solve(np.ones(nlp.unknowns), p)
        assert report.status is Status.CONVERGED
        output = nlp.output(report.w, p, jumping)
        np.testing.assert_allclose(output.at_nodes[[0, 2, 5], 0], [3, 3.75, 1.75], rtol=1e-12)
        # Points belong to the phase that begins there, the last to the last.
        np.testing.assert_allclose(output.at_nodes[[0, 2, 5], 1], [6.5, 8, 13], rtol=1e-12)
        assert output.states(0, np.array([0.5]))[0, 0] == pytest.approx(3 + 0.5 * 0.625)


@each_scheme
def test_a_field_stretches_with_an_unknown_length(scheme: Scheme) -> None:
    # x' = k x on an unknown length c up to x = e: c = 1 / integral of k over the phase.
    x, k, c = ca.SX.sym("x"), ca.SX.sym("k"), ca.SX.sym("c")
    problem = bvp(x, (Phase(k * x, c, {}),), lambda a, b: {"0": a - 1, "1": b - np.e}, c=c)
    nlp = scheme.transcribe(known(problem, k), (8,))
    _, output = solved(nlp, Mesh.uniform(8), lambda _, sigma: (1 + sigma**2)[:, None])
    assert output.constants[0] == pytest.approx(0.75, rel=4e-3)


def test_costs_and_inequalities_contain_fields() -> None:
    # Minimise the integral of (u - k)^2 / 2, x' = u, x from 0 to 1: u - k is constant.
    x, u, k = ca.SX.sym("x"), ca.SX.sym("u"), ca.SX.sym("k")
    phase = Phase(u, ca.SX(1), {}, path=u - 10 * k - 50, cost=(u - k) ** 2 / 2)
    problem = known(bvp(x, (phase,), lambda a, b: {"x0": a, "x1": b - 1}, z=u), k)
    nlp = CollocationMethod.named("gauss", 4).transcribe(problem, (6,))
    p = nlp.layout.parameters(NONE, Mesh.uniform(6).widths, wave)
    report = IpoptSolver(nlp, tolerance=1e-11).solve(np.zeros(nlp.unknowns), p)
    assert report.status is Status.CONVERGED
    gap = 1 - np.sin(3) / 3
    v, sigma, _ = nlp.output(report.w, p, wave).stages(0)
    np.testing.assert_allclose(v[:, 1], np.cos(3 * sigma) + gap, atol=1e-8)
    assert float(nlp.functions.cost(report.w, p)) == pytest.approx(gap**2 / 2, abs=1e-9)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        (None, "the problem has 1, found none; give the fields"),
        (lambda _, sigma: sigma, r"expected to have shape \(1, 1\) at 1 positions, found \(1,\)"),
        (lambda _, sigma: np.ones((len(sigma), 2)), r"shape \(1, 1\) .* found \(1, 2\)"),
        (lambda _, sigma: np.log(0 * sigma[:, None] - 1), "not finite at its relative position 0"),
    ],
)
@pytest.mark.filterwarnings("ignore:invalid value")
def test_what_is_no_field_of_the_problem_is_refused(
    fields: Callable[[int, Array], Array] | None, message: str
) -> None:
    nlp = CollocationMethod.named("gauss", 2).transcribe(growth(ca.SX.sym("k")), (3,))
    with pytest.raises(TranscriptionError, match=message):
        nlp.layout.parameters(NONE, Mesh.uniform(3).widths, fields)


def test_fields_of_a_problem_without_any_are_refused() -> None:
    nlp = CollocationMethod.named("gauss", 2).transcribe(growth(), (3,))
    with pytest.raises(TranscriptionError, match="the problem has 0, found some"):
        nlp.layout.parameters(NONE, Mesh.uniform(3).widths, wave)


@pytest.mark.parametrize("name", ["gauss 3", "rk4"])
def test_a_solution_without_its_fields_says_so_between_the_nodes(name: str) -> None:
    nlp = SCHEMES[name].transcribe(growth(ca.SX.sym("k")), (3,))
    report, output = solved(nlp, Mesh.uniform(3), wave)
    with pytest.raises(TranscriptionError, match="where a solution is read"):
        nlp.output(report.w, output.p).states(0, np.array([0.4]))


def test_without_fields_p_is_theta_and_widths() -> None:
    nlp = CollocationMethod.named("gauss", 2).transcribe(growth(), (3,))
    theta, widths = np.array([1.5, 2.5]), Mesh.uniform(3).widths
    p = nlp.layout.parameters(theta, widths)
    np.testing.assert_array_equal(p, [*theta, *widths])
    assert nlp.parameters == 3
    assert nlp.layout.theta(p).base is p and nlp.layout.at_points(p).base is p


@each_scheme
def test_the_layout_finds_what_it_packed(scheme: Scheme) -> None:
    nlp = scheme.transcribe(growth(ca.SX.sym("k")), UNEVEN.elements)
    lay, theta = nlp.layout, np.array([7.0])
    p = lay.parameters(theta, UNEVEN.widths, wave)
    assert len(p) == nlp.parameters + 1
    np.testing.assert_array_equal(lay.theta(p), theta)
    np.testing.assert_array_equal(lay.widths(p), UNEVEN.widths)
    np.testing.assert_array_equal(lay.at_points(p), [7.0, 1.0, np.cos(3.0)])
    starts = lay.starts(p)
    sigma = starts[:, None] + UNEVEN.widths[:, None] * np.array(lay.places)
    np.testing.assert_array_equal(lay.with_known(sigma, p)[..., 1], np.cos(3 * sigma))
    row = lay.with_known(starts, p)
    np.testing.assert_array_equal(row[:, 0], starts)
    np.testing.assert_array_equal(row[:, 1:], np.cos(3 * sigma))


def test_fields_at_the_points_must_fit() -> None:
    problem = growth(ca.SX.sym("k"))
    with pytest.raises(ModelError, match="2 points, expected as many symbols, found 1"):
        replace(problem, known_at=(ca.SX.sym("k"),))
    with pytest.raises(ModelError, match=r"shape \(1, 1\)"):
        replace(problem, known_at=(ca.SX.sym("k", 2), ca.SX.sym("k", 2)))


@each_scheme
def test_fields_stay_where_parameters_move(scheme: Scheme) -> None:
    # x' = theta k x along theta: x(1) = exp(theta sin(3) / 3).
    x, k, theta = ca.SX.sym("x"), ca.SX.sym("k"), ca.SX.sym("theta")
    phase = Phase(theta * k * x, ca.SX(1), {})
    problem = known(bvp(x, (phase,), lambda a, b: {"left": a - 1}, theta=theta), k)
    mesh = Mesh.uniform(12)
    nlp = scheme.transcribe(problem, mesh.elements)

    def parameters(position: float) -> Array:
        return nlp.layout.parameters(np.array([position]), mesh.widths, wave)

    line = Line(nlp.blocks, parameters, 1e-4)
    system = ExtendedSystem(line, np.array([0.0, 0.0, 1.0]), 1.4)
    guess = np.append(np.ones(nlp.unknowns), 1.0)
    report = NewtonSolver(nlp).solve(guess, parameters(1.0), system=system)
    assert report.status is Status.CONVERGED
    assert report.w[-1] == pytest.approx(1.4, abs=1e-12)
    output = nlp.output(report.w[:-1], parameters(1.4), wave)
    assert output.at_nodes[-1, 0] == pytest.approx(np.exp(1.4 * np.sin(3) / 3), rel=3e-3)


@each_scheme
def test_nothing_keeps_a_problem_alive(scheme: Scheme) -> None:
    problem = growth(ca.SX.sym("k"))
    _, output = solved(scheme.transcribe(problem, (3,)), Mesh.uniform(3), wave)
    Trajectory(problem, output).outputs(np.linspace(0, 1, 5))
    left = [weakref.ref(problem), weakref.ref(output.blocks)]
    del problem, output
    gc.collect()
    assert [reference() for reference in left] == [None, None]
