"""Data over arclengths, over fractions of the length and in tables, read as known fields."""

from dataclasses import replace
from math import log2

import casadi as ca
import numpy as np
import pytest
from analytic import bvp

from ribbonopt.arrays import Array
from ribbonopt.errors import TranscriptionError
from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers import NewtonSolver, Status
from ribbonopt.transcription import CollocationMethod, Mesh, MultipleShooting
from ribbonopt.transcription.fields import Table, of_arclength, of_fraction
from ribbonopt.transcription.known import Known


def growth(*lengths: ca.SX | float, **symbols: ca.SX) -> BoundaryValueProblem:
    """x' = k x, x(0) = 1, in phases; one condition more for an unknown length."""
    x, k = ca.SX.sym("x"), ca.SX.sym("k")
    phases = tuple(Phase(k * x, ca.SX(length), {}) for length in lengths)
    also = {"end": lambda b: b - np.e} if "c" in symbols else {}

    def conditions(*points: ca.SX) -> dict[str, ca.SX]:
        return {"left": points[0] - 1, **{name: of(points[-1]) for name, of in also.items()}}

    problem = bvp(x, phases, conditions, **symbols)
    return replace(problem, known=k, known_names=("k",))


def cosine(s: Array) -> Array:
    return np.cos(3 * s)[:, None]


def end_of(
    problem: BoundaryValueProblem, theta: Array, fields: Known, *counts: int, degree: int = 5
) -> float:
    nlp = CollocationMethod.named("gauss", degree).transcribe(problem, counts)
    p = nlp.layout.parameters(theta, Mesh.uniform(*counts).widths, fields)
    report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p)
    assert report.status is Status.CONVERGED
    return float(nlp.output(report.w, p, fields).at_nodes[-1, 0])


def test_a_field_of_arclength_runs_through_the_phases() -> None:
    theta = ca.SX.sym("theta")
    problem = growth(0.7, theta, theta=theta)
    for length in (0.3, 0.9):
        numbers = np.array([length])
        fields = of_arclength(problem, numbers, cosine)
        end = end_of(problem, numbers, fields, 5, 4)
        assert end == pytest.approx(np.exp(np.sin(3 * (0.7 + length)) / 3), rel=1e-10)
        fields = of_fraction(problem, numbers, lambda f, L=length: cosine((0.7 + L) * f))
        end = end_of(problem, numbers, fields, 5, 4)
        assert end == pytest.approx(np.exp(np.sin(3 * (0.7 + length)) / 3), rel=1e-10)


def test_lengths_that_are_unknown_are_refused() -> None:
    c = ca.SX.sym("c")
    several, one = growth(c, 1 - c, c=c), growth(c, c=c)
    for read, problem in ((of_arclength, several), (of_fraction, several), (of_arclength, one)):
        with pytest.raises(TranscriptionError, match="lengths that contain unknown constants"):
            read(problem, np.empty(0), cosine)
    # A fraction of one phase is its relative position, whatever its length: L sin(3) / 3 = 1.
    fields = of_fraction(one, np.empty(0), cosine)
    assert end_of(one, np.empty(0), fields, 20) == pytest.approx(np.e, rel=1e-10)


@pytest.mark.parametrize("scheme", ["collocation", "shooting"])
def test_fields_of_s_under_unknown_lengths_are_read_again(scheme: str) -> None:
    # x' = k up to x = 0.2, which is at sin(3 c) / 3 = 0.2, then x' = 2 k; k = cos 3s all along.
    x, c, s, k = ca.SX.sym("x"), ca.SX.sym("c"), ca.SX.sym("s"), ca.SX.sym("k", 3)
    moved = k[0] + k[1] * (s - k[2])
    phases = (Phase(moved, c, {}), Phase(2 * moved, 1 - c, {}))
    problem = bvp(x, phases, lambda a, b, _: {"left": a, "switch": b - 0.2}, c=c, s=s)
    problem = replace(problem, known=k, known_names=("k", "slope", "s"))
    method = MultipleShooting.named("rk8")
    method = CollocationMethod.named("gauss", 6) if scheme == "collocation" else method
    nlp, widths = method.transcribe(problem, (4, 4)), Mesh.uniform(4, 4).widths

    def field(s: Array) -> Array:
        return np.column_stack([np.cos(3 * s), -3 * np.sin(3 * s), s])

    w, found, exact = np.full(nlp.unknowns, 0.4), [np.array([0.4])], np.arcsin(0.6) / 3
    for _ in range(5):
        fields = of_arclength(problem, np.empty(0), field, found[-1])
        p = nlp.layout.parameters(np.empty(0), widths, fields)
        report = NewtonSolver(nlp).solve(w, p)
        assert report.status is Status.CONVERGED
        w, output = report.w, nlp.output(report.w, p, fields)
        found.append(output.constants)
    errors = [abs(float(constants[0]) - exact) for constants in found]
    assert errors[1] < 0.1 and errors[2] < 3 * errors[1] ** 2 and errors[-1] < 1e-11
    end = 0.2 + 2 * (np.sin(3) / 3 - 0.2)
    assert output.at_nodes[-1, 0] == pytest.approx(end, abs=1e-9)


