"""A problem that uses every part of the contract, to be differentiated and never solved."""

from dataclasses import replace

import casadi as ca
import numpy as np
from analytic import bvp

from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.transcription import NLP, Mesh

Array = np.ndarray


def nonlinear(phases: int, minimised: bool = False) -> BoundaryValueProblem:
    """Return a problem that uses every part of the contract; not meant to be solved.

    States, algebraic variables, constants, parameters, s, unknown lengths, conditions at all
    points; with `minimised` also a cost and a path inequality.
    """
    x, z = ca.SX.sym("x", 2), ca.SX.sym("z", 2)
    c, theta, s = ca.SX.sym("c", 2), ca.SX.sym("theta", 2), ca.SX.sym("s")
    parts = []
    for i in range(phases):
        f = ca.vertcat(x[1] * z[0] + ca.sin(s) * c[0], ca.cos(x[0]) * c[1] - theta[0] * x[1] ** 2)
        g = ca.vertcat(z[0] ** 3 + z[0] + x[0] * c[1], z[1] - ca.exp(0.1 * x[1]) * theta[1])
        # Mild dynamics: elements far too wide for them have nearly singular stages.
        phase = Phase(f * (1 + i) / 4, 0.5 + c[0] ** 2 + i, {}, algebraic=g)
        if minimised:
            path = x[0] * z[1] - c[0] * theta[1] - 5
            cost = z[0] ** 2 * x[1] + ca.sin(z[1] * c[1]) * s
            phase = replace(phase, algebraic=g[:1], path=path, cost=cost)
        parts.append(phase)

    def conditions(*points: ca.SX) -> dict[str, ca.SX]:
        last = points[-1]
        return {
            "start": points[0][0] * points[0][1] - theta[0],
            "middle": points[len(points) // 2][0] ** 2 + c[1],
            "end": ca.sin(last[1]) * c[0] - 0.1,
            "loop": last[0] - points[0][0] * c[1],
        }

    return bvp(x, tuple(parts), conditions, z=z, c=c, theta=theta, s=s)


def random_data(nlp: NLP, elements: tuple[int, ...], seed: int = 0) -> tuple[Array, Array]:
    """Return unknowns, and parameters with a mesh of unequal widths."""
    rng = np.random.default_rng(seed)
    widths = [rng.uniform(0.5, 1.5, n) for n in elements]
    mesh = Mesh(tuple(w / w.sum() for w in widths))
    return rng.uniform(-1, 1, nlp.unknowns), np.concatenate([[0.3, 0.8], mesh.widths])


def of_first_node(J: Array, nx: int, first: int) -> Array:
    """Return the conditions, rows from the first, by the first node and constants alone."""
    inner = slice(nx, nx + first)
    outer = np.delete(np.arange(len(J)), np.arange(nx, nx + first))
    follow = np.linalg.solve(J[:first, inner], J[:first, outer])
    return np.asarray(J[first:, outer] - J[first:, inner] @ follow)
