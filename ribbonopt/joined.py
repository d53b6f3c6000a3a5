"""A solution of several phases read as one: positions relative to the whole ribbon."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Output


Phases = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Joined:
    """The phases of an output, one after another; fractions (k,) run from 0 to 1."""

    problem: BoundaryValueProblem
    dense: Output

    @cached_property
    def ends(self) -> Array:
        """Fractions (P + 1,) at which the phases begin and end."""
        if len(self.problem.phases) == 1:
            return np.array([0.0, 1.0])
        problem = self.problem
        lengths = ca.vertcat(*(phase.length for phase in problem.phases))
        function = ca.Function("lengths", [problem.constants, problem.parameters], [lengths])
        found = np.array(function(self.dense.constants, self.dense.theta)).ravel()
        ends = np.concatenate([[0.0], np.cumsum(found) / found.sum()])
        ends[-1] = 1.0
        return ends

    @property
    def nodes(self) -> Array:
        """Fractions (N + 1,) of all nodes."""
        parts = [
            a + (b - a) * self.dense.nodes(i)
            for i, (a, b) in enumerate(zip(self.ends[:-1], self.ends[1:], strict=True))
        ]
        return np.concatenate([*(part[:-1] for part in parts[:-1]), parts[-1]])

    def phase_of(self, fraction: Array) -> Phases:
        """Phase (k,) of each fraction; where two meet, the later one."""
        found = np.searchsorted(self.ends, fraction, side="right") - 1
        return np.clip(found, 0, len(self.problem.phases) - 1)

    def values(self, fraction: Array) -> tuple[Array, Array]:
        """States (k, nx) and algebraic variables (k, nz) at fractions."""
        if len(self.problem.phases) == 1:
            return self.dense.states(0, fraction), self.dense.algebraic(0, fraction)
        phase = self.phase_of(fraction)
        x = np.empty((len(fraction), self.problem.state.numel()))
        z = np.empty((len(fraction), self.problem.algebraic.numel()))
        for i in range(len(self.problem.phases)):
            rows = phase == i
            if not rows.any():
                continue
            a, b = self.ends[i], self.ends[i + 1]
            local = np.clip((fraction[rows] - a) / (b - a), 0.0, 1.0)
            x[rows] = self.dense.states(i, local)
            z[rows] = self.dense.algebraic(i, local)
        return x, z

    @cached_property
    def stages(self) -> tuple[Array, Array, Array, Phases]:
        """Stage values v (k, nv), fractions (k,), quadrature weights (k,), phases (k,)."""
        parts = []
        for i, (a, b) in enumerate(zip(self.ends[:-1], self.ends[1:], strict=True)):
            v, sigma, weights = self.dense.stages(i)
            phase = np.full(len(sigma), i)
            parts.append((v, a + (b - a) * sigma, (b - a) * weights, phase))
        v, sigma, weights, phases = (np.concatenate(part) for part in zip(*parts, strict=True))
        return v, sigma, weights, phases

    def named(self, x: Array, z: Array, s: Array, phase: Phases) -> dict[str, Array]:
        """Named outputs at states (k, nx), algebraic (k, nz), arclengths and phases (k,)."""
        sizes = self.problem.output_functions[0][1]
        column = np.empty((len(s), sum(sizes.values())))
        for i, (function, _) in enumerate(self.problem.output_functions):
            rows = phase == i
            count = int(rows.sum())
            if not count:
                continue
            c = ca.repmat(ca.DM(self.dense.constants), 1, count)
            theta = ca.repmat(ca.DM(self.dense.theta), 1, count)
            column[rows] = np.array(function(x[rows].T, z[rows].T, c, theta, s[rows][None])).T
        parts = np.split(column, np.cumsum(list(sizes.values()))[:-1], axis=1)
        return {
            name: part[:, 0] if part.shape[1] == 1 else part
            for name, part in zip(sizes, parts, strict=True)
        }
