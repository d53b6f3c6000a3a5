"""Boundary-value problems that are not ribbons, with their solutions in closed form."""

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers import NewtonSolver, SolveReport, Status
from ribbonopt.transcription import NLP, CollocationMethod, Mesh
from ribbonopt.transcription.collocation.output import DenseOutput

Array = np.ndarray


def bvp(
    x: ca.SX,
    phases: tuple[Phase, ...],
    conditions: Callable[..., Mapping[str, ca.SX]],
    *,
    z: ca.SX | None = None,
    c: ca.SX | None = None,
    theta: ca.SX | None = None,
    s: ca.SX | None = None,
) -> BoundaryValueProblem:
    """Return a problem on s >= 0; `conditions` takes the states at all points."""
    points = tuple(ca.SX.sym(f"x{i}", x.numel()) for i in range(len(phases) + 1))
    c = ca.SX(0, 1) if c is None else c
    theta = ca.SX(0, 1) if theta is None else theta
    return BoundaryValueProblem(
        position=ca.SX.sym("s") if s is None else s,
        state=x,
        algebraic=ca.SX(0, 1) if z is None else z,
        constants=c,
        parameters=theta,
        start=ca.SX(0),
        phases=phases,
        points=points,
        conditions=conditions(*points),
        state_names=tuple(f"x{i}" for i in range(x.numel())),
        constant_names=tuple(f"c{i}" for i in range(c.numel())),
        parameter_names=tuple(f"theta{i}" for i in range(theta.numel())),
    )


def layers(rate: float) -> BoundaryValueProblem:
    """x'' = rate^2 x, x(0) = x(1) = 1, with states x and x' / rate."""
    x = ca.SX.sym("x", 2)
    phase = Phase(rate * ca.vertcat(x[1], x[0]), ca.SX(1), {})
    return bvp(x, (phase,), lambda a, b: {"left": a[0] - 1, "right": b[0] - 1})


def layers_exact(rate: float, s: Array) -> Array:
    """Return (k, 2) states."""
    left, right, both = np.exp(-rate * s), np.exp(-rate * (1 - s)), 1 + np.exp(-rate)
    return np.stack([left + right, right - left], axis=1) / both


def rational() -> BoundaryValueProblem:
    """x'' = 3 x^2 / 2, x(0) = 4, x(1) = 1: x = 4 / (1 + s)^2."""
    x = ca.SX.sym("x", 2)
    phase = Phase(ca.vertcat(x[1], 1.5 * x[0] ** 2), ca.SX(1), {})
    return bvp(x, (phase,), lambda a, b: {"left": a[0] - 4, "right": b[0] - 1})


def rational_exact(s: Array) -> Array:
    """Return (k, 2) states."""
    return np.stack([4 / (1 + s) ** 2, -8 / (1 + s) ** 3], axis=1)


def implicit() -> BoundaryValueProblem:
    """Index-1 DAE x' = z, 0 = z^3 + z - x^3 - x, x(0) = 1: x = z = exp(s)."""
    x, z = ca.SX.sym("x"), ca.SX.sym("z")
    phase = Phase(z, ca.SX(1), {}, algebraic=z**3 + z - x**3 - x)
    return bvp(x, (phase,), lambda a, b: {"left": a - 1}, z=z)


def switching() -> BoundaryValueProblem:
    """x'' = -x until x = 1/2, at s = pi/6; then x'' = -4 x up to s = 1. x(0) = 0, x'(0) = 1."""
    x, c = ca.SX.sym("x", 2), ca.SX.sym("c")
    first = Phase(ca.vertcat(x[1], -x[0]), c, {})
    second = Phase(ca.vertcat(x[1], -4 * x[0]), 1 - c, {})

    def conditions(start: ca.SX, switch: ca.SX, _: ca.SX) -> dict[str, ca.SX]:
        return {"x": start[0], "v": start[1] - 1, "switch": switch[0] - 0.5}

    return bvp(x, (first, second), conditions, c=c)


def double_integrator(limit: float | None = None) -> BoundaryValueProblem:
    """Minimise the integral of u^2 / 2, x'' = u; from rest to rest, or x <= limit on the way."""
    x, u = ca.SX.sym("x", 2), ca.SX.sym("u")
    path = ca.SX(0, 1) if limit is None else x[0] - limit
    phase = Phase(ca.vertcat(x[1], u), ca.SX(1), {}, path=path, cost=u**2 / 2)

    def rest_to_rest(a: ca.SX, b: ca.SX) -> dict[str, ca.SX]:
        return {"x0": a[0], "v0": a[1], "x1": b[0] - 1, "v1": b[1]}

    def thrown(a: ca.SX, b: ca.SX) -> dict[str, ca.SX]:
        return {"x0": a[0], "v0": a[1] - 1, "x1": b[0], "v1": b[1] + 1}

    return bvp(x, (phase,), rest_to_rest if limit is None else thrown, z=u)


def transcribed(
    problem: BoundaryValueProblem, scheme: str, degree: int, *elements: int
) -> tuple[NLP, Array]:
    """Return the NLP on a uniform mesh and its parameters (theta must be empty)."""
    nlp = CollocationMethod.named(scheme, degree).transcribe(problem, elements)
    return nlp, Mesh.uniform(*elements).widths


def by_newton(
    problem: BoundaryValueProblem, scheme: str, degree: int, *elements: int, start: float = 1.0
) -> tuple[SolveReport, DenseOutput]:
    """Solve from constant unknowns."""
    nlp, p = transcribed(problem, scheme, degree, *elements)
    report = NewtonSolver(nlp).solve(np.full(nlp.unknowns, start), p)
    assert report.status is Status.CONVERGED, report.status
    return report, DenseOutput(nlp.blocks, report.w, p)