@pytest.mark.parametrize("degree", [1, 3, 5])
def test_tables_have_the_order_of_their_splines(degree: int) -> None:
    where, errors = np.linspace(0, 1, 501), []
    for rows in (21, 41):
        s = np.linspace(0, 1, rows)
        table = Table(s, cosine(s), degree)
        errors.append(float(np.abs(table(where) - cosine(where)).max()))
    assert log2(errors[0] / errors[1]) > degree + 0.8


def test_a_smooth_table_is_a_smooth_field() -> None:
    problem, s = growth(1.0), np.linspace(0, 1, 21)
    fields = of_arclength(problem, np.empty(0), Table(s, cosine(s)))
    end = end_of(problem, np.empty(0), fields, 40)
    assert end == pytest.approx(np.exp(np.sin(3) / 3), rel=1e-7)


def test_rows_of_a_table_are_met() -> None:
    s = np.array([0.0, 0.1, 0.35, 0.4, 0.8, 1.0])
    rows = np.random.default_rng(0).normal(size=(6, 3))
    for degree in (1, 3):
        np.testing.assert_allclose(Table(s, rows, degree)(s), rows, atol=1e-12)
    half = Table(s, rows, 1)(np.array([0.05, 0.6]))
    np.testing.assert_allclose(half, [(rows[0] + rows[1]) / 2, (rows[3] + rows[4]) / 2], atol=1e-12)


def test_a_cubic_is_its_own_table() -> None:
    s = np.linspace(-1, 2, 7)
    table, where = Table(s, (s**3 - s)[:, None]), np.linspace(-1, 2, 50)
    np.testing.assert_allclose(table(where)[:, 0], where**3 - where, atol=1e-12)


@pytest.mark.parametrize(
    ("positions", "rows", "message"),
    [
        (np.linspace(0, 1, 5), np.ones((4, 1)), r"rows of shape \(5, nk\)"),
        (np.linspace(0, 1, 3), np.ones((3, 1)), "more of them than the degree"),
        (np.linspace(0, 1, 5), np.ones(5), r"found shape \(5,\)"),
        (np.array([0, 0.2, 0.2, 0.5, 1]), np.ones((5, 1)), "increasing"),
        (np.linspace(0, 1, 5), np.full((5, 1), np.nan), "finite"),
    ],
)
def test_tables_without_a_spline_are_refused(positions: Array, rows: Array, message: str) -> None:
    with pytest.raises(TranscriptionError, match=message):
        Table(positions, rows)


def test_a_table_is_not_read_outside() -> None:
    s = np.linspace(0.1, 1, 5)
    with pytest.raises(TranscriptionError, match=r"reaches from 0.1 to 1, expected to cover 0\.05"):
        Table(s, cosine(s))(np.array([0.5, 0.05]))


@pytest.mark.parametrize("method", ["rk8", "gauss"])
def test_shooting_reads_tables_too(method: str) -> None:
    problem, s = growth(1.0), np.linspace(0, 1, 41)
    nlp = MultipleShooting.named(method, 3, 2).transcribe(problem, (10,))
    fields = of_arclength(problem, np.empty(0), Table(s, cosine(s)))
    p = nlp.layout.parameters(np.empty(0), Mesh.uniform(10).widths, fields)
    report = NewtonSolver(nlp).solve(np.ones(nlp.unknowns), p)
    where = np.linspace(0, 1, 33)
    found = nlp.output(report.w, p, fields).states(0, where)[:, 0]
    np.testing.assert_allclose(found, np.exp(np.sin(3 * where) / 3), rtol=1e-6)
