"""Stability: negative directions of the second variation of the energy, from any equilibrium.

Of all shapes that satisfy the conditions on positions and directors, an equilibrium is one where
the energy, less the work of dead forces, is stationary; it is stable where it is a minimum. The
shape is put into the problem of least energy (`ribbonopt.problem.energy`), collocated by Gauss, all
of it but the start x_0 and the moments z at the stages eliminated:

- dx_{e+1} = A_e dx_e + B_e dz_e, element by element, then along the ribbon;
- multipliers nu of the conditions b by least squares from grad(cost) + nu . grad(b) = 0, costates
  of the nodes by p_e = A_e^T p_{e+1} + d(cost of element e)/dx_e;
- sum of (dx, dz) . H (dx, dz), H the Hessian of the Lagrangian at a stage, where db = 0.

Moments are scaled so that the sum of their squares is an integral along the ribbon: eigenvalues are
those of the continuous problem, whatever the mesh. Of a piece of a loop only disturbances with its
symmetry are judged. Shapes: N elements, K stages, n = nx + nz K N independent
variables [x_0, all z].
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.problem import BoundaryValueProblem, Posed, Ribbon
from ribbonopt.problem.energy import minimum, refusal
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import gauss
from ribbonopt.transcription.buffered import Buffered, Mapped
from ribbonopt.transcription.functions import condition_functions, stage_functions

from .chain import LinearisedChain
from .zero_moment import unbent_share

STAGES = 100  # in all; more only on fine meshes, which have four in each element
LEAST_ELEMENTS, HIGHEST_DEGREE = 10, 8
STATIONARY = 1e-3  # largest part of the gradient that no multipliers balance
FLAT = 1e-8  # gradient below which the ribbon bears nothing
# Neutral directions (a loop that slides along itself) have eigenvalues of the order of the error.
NEUTRAL, ROUNDING = 10.0, 1e-9  # times the residual, at least; of the largest eigenvalue
DEPENDENT = 1e-9  # of the largest singular value of the conditions


@dataclass(frozen=True, eq=False)
class SecondVariation:
    """Second variation of the energy on the directions that keep the conditions.

    `eigenvalues` (k,) increase; `residual` is the part of the gradient that no multipliers balance,
    the error of the discretisation. Units Dw = L = 1.
    """

    eigenvalues: Array
    residual: float

    @property
    def negative(self) -> int:
        """Number of clearly negative eigenvalues; neutral directions are not counted."""
        neutral = max(NEUTRAL * self.residual, ROUNDING) * np.abs(self.eigenvalues).max()
        return int((self.eigenvalues < -neutral).sum())


def negative_directions(solution: Solution) -> int | None:
    """Negative directions of the energy, 0 where stable; None where `why_not` says why."""
    found = second_variation(solution)
    return None if isinstance(found, str) else found.negative


def why_not(solution: Solution) -> str:
    """Say why there is no second variation; empty where there is one."""
    found = second_variation(solution)
    return found if isinstance(found, str) else ""


def second_variation(solution: Solution) -> SecondVariation | str:
    """Return the second variation of the energy or, in words, why there is none.

    What is built for it is kept with the equations that the solution was found by.
    """
    if not solution.status.converged:
        return "this is no equilibrium"
    known = solution.trajectory.found
    if SecondVariation not in known:
        known[SecondVariation] = _judged(solution)
    found: SecondVariation | str = known[SecondVariation]
    return found


def _judged(solution: Solution) -> SecondVariation | str:
    name, law = solution.scene.law.type, capabilities(solution.scene.law)
    if not law.variational:
        return f"the law {name} has no energy"
    if not law.smooth:
        return f"the energy of the law {name} has no second derivatives"
    if unbent_share(solution, law):
        return f"the energy of the law {name} has no second derivatives where m2 = m3 = 0"
    # Only laws with a kink have phases, and none of them comes so far.
    posed = solution.posed.under(formulation="energy", states="reduced")
    energy = _energy_of(solution, posed)
    # With the conditions of this very scene: whether they are zero decides.
    refused = refusal(replace(energy.ribbon, conditions=posed.conditions), posed)
    if refused is not None:
        return refused.reason
    found = energy.at(solution, posed.values)
    if found.residual < STATIONARY:
        return found
    return (
        f"the energy is not stationary (the part {found.residual:.1e} of its gradient is left): "
        "loads that are prescribed do work, or the mesh is too coarse"
    )


def _energy_of(solution: Solution, posed: Posed) -> _Energy:
    """Return the problem of least energy of a solution's structure, built once for its problem."""
    store = solution.problem.kept(_energies)
    if not store:
        store.append(_Energy.of(posed))
    return store[0]


