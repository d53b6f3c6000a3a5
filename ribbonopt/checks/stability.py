"""Stability: negative directions of the second variation of the energy, from any equilibrium.

Of all shapes that satisfy the conditions on positions and directors, an equilibrium is one where
the energy, less the work of dead forces, is stationary; it is stable where it is a minimum. The
shape is put into the problem of least energy (`ribbonopt.problem.energy`), collocated by Gauss, all
of it but the start x_0 and the moments z = (m2, m3) at the stages eliminated:

- dx_{e+1} = A_e dx_e + B_e dz_e, element by element, then along the ribbon;
- multipliers nu of the conditions b by least squares from grad(cost) + nu . grad(b) = 0, costates
  of the nodes by p_e = A_e^T p_{e+1} + d(cost of element e)/dx_e;
- sum of (dx, dz) . H (dx, dz), H the Hessian of the Lagrangian at a stage, where db = 0.

Moments are scaled so that the sum of their squares is an integral along the ribbon: eigenvalues are
those of the continuous problem, whatever the mesh. Of a piece of a loop only disturbances with its
symmetry are judged. Shapes: N elements, K stages, n = 7 + 2 K N independent variables [x_0, all z].
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from functools import lru_cache

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.ends.boundary import conditions_of
from ribbonopt.mechanics.laws.catalogue import LAWS
from ribbonopt.problem import Ribbon, ribbon_of, theta_of
from ribbonopt.problem.energy import minimum, refusal
from ribbonopt.scene import Scene
from ribbonopt.scene.units import in_special_units
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Tableau, gauss
from ribbonopt.transcription.buffered import Buffered, Mapped
from ribbonopt.transcription.functions import condition_functions, stage_functions

NX, NZ = 7, 2
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


@lru_cache(maxsize=2)
def second_variation(solution: Solution) -> SecondVariation | str:
    """Return the second variation of the energy or, in words, why there is none."""
    if not solution.status.converged:
        return "this is no equilibrium"
    scene = in_special_units(solution.scene)
    law = LAWS[scene.law.type]
    if not law.variational:
        return f"the law {scene.law.type} has no energy"
    if not law.smooth:
        return f"the energy of the law {scene.law.type} has no second derivatives"
    # Only laws with a kink have phases, and none of them comes so far.
    scene = replace(scene, formulation="energy", states="reduced")
    theta, conditions = theta_of(scene), conditions_of(scene)
    kinds = tuple(type(condition) for condition in conditions)
    energy = _built(_Structure((scene.law.type, *theta, *kinds, *scene.boundary.also), scene))
    # With the conditions of this very scene: whether they are zero decides.
    refused = refusal(replace(energy.ribbon, conditions=conditions), scene)
    if refused is not None:
        return refused.reason
    found = energy.at(solution, np.array(list(theta.values())))
    if found.residual < STATIONARY:
        return found
    return (
        f"the energy is not stationary (the part {found.residual:.1e} of its gradient is left): "
        "loads that are prescribed do work, or the mesh is too coarse"
    )


@dataclass(frozen=True)
class _Structure:
    """What the problem of least energy depends on, and a scene that has it."""

    key: Hashable
    scene: Scene = field(compare=False)


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

    def at(self, solution: Solution, theta: Array) -> SecondVariation:
        """Second variation at the shape of a solution, on its own elements."""
        widths = solution.dense.blocks.widths(solution.dense.p)
        parts = -(-LEAST_ELEMENTS // len(widths))
        widths = np.repeat(widths / parts, parts)
        degree = min(solution.dense.blocks.degree, max(4, STAGES // len(widths)), HIGHEST_DEGREE)
        tableau, count, none = gauss(degree), degree * len(widths), np.empty(0)
        points, v = self._sampled(solution, widths, tableau)
        inputs = v, none, theta, np.zeros(count)
        J, slopes = self.first(*inputs)
        J = J.reshape(*v.shape, NX).swapaxes(2, 3)  # CasADi stores columns first
        chain = _LinearisedChain(J, slopes.reshape(v.shape), widths, tableau)
        b, B = self.conditions(points, none, theta)
        B = B.reshape(2 * NX, len(b)).T
        left, singular, right = np.linalg.svd(B @ chain.ends, full_matrices=False)
        kept = singular > DEPENDENT * singular[0]
        left, singular, right = left[:, kept], singular[kept], right[kept]
        g = chain.gradient
        multipliers = -left @ (right @ g / singular)
        residual = np.linalg.norm(g - right @ g @ right) / max(float(np.linalg.norm(g)), FLAT)
        weights = chain.weights(B[:, NX:].T @ multipliers)
        (H,) = self.second(*inputs, weights)
        (bent,) = self.bent(points, none, theta, multipliers)
        hessian = chain.hessian(H.reshape(*v.shape, NX + NZ))
        hessian += chain.ends.T @ bent.reshape(2 * NX, 2 * NX) @ chain.ends
        free = np.linalg.qr(right.T, mode="complete")[0][:, len(right) :]
        return SecondVariation(np.linalg.eigvalsh(free.T @ hessian @ free), float(residual))

    def _sampled(self, solution: Solution, widths: Array, tableau: Tableau) -> tuple[Array, Array]:
        """States (2, 7) at the ends, and unknowns v (N, K, 9) at the stages."""
        starts = np.cumsum(widths) - widths
        fractions = (starts[:, None] + widths[:, None] * tableau.nodes).ravel()
        fields = solution.fields(np.concatenate([[0.0], fractions, [1.0]]))
        # Any point of reference will do: it is for constants, which the energy does without.
        x, _ = self.ribbon.model.pack(fields, fields.r[0])
        z = np.einsum("ki,kij->kj", fields.m, fields.frames)[:, 1:]
        return x[[0, -1]], np.hstack([x, z])[1:-1].reshape(len(widths), -1, NX + NZ)


@lru_cache(maxsize=8)
def _built(structure: _Structure) -> _Energy:
    ribbon = ribbon_of(structure.scene)
    problem = minimum(ribbon)
    f, ends = stage_functions(problem)[0], condition_functions(problem)
    assert f.cost is not None  # the energy
    slopes = [ca.densify(f.jacobian), ca.densify(ca.gradient(f.cost, f.differential))]
    hessians = [ca.densify(ca.triu2symm(g.lagrangian_hessian)) for g in (f, ends)]
    return _Energy(
        ribbon,
        Mapped(ca.Function("first", list(f.inputs), slopes)),
        Mapped(ca.Function("second", [*f.inputs, f.weights], hessians[:1])),
        ends.buffered_dense,
        Buffered(ca.Function("bent", [*ends.inputs, ends.multipliers], hessians[1:])),
    )


class _LinearisedChain:
    """Elements one after another, linearised: all states follow from x_0 and the moments.

    `J` (N, K, 7, 9) are the derivatives of the rates at the stages, `slopes` (N, K, 9) of the cost.
    """

    def __init__(self, J: Array, slopes: Array, widths: Array, tableau: Tableau) -> None:
        (N, K), size = slopes.shape[:2], NX + NZ * slopes.shape[1]
        self.J, self.slopes = J, slopes
        self.integral = widths[:, None, None] * tableau.matrix
        self.weight = widths[:, None] * tableau.weights
        M = -np.einsum("eij,ejxy->eixjy", self.integral, J[..., :NX]).reshape(N, K * NX, K * NX)
        self.inverse = np.linalg.inv(M + np.eye(K * NX))
        # Stages [x; z] (N, K, 9, 7 + 2 K) from the variables of their element.
        stages = np.zeros((N, K, NX + NZ, size))
        scale = 1 / np.sqrt(self.weight)[..., None, None]
        for j in range(K):
            stages[:, j, NX:, NX + NZ * j : NX + NZ * (j + 1)] = scale[:, j] * np.eye(NZ)
        sides = np.einsum("eij,ejxc->eixjc", self.integral, scale * J[..., NX:])
        starts = np.broadcast_to(np.eye(NX), (N, K, NX, NX))
        sides = np.concatenate([starts, sides.reshape(N, K, NX, -1)], axis=3)
        stages[:, :, :NX] = (self.inverse @ sides.reshape(N, K * NX, -1)).reshape(N, K, NX, -1)
        self.stages = stages
        self.step = np.einsum("ej,ejxs->exs", self.weight, J @ stages)
        self.step[:, :, :NX] += np.eye(NX)
        self.cost = ((self.weight[..., None] * slopes)[:, :, None] @ stages)[:, :, 0].sum(axis=1)
        # Nodes (N + 1, 7, n) from the independent variables.
        self.nodes = np.zeros((N + 1, NX, NX + NZ * K * N))
        self.nodes[0, :, :NX] = np.eye(NX)
        for e, step in enumerate(self.step):
            a, b = NX + NZ * K * e, NX + NZ * K * (e + 1)
            self.nodes[e + 1, :, :a] = step[:, :NX] @ self.nodes[e, :, :a]
            self.nodes[e + 1, :, a:b] = step[:, NX:]
        self.ends = np.vstack([self.nodes[0], self.nodes[-1]])
        self.gradient = np.tensordot(self.cost[:, :NX], self.nodes[:-1], 2)
        self.gradient[NX:] += self.cost[:, NX:].ravel()

    def weights(self, last: Array) -> Array:
        """Return d(Lagrangian)/d(rates, cost) (N, K, 8), from the costate (7,) at the end."""
        after = np.empty((len(self.step), 1, NX))
        for e in reversed(range(len(after))):
            after[e, 0] = last
            last = self.cost[e, :NX] + last @ self.step[e, :, :NX]
        change = self.slopes[..., :NX] + (after[:, :, None] @ self.J[..., :NX])[:, :, 0]
        change *= self.weight[..., None]
        change = (change.reshape(len(after), 1, -1) @ self.inverse).reshape(change.shape)
        rates = self.weight[..., None] * after + self.integral.swapaxes(1, 2) @ change
        return np.concatenate([rates, self.weight[..., None]], axis=2)

    def hessian(self, H: Array) -> Array:
        """Hessian (n, n) in the independent variables, from those of the stages (N, K, 9, 9)."""
        N, n = len(H), self.nodes.shape[2]
        V = self.stages.reshape(N, -1, self.stages.shape[3])
        Q = V.swapaxes(1, 2) @ (H @ self.stages).reshape(V.shape)
        nodes = self.nodes[:-1]
        along = Q[:, :, :NX] @ nodes
        result: Array = nodes.reshape(-1, n).T @ along[:, :NX].reshape(-1, n)
        result[NX:] += along[:, NX:].reshape(-1, n)
        result[:, NX:] += along[:, NX:].reshape(-1, n).T
        own = np.zeros((N, V.shape[2] - NX, N, V.shape[2] - NX))
        own[np.arange(N), :, np.arange(N)] = Q[:, NX:, NX:]
        result[NX:, NX:] += own.reshape(n - NX, n - NX)
        return result
