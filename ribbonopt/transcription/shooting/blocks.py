"""Shooting: residuals and derivative blocks as numbers, all elements of a phase in one mapped call.

`ribbonopt.transcription.structure` has the interface and the shapes.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.buffered import Mapped
from ribbonopt.transcription.collocation.elimination import NothingToEliminate
from ribbonopt.transcription.functions import StageFunctions
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.points import Conditions
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .steps import Method, Step

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Output


@dataclass(frozen=True, eq=False)
class Flow:
    """What carries the states along one phase: equations, `steps` steps of a method, z at states.

    `algebraic` is a function (x, c, theta, place) of z.
    """

    stage: StageFunctions
    step: Step
    algebraic: ca.Function
    steps: int

    @cached_property
    def mapped_algebraic(self) -> Mapped:
        """The algebraic variables at any number of states."""
        return Mapped(self.algebraic)


@dataclass(frozen=True, eq=False)
class ShootingBlocks:
    """Evaluates a shooting system element by element."""

    layout: Layout
    method: Method
    name: str
    flows: tuple[Flow, ...]
    conditions: Conditions

    @property
    def degree(self) -> int:
        """Number of stages of the method, in every step."""
        return self.method.degree

    @property
    def order(self) -> int:
        """Order of the error everywhere."""
        return self.method.order

    @property
    def symplectic(self) -> bool:
        """Whether quadratic invariants are kept to rounding."""
        return self.method.symplectic

    @property
    def compiled(self) -> None:
        """Nothing: the kernel knows no shooting."""
        return None

    def build(self) -> None:
        """Build all functions now rather than at the first evaluation."""
        _ = self._values, self._dense
        self.conditions.build()

    @cached_property
    def bordered(self) -> ShootingBlocks:
        """The same with one more constant and one more condition: to eliminate, not to evaluate."""
        lay = self.layout
        return replace(self, layout=replace(lay, nc=lay.nc + 1, conditions=lay.conditions + 1))

    def values(self, w: Array, p: Array) -> tuple[Array, Array]:
        """States (N, 1, nx) after every element, and conditions, which `linearize` derives."""
        (after,) = self._evaluate(self._values, w, p)
        conditions = self.conditions.values(self.layout.unpack(w), p)
        return after.reshape(-1, 1, self.layout.nx), conditions

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Return the residuals at the unknowns w for p."""
        (after,) = self._evaluate(self._values, w, p)
        return self._residuals(w, after, self.conditions.values(self.layout.unpack(w), p))

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Return residuals and derivative blocks at w for p."""
        lay = self.layout
        after, slopes = self._evaluate(self._dense, w, p)
        # CasADi stores columns first.
        slopes = slopes.reshape(lay.element_count, 1, lay.nx + lay.nc, lay.nx).swapaxes(2, 3)
        b, jb = self.conditions.linearize(lay.unpack(w), p)
        return self._residuals(w, after, b), Derivatives(slopes, jb)

    def eliminate(
        self, derivatives: Derivatives, p: Array, only: Residuals | None = None
    ) -> NothingToEliminate:
        """Neighbouring nodes are related already."""
        return NothingToEliminate(derivatives)

    def growth(self, derivatives: Derivatives, p: Array) -> Array:
        """Exponents (N,) of elements, zero: see `ShootingOutput.growth`."""
        return np.zeros(self.layout.element_count)

    def widths(self, p: Array) -> Array:
        """Relative widths (N,) of the elements."""
        return self.layout.widths(p)

    def stage_positions(self, p: Array) -> Array:
        """No stages are unknown: (N, 0)."""
        return np.empty((self.layout.element_count, 0))

    @cached_property
    def finer(self) -> tuple[ShootingBlocks, int]:
        """The same method on halved elements."""
        layout = replace(self.layout, elements=tuple(2 * n for n in self.layout.elements))
        conditions = replace(self.conditions, layout=layout)
        return ShootingBlocks(layout, self.method, self.name, self.flows, conditions), 2

    def sampled(self, output: Output, p: Array) -> Array:
        """Unknowns w that stand for an output of the same problem, on any elements."""
        lay, starts = self.layout, self.layout.starts(p)
        nodes = [output.states(i, starts[s]) for i, s in enumerate(lay.phase_slices)]
        nodes.append(output.at_nodes[-1:])
        stages = np.empty((lay.element_count, 0, lay.nv))
        return lay.pack(np.concatenate(nodes), stages, output.constants)

    def of_finer(self, w: Array) -> Array:
        """Unknowns (nw,) that stand for such of `finer`: every second node."""
        nodes, _, c = self.finer[0].layout.unpack(w)
        stages = np.empty((self.layout.element_count, 0, self.layout.nv))
        return self.layout.pack(nodes[::2], stages, c)

    def _residuals(self, w: Array, after: Array, b: Array) -> Residuals:
        lay = self.layout
        nodes, _, _ = lay.unpack(w)
        stages = np.empty((lay.element_count, 0, lay.stage_equations))
        return Residuals(stages, nodes[1:] - after.reshape(-1, lay.nx), b)

    def _evaluate(self, calls: tuple[Mapped, ...], w: Array, p: Array) -> list[Array]:
        lay = self.layout
        nodes, _, c = lay.unpack(w)
        theta, widths = lay.theta(p), lay.widths(p)
        places = lay.with_known(lay.starts(p), p)
        parts = [
            call(nodes[s], c, theta, places[s], widths[s])
            for call, s in zip(calls, lay.phase_slices, strict=True)
        ]
        return [np.concatenate(group) for group in zip(*parts, strict=True)]

    @cached_property
    def _values(self) -> tuple[Mapped, ...]:
        return tuple(flow.step.mapped_values for flow in self.flows)

    @cached_property
    def _dense(self) -> tuple[Mapped, ...]:
        return tuple(flow.step.mapped_dense for flow in self.flows)
