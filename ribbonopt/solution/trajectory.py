"""A solution of one or several phases read as one, in units Dw = L = 1.

Positions are fractions of the whole length. What is evaluated once is kept: verification, the
estimate of the error and the summary read the same numbers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.mechanics.outputs import OWN
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.transcription.buffered import Buffered, Mapped
from ribbonopt.transcription.known import sampled

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Output


Phases = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The phases of an output, one after another; fractions (k,) run from 0 to 1.

    `found` is what others have found out about it, by who did, so that none asks twice.
    """

    problem: BoundaryValueProblem
    dense: Output
    found: dict[type, Any] = field(default_factory=dict)

    @cached_property
    def ends(self) -> Array:
        """Fractions (P + 1,) at which the phases begin and end."""
        lengths = self._extent[1:]
        ends = np.append(0.0, np.cumsum(lengths) / lengths.sum())
        ends[-1] = 1.0
        return ends

    @property
    def turns(self) -> tuple[int, ...]:
        """Which of `ends` are inside and no single places where something acts or holds."""
        stations = self.problem.stations
        return tuple(i for i in range(1, len(self.problem.phases)) if i not in stations)

    @cached_property
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

    def approximate(self, fraction: Array) -> Array:
        """Unknowns v (k, nv) at fractions: quick, fit to start Newton's method on."""
        phase, local = self._local(fraction)
        v = np.empty((len(fraction), self.dense.blocks.layout.nv))
        for i in range(len(self.problem.phases)):
            rows = phase == i
            if rows.any():
                v[rows] = self.dense.approximate(i, local[rows])
        return v

    def outputs(self, fraction: Array) -> dict[str, Array]:
        """Named outputs at fractions: (k,) for scalars, (k, 3) for vectors."""
        phase, local = self._local(fraction)
        v = np.empty((len(fraction), self.dense.blocks.layout.nv))
        nx = self.dense.blocks.layout.nx
        v[:, :nx] = self.states(fraction)
        for i in range(len(self.problem.phases)):
            rows = phase == i
            if rows.any():
                v[rows, nx:] = self.dense.algebraic(i, local[rows])
        return self._named(v, fraction, phase)

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,), own states of the law among them, if it has any."""
        o = self.outputs(fraction)
        own = {name[len(OWN) :]: value for name, value in o.items() if name.startswith(OWN)}
        frames = np.stack([o["d1"], o["d2"], o["d3"]], axis=2)
        return RodFields(o["r"], frames, o["n"], o["m"], own)

    def states(self, fraction: Array) -> Array:
        """States (k, nx) at fractions."""
        phase, local = self._local(fraction)
        x = np.empty((len(fraction), self.dense.blocks.layout.nx))
        for i in range(len(self.problem.phases)):
            rows = phase == i
            if rows.any():
                x[rows] = self.dense.states(i, local[rows])
        return x

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

    @cached_property
    def at_stages(self) -> Mapping[str, Array]:
        """Named outputs at the stages, where the solver itself evaluated the equations."""
        v, fraction, _, phase = self.stages
        return self._named(v, fraction, phase)

    @cached_property
    def at_nodes(self) -> Mapping[str, Array]:
        """Named outputs at the nodes; where two phases meet, those of the later one."""
        if self.dense.blocks.layout.nz:
            return self.outputs(self.nodes)
        counts = self.dense.blocks.layout.elements
        phase = np.append(np.repeat(np.arange(len(counts)), counts), len(counts) - 1)
        return self._named(self.dense.at_nodes, self.nodes, phase)

    def singular_at_stages(self, phase: int) -> Array:
        """Rows (k, q, 4) of (a, b, size, fades) at the stages of a phase: see `Phase.singular`."""
        count = self.problem.phases[phase].singular.shape[0]
        if not count:
            return np.empty((0, 0, 4))
        v, fraction, _, phases = self.stages
        if len(self.problem.phases) > 1:
            rows = phases == phase
            v, fraction = v[rows], fraction[rows]
        places = self._places(phase, fraction, self._extent[0] + self.length * fraction)
        function = self.problem.kept(_singular)[phase]
        (found,) = function(v, self.dense.constants, self.dense.theta, places)
        return found.reshape(-1, count, 4)

    @property
    def length(self) -> float:
        """Length of the ribbon."""
        return float(self._extent[1:].sum())

    @cached_property
    def energy(self) -> float:
        """Strain energy, by the quadrature of the scheme."""
        return self.integral("energy")

    def integral(self, name: str) -> float:
        """Integral over s of a scalar named output, by the quadrature of the scheme."""
        return float(self.length * self.stages[2] @ self.at_stages[name])

    @cached_property
    def _extent(self) -> Array:
        """Arclength where the ribbon starts, and the lengths of its phases."""
        return self.problem.kept(_extent)(self.dense.constants, self.dense.theta)[0]

    def _local(self, fraction: Array) -> tuple[Phases, Array]:
        """Phase and position in the phase of each fraction."""
        phase = self.phase_of(fraction)
        a, b = self.ends[phase], self.ends[phase + 1]
        widths = np.where(b != a, b - a, 1.0)  # a phase may begin without length
        return phase, np.clip((fraction - a) / widths, 0.0, 1.0)

    def _places(self, phase: int, fraction: Array, s: Array) -> Array:
        """Arclengths s (k,) at fractions in one phase, with the known fields there after each."""
        count = self.dense.blocks.layout.known
        if not count:
            return s
        a, b = self.ends[phase : phase + 2]
        local = np.clip((fraction - a) / (b - a), 0.0, 1.0)
        return np.column_stack([s, sampled(self.dense.known, phase, local, count)])

    def _named(self, v: Array, fraction: Array, phase: Phases) -> dict[str, Array]:
        sizes = self.problem.output_functions[0][1]
        column = np.empty((len(v), sum(sizes.values())))
        s = self._extent[0] + self.length * fraction
        numbers = self.dense.constants, self.dense.theta
        for i, function in enumerate(self.problem.kept(_outputs)):
            rows = phase == i
            count = int(np.count_nonzero(rows))
            if count:
                places = self._places(i, fraction[rows], s[rows])
                (found,) = function(v[rows], *numbers, places)
                column[rows] = found.reshape(count, -1)
        result, at = {}, 0
        for name, size in sizes.items():
            part = column[:, at : at + size]
            result[name] = part[:, 0] if size == 1 else part
            at += size
        return result


def _extent(problem: BoundaryValueProblem) -> Buffered:
    """Start and lengths on numpy arrays."""
    return Buffered(problem.extent_function)


def _singular(problem: BoundaryValueProblem) -> tuple[Mapped, ...]:
    """Return the singularities of each phase, for any number of places."""
    return tuple(Mapped(function) for function in problem.singular_functions)


def _outputs(problem: BoundaryValueProblem) -> tuple[Mapped, ...]:
    """Return the outputs of each phase, for any number of places."""
    return tuple(Mapped(function) for function, _ in problem.output_functions)
