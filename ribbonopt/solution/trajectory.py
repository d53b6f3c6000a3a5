"""A solution of one or several phases read as one, in units Dw = L = 1.

Positions are fractions of the whole length. What is evaluated once is kept: verification, the
estimate of the error and the summary read the same numbers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.outputs import OWN
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.transcription.buffered import Buffered, Mapped
from ribbonopt.transcription.known import sampled

from .named import Choice, Choices, Named, Part, Places, Rows

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Output


Phases = NDArray[np.intp]
ALL: Sequence[Rows] = (slice(None),)


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
        if len(self.problem.phases) == 1:
            return np.array([0.0, 1.0])
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
    def nodes_within(self) -> tuple[Array, ...]:
        """For each phase relative positions (n + 1,) of its nodes."""
        return tuple(self.dense.nodes(i) for i in range(len(self.problem.phases)))

    @cached_property
    def nodes(self) -> Array:
        """Fractions (N + 1,) of all nodes."""
        if len(self.problem.phases) == 1:
            return self.nodes_within[0]
        pairs = zip(self.nodes_within, pairwise(self.ends.tolist()), strict=True)
        parts = [a + (b - a) * within for within, (a, b) in pairs]
        return np.concatenate([*(part[:-1] for part in parts[:-1]), parts[-1]])

    def phase_of(self, fraction: Array) -> Phases:
        """Phase (k,) of each fraction; where two meet, the later one."""
        found = np.searchsorted(self.ends, fraction, side="right") - 1
        return np.clip(found, 0, len(self.problem.phases) - 1)

    def approximate(self, fraction: Array) -> Array:
        """Unknowns v (k, nv) at fractions: quick, fit to start Newton's method on."""
        v = np.empty((len(fraction), self.dense.blocks.layout.nv))
        for i, rows, local in self._local(fraction):
            v[rows] = self.dense.approximate(i, local)
        return v

    def outputs(self, fraction: Array, *, many: bool = False) -> dict[str, Array]:
        """Named outputs at fractions: (k,) for scalars, (k, 3) for vectors; soon at `many`."""
        return self._outputs(self._choices.every, self._unknowns(fraction, many=many), fraction)

    def looked_at(self, fraction: Array) -> dict[str, Array]:
        """Return those outputs that estimates compare between the nodes; see `outputs`."""
        return self._outputs(self._choices.places, self._unknowns(fraction), fraction)

    def line(self, fraction: Array, *, quick: bool = False) -> Array:
        """Positions r (k, 3) at fractions; `quick` for those on the polynomials of the mesh."""
        v = self.approximate(fraction) if quick else self._unknowns(fraction)
        return self._outputs(self._choices.line, v, fraction)["r"]

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,), own states of the law among them, if it has any."""
        o = self.outputs(fraction)
        own = {name[len(OWN) :]: value for name, value in o.items() if name.startswith(OWN)}
        frames = np.stack([o["d1"], o["d2"], o["d3"]], axis=2)
        return RodFields(o["r"], frames, o["n"], o["m"], own)

    def states(self, fraction: Array, *, many: bool = False) -> Array:
        """States x (k, nx) at fractions; soon at `many`."""
        read = self.dense.many if many else self.dense.states
        x = np.empty((len(fraction), self.dense.blocks.layout.nx))
        for i, rows, local in self._local(fraction):
            x[rows] = read(i, local)
        return x

    @cached_property
    def stages(self) -> tuple[Array, Array, Array, Phases]:
        """Stage values v (k, nv), fractions (k,), quadrature weights (k,), phases (k,)."""
        if len(self.problem.phases) == 1:
            v, fraction, weights = self.dense.stages(0)
            return v, fraction, weights, np.zeros(len(v), np.intp)
        parts = []
        for i, (a, b) in enumerate(pairwise(self.ends.tolist())):
            v, sigma, weights = self.dense.stages(i)
            parts.append((v, a + (b - a) * sigma, (b - a) * weights, np.full(len(sigma), i)))
        v, sigma, weights, phases = (np.concatenate(part) for part in zip(*parts, strict=True))
        return v, sigma, weights, phases

    @cached_property
    def at_stages(self) -> Named:
        """Named outputs at the stages, where the solver itself evaluated the equations."""
        v, fraction, _, phase = self.stages
        count, known = len(self.problem.phases), self._choices
        rows = [phase == i for i in range(count)] if count > 1 else ALL
        return Named(self._at(v, fraction, rows), known.stages, known.every)

    @cached_property
    def at_nodes(self) -> Named:
        """Named outputs at the nodes; where two phases meet, those of the later one."""
        layout, known = self.dense.blocks.layout, self._choices
        fraction = self.nodes if layout.nz or known.placed else None
        v = self.dense.at_nodes if fraction is None or not layout.nz else self._unknowns(fraction)
        *slices, last = layout.phase_slices
        rows = [*slices, slice(last.start, None)]
        return Named(self._at(v, fraction, rows), known.nodes, known.every)

    def singular_at_stages(self, phase: int) -> Array:
        """Rows (k, q, 4) of (a, b, size, fades) at the stages of a phase: see `Phase.singular`."""
        count = self.problem.kept(_counted)[phase]
        if not count:
            return np.empty((0, 0, 4))
        at = self.at_stages.places
        _, v, places = at.parts[phase]
        (found,) = self.problem.kept(_singular)[phase](v, *at.numbers, places)
        return found.reshape(-1, count, 4)

    @cached_property
    def length(self) -> float:
        """Length of the ribbon."""
        return float(self._extent[1:].sum())

    @cached_property
    def energy(self) -> float:
        """Strain energy, by the quadrature of the scheme."""
        return self.integral("energy")

    def integral(self, name: str) -> float:
        """Integral over s of a scalar named output, by the quadrature of the scheme."""
        return float(self.length * (self.stages[2] @ self.at_stages[name]))

    @cached_property
    def _extent(self) -> Array:
        """Arclength where the ribbon starts, and the lengths of its phases."""
        return self.problem.kept(_extent)(self.dense.constants, self.dense.theta)[0]

    @property
    def _choices(self) -> Choices:
        return self.problem.kept(Choices)

    def _local(self, fraction: Array) -> Iterator[tuple[int, Rows, Array]]:
        """Yield the phases in which fractions (k,) are: which, and their positions in the phase."""
        if len(self.problem.phases) == 1:
            yield 0, slice(None), np.clip(fraction, 0.0, 1.0)
            return
        phase = self.phase_of(fraction)
        for i, (a, b) in enumerate(pairwise(self.ends.tolist())):
            rows = phase == i
            if rows.any():
                # A phase may begin without length.
                yield i, rows, np.clip((fraction[rows] - a) / (b - a or 1.0), 0.0, 1.0)

    def _unknowns(self, fraction: Array, *, many: bool = False) -> Array:
        """Unknowns v (k, nv) at fractions."""
        layout = self.dense.blocks.layout
        if not layout.nz:
            return self.states(fraction, many=many)
        v = np.empty((len(fraction), layout.nv))
        v[:, : layout.nx] = self.states(fraction)
        for i, rows, local in self._local(fraction):
            v[rows, layout.nx :] = self.dense.algebraic(i, local)
        return v

    def _outputs(self, choice: Choice, v: Array, fraction: Array) -> dict[str, Array]:
        """Return outputs of a choice for the unknowns v (k, nv) at fractions (k,)."""
        phase = self.phase_of(fraction) if len(self.ends) > 2 else None
        rows = ALL if phase is None else [phase == i for i in range(len(self.problem.phases))]
        found = self._at(v, fraction, rows).columns(choice)
        return {name: found[:, at] for name, at in choice.columns.items()}

    def _at(self, v: Array, fraction: Array | None, rows: Sequence[Rows]) -> Places:
        """Return places at fractions (k,), each phase in turn, with the unknowns there.

        Fractions may be None where no output depends on the place by itself.
        """
        dense, numbers = self.dense, (self.dense.constants, self.dense.theta)
        if fraction is None or not self._choices.placed:
            nowhere = np.zeros(len(v))
            return Places([Part(part, v[part], nowhere[part]) for part in rows], numbers)
        s, parts = self._extent[0] + self.length * fraction, []
        for i, part in enumerate(rows):
            places = s[part]
            if (count := dense.blocks.layout.known) and len(places):
                a, b = self.ends[i : i + 2]
                local = np.clip((fraction[part] - a) / (b - a), 0.0, 1.0)
                places = np.column_stack([places, sampled(dense.known, i, local, count)])
            parts.append(Part(part, v[part], places))
        return Places(parts, numbers)


def _extent(problem: BoundaryValueProblem) -> Buffered:
    """Start and lengths on numpy arrays."""
    return Buffered(problem.extent_function)


def _counted(problem: BoundaryValueProblem) -> tuple[int, ...]:
    """Return how many singularities the law has, phase by phase."""
    return tuple(phase.singular.shape[0] for phase in problem.phases)


def _singular(problem: BoundaryValueProblem) -> tuple[Mapped, ...]:
    """Return the singularities of each phase, for any number of places."""
    return tuple(Mapped(function) for function in problem.singular_functions)