def _energies(problem: BoundaryValueProblem) -> list[_Energy]:
    """Return the place where a problem keeps what is built of its energy."""
    return []


@dataclass(frozen=True, eq=False)
class _Energy:
    """The problem of least energy of one structure of scenes, as functions of stages and ends.

    `first` gives the Jacobian of the rates and the gradient of the cost, `conditions` b and db;
    `second` and `bent` the Hessians of the Lagrangian, whose weights are their last input.
    """

    ribbon: Ribbon
    first: Mapped
    second: Mapped
    conditions: Buffered
    bent: Buffered

    @classmethod
    def of(cls, posed: Posed) -> _Energy:
        """Build for the structure of a scene."""
        ribbon = Ribbon.of(posed)
        problem = minimum(ribbon)
        f, ends = stage_functions(problem)[0], condition_functions(problem)
        assert f.cost is not None  # the energy
        slopes = [ca.densify(f.jacobian), ca.densify(ca.gradient(f.cost, f.differential))]
        hessians = [ca.densify(ca.triu2symm(g.lagrangian_hessian)) for g in (f, ends)]
        return cls(
            ribbon,
            Mapped(ca.Function("first", list(f.inputs), slopes)),
            Mapped(ca.Function("second", [*f.inputs, f.weights], hessians[:1])),
            ends.buffered_dense,
            Buffered(ca.Function("bent", [*ends.inputs, ends.multipliers], hessians[1:])),
        )

    def at(self, solution: Solution, theta: Array) -> SecondVariation:
        """Second variation at the shape of a solution, on its own elements."""
        widths = solution.dense.blocks.widths(solution.dense.p)
        parts = -(-LEAST_ELEMENTS // len(widths))
        widths = np.repeat(widths / parts, parts)
        degree = min(solution.dense.blocks.degree, max(4, STAGES // len(widths)), HIGHEST_DEGREE)
        tableau, none = gauss(degree), np.empty(0)
        fractions = (np.cumsum(widths) - widths)[:, None] + widths[:, None] * tableau.nodes
        points, v = self._sampled(solution, fractions)
        nx, nv = points.shape[1], v.shape[2]
        inputs = v, none, theta, fractions.ravel()
        J, slopes = self.first(*inputs)
        J = J.reshape(*v.shape, nx).swapaxes(2, 3)  # CasADi stores columns first
        chain = LinearisedChain(J, slopes.reshape(v.shape), widths, tableau)
        b, B = self.conditions(points, none, theta)
        B = B.reshape(2 * nx, len(b)).T
        left, singular, right = np.linalg.svd(B @ chain.ends, full_matrices=False)
        kept = singular > DEPENDENT * singular[0]
        left, singular, right = left[:, kept], singular[kept], right[kept]
        g = chain.gradient
        multipliers = -left @ (right @ g / singular)
        residual = np.linalg.norm(g - right @ g @ right) / max(float(np.linalg.norm(g)), FLAT)
        weights = chain.weights(B[:, nx:].T @ multipliers)
        (H,) = self.second(*inputs, weights)
        (bent,) = self.bent(points, none, theta, multipliers)
        hessian = chain.hessian(H.reshape(*v.shape, nv))
        hessian += chain.ends.T @ bent.reshape(2 * nx, 2 * nx) @ chain.ends
        free = np.linalg.qr(right.T, mode="complete")[0][:, len(right) :]
        return SecondVariation(np.linalg.eigvalsh(free.T @ hessian @ free), float(residual))

    def _sampled(self, solution: Solution, fractions: Array) -> tuple[Array, Array]:
        """States (2, nx) at the ends, and unknowns v (N, K, nv) at the stages."""
        fields = solution.fields(np.concatenate([[0.0], fractions.ravel(), [1.0]]))
        # Any point of reference will do: it is for constants, which the energy does without.
        x, _ = self.ribbon.model.pack(fields, fields.r[0])
        free = list(self.ribbon.law.components)
        z = np.einsum("ki,kij->kj", fields.m, fields.frames)[:, free]
        v = np.hstack([x, z])[1:-1]
        return x[[0, -1]], v.reshape(*fractions.shape, -1)
