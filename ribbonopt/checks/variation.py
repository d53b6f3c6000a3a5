"""Second variation of the energy at an equilibrium: a quadratic form along a chain of elements.

The shape is put into the problem of least energy (`ribbonopt.problem.energy`), collocated by Gauss;
its independent variables are the start x_0 and the moments z at the stages:

- dx_{e+1} = A_e dx_e + B_e dz_e, element by element;
- multipliers nu of the conditions b by least squares from grad(cost) + nu . grad(b) = 0, costates
  of the nodes by p_e = A_e^T p_{e+1} + d(cost of element e)/dx_e;
- sum of (dx, dz) . H (dx, dz), H the Hessian of the Lagrangian at a stage, where db = 0.

Moments are scaled so that the sum of their squares is an integral along the ribbon: eigenvalues are
those of the continuous problem, whatever the mesh. Where strains leap see `moving_switch`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.problem import BoundaryValueProblem, Ribbon
from ribbonopt.problem.energy import minimum
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription.buffered import Buffered, Mapped
from ribbonopt.transcription.functions import condition_functions, stage_functions

from .chain import LinearisedChain
from .chain_form import ChainForm
from .gauss_stages import GaussStages, gauss_stages
from .moving_switch import MovingSwitches

FLAT = 1e-8  # gradient below which the ribbon bears nothing
DEPENDENT = 1e-9  # of the largest singular value of the conditions
MAGNIFIED = 10.0  # error of eigenvalues over the part of the gradient that is left
POWERS = 4  # of the form: its largest eigenvalue is wanted to a factor


class Variation(NamedTuple):
    """A second variation as a quadratic form.

    `residual` is the part of the gradient of the energy that no multipliers balance; `largest`
    about the largest eigenvalue; `chain` gives states from independent variables.
    """

    form: ChainForm
    residual: float
    largest: float
    stages: GaussStages
    chain: LinearisedChain

    @property
    def error(self) -> float:
        """Error of the eigenvalues, over the largest."""
        return max(MAGNIFIED * self.residual, self.stages.error)


class Side(NamedTuple):
    """Functions of a stage under one law: slopes of rates and cost, Hessian of the Lagrangian."""

    first: Mapped
    second: Mapped

    @classmethod
    def of(cls, problem: BoundaryValueProblem) -> Side:
        """Build for a problem with a cost."""
        f = stage_functions(problem)[0]
        assert f.cost is not None  # the energy
        slopes = [ca.densify(f.jacobian), ca.densify(ca.gradient(f.cost, f.differential))]
        hessian = ca.densify(ca.triu2symm(f.lagrangian_hessian))
        return cls(
            Mapped(ca.Function("first", list(f.inputs), slopes)),
            Mapped(ca.Function("second", [*f.inputs, f.weights], [hessian])),
        )


@dataclass(frozen=True, eq=False)
class Energy:
    """The problem of least energy of one structure of scenes, as functions of stages and ends.

    `sides` are those of a law that switches, by sign; of a smooth law there is one, 0. `conditions`
    gives b and db, `bent` the Hessian of their weighted sum.
    """

    ribbon: Ribbon
    sides: Mapping[int, Side]
    switches: MovingSwitches | None
    conditions: Callable[..., list[Array]]
    bent: Callable[..., list[Array]]

    @classmethod
    def of(cls, ribbon: Ribbon) -> Energy:
        """Build for the mechanics of a structure of scenes, stated as a minimum of the energy."""
        law, switches = ribbon.law, None
        # Where strains fade away nothing leaps, and the place needs no variation of its own.
        smooth = law.smooth or law.fades
        problems = {0: minimum(ribbon)} if smooth else _sides(ribbon)
        if not smooth:
            switches = MovingSwitches.of(ribbon, problems)
        ends = condition_functions(next(iter(problems.values())))
        bent = ca.densify(ca.triu2symm(ends.lagrangian_hessian))
        return cls(
            ribbon,
            {kind: Side.of(problem) for kind, problem in problems.items()},
            switches,
            ends.buffered_dense,
            Buffered(ca.Function("bent", [*ends.inputs, ends.multipliers], [bent])),
        )

    def variation(self, solution: Solution, theta: Array, *, again: bool = False) -> Variation:
        """Return the second variation at a solution, which has phases if its law needs them.

        `again` on another mesh: see `gauss_stages`.
        """
        at = gauss_stages(solution, self.ribbon, theta, again=again)
        return self.at_stages(solution, at, theta, solution.trajectory.length)

    def at_stages(
        self, solution: Solution, at: GaussStages, theta: Array, length: float
    ) -> Variation:
        """Return the second variation at stages of a solution, or of more that it is a piece of.

        `length` is that of all of it.
        """
        none = np.empty(0)
        N, K, nx = len(at.widths), at.tableau.degree, at.x.shape[1]
        v, kinds = np.hstack([at.x, at.z]), self._kinds(solution, at)
        nv = v.shape[1]
        J, slopes = self._by_side("first", kinds, (v, at.places), theta)
        J = J.reshape(N, K, nv, nx).swapaxes(2, 3)  # CasADi stores columns first
        moved = None
        if self.switches is not None and len(at.firsts):
            moved = self.switches.at(solution, at, theta)
        jumps, prices = (None, None) if moved is None else (moved.jumps, moved.prices)
        slopes = slopes.reshape(N, K, nv)
        chain = LinearisedChain(J, slopes, at.widths, at.tableau, length, jumps, prices)
        b, B = self.conditions(at.ends, none, theta)
        B = B.reshape(2 * nx, len(b)).T
        left, singular, right = np.linalg.svd(B @ chain.ends, full_matrices=False)
        kept = singular > DEPENDENT * singular[0]
        left, singular, right = left[:, kept], singular[kept], right[kept]
        g = chain.gradient
        multipliers = -left @ (right @ g / singular)
        residual = np.linalg.norm(g - right @ g @ right) / max(float(np.linalg.norm(g)), FLAT)
        costates = chain.costates(B[:, nx:].T @ multipliers)
        weights = chain.weights(costates).reshape(N * K, -1)
        (H,) = self._by_side("second", kinds, (v, at.places), theta, weights)
        H = H.reshape(N, K, nv, nv)
        Q, mass = chain.hessians(H), np.ones(chain.step.shape[2] - nx)
        if moved is not None:
            mass[-1] = 0.0
            moved.add_to(Q, costates)
        (bent,) = self.bent(at.ends, none, theta, multipliers)
        C = (left / singular).T @ B
        A, own = chain.step[..., :nx], chain.step[..., nx:]
        form = ChainForm(Q, A, own, bent.reshape(2 * nx, 2 * nx), C, mass)
        stiff = float(np.abs(np.linalg.eigvalsh(H[..., nx:, nx:])).max()) / length
        largest = max(stiff, _largest(form, right))
        return Variation(form, float(residual), largest, at, chain)

    def _kinds(self, solution: Solution, at: GaussStages) -> NDArray[np.intp]:
        """Side of the law (N K,) at every stage: of its phase, or by the sign of the switch."""
        if self.switches is None:
            return np.zeros(len(at.places), np.intp)
        if solution.sheets:
            return np.array(solution.sheets)[solution.trajectory.phase_of(at.places)]
        return np.where(at.switching >= 0, 1, -1)

    def _by_side(
        self,
        name: str,
        kinds: NDArray[np.intp],
        along: tuple[Array, Array],
        theta: Array,
        *more: Array,
    ) -> list[Array]:
        """Values of a function of `Side` at all stages, each under the law of its side."""
        results: list[Array] = []
        for kind, side in self.sides.items():
            rows = kinds == kind
            if not rows.any():
                continue
            v, places = (part[rows] for part in along)
            rest = [part[rows] for part in more]
            found = getattr(side, name)(v, np.empty(0), theta, places, *rest)
            for i, values in enumerate(found):
                part = values.reshape(len(v), -1)
                if i == len(results):
                    results.append(np.empty((len(kinds), part.shape[1])))
                results[i][rows] = part
        return results


def _sides(ribbon: Ribbon) -> dict[int, BoundaryValueProblem]:
    """Return the problems of least energy of the laws of both sides of a switch."""
    laws: dict[int, ConstitutiveLaw] = {kind: ribbon.law.branch(kind) for kind in (1, -1)}
    return {kind: minimum(replace(ribbon, law=law, _kept={})) for kind, law in laws.items()}


def _largest(form: ChainForm, right: Array) -> float:
    """About the largest eigenvalue, by a few powers, of what keeps the conditions.

    `right` are the conditions by all independent variables, orthonormal.
    """
    N, nx, m = form.B.shape
    weight = np.concatenate([np.ones(nx), np.tile(form.mass, N)])
    right = right * weight
    v = weight * np.cos(np.arange(len(weight)) ** 2)
    own = v[nx:].reshape(N, m)
    for _ in range(POWERS):  # layers, where the ribbon bends easily, may be a stage wide
        own = form.mass * (form.Q[:, nx:, nx:] @ own[..., None])[..., 0]
        own /= max(float(np.abs(own).max()), 1e-300)
    v[nx:] += own.ravel() * np.linalg.norm(v) / np.linalg.norm(own)
    found = 0.0
    for _ in range(POWERS):
        v -= right.T @ (right @ v)
        v /= np.linalg.norm(v)
        start, own = form.times(v[:nx], v[nx:].reshape(N, m))
        v = weight * np.concatenate([start, own.ravel()])
        found = float(np.linalg.norm(v - right.T @ (right @ v)))
    return found
