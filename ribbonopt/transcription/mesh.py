"""Meshes: relative widths of the elements of every phase."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import TranscriptionError


@dataclass(frozen=True, eq=False)
class Mesh:
    """Widths of the elements of each phase, relative to the phase (each adds up to one)."""

    phases: tuple[Array, ...]

    def __post_init__(self) -> None:
        """Refuse widths that are not positive or do not add up to one."""
        for i, widths in enumerate(self.phases):
            if widths.ndim != 1 or not len(widths) or not (widths > 0).all():
                raise TranscriptionError(f"mesh of phase {i}: widths must be positive")
            if abs(widths.sum() - 1) > 1e-12:
                raise TranscriptionError(
                    f"mesh of phase {i}: relative widths add up to {widths.sum()}, expected 1"
                )

    @classmethod
    def uniform(cls, *counts: int) -> Mesh:
        """Equal elements, `counts[i]` of them in phase i."""
        if min(counts) < 1:
            raise TranscriptionError(f"number of intervals: found {min(counts)}, expected >= 1")
        return cls(tuple(np.full(n, 1 / n) for n in counts))

    @property
    def graded(self) -> bool:
        """Whether elements of a phase differ in width."""
        return any(np.ptp(widths) > 1e-9 * widths.max() for widths in self.phases)

    def resampled(self, count: int, switches: Array, least: int = 1) -> Mesh:
        """Return a mesh of about `count` elements, graded alike, in phases that meet elsewhere.

        `switches` (k,) are fractions of the length, as the one phase of this mesh has it; no phase
        has fewer than `least` elements.
        """
        (widths,) = self.phases
        nodes = np.append(0.0, np.cumsum(widths) / widths.sum())
        order = np.arange(len(nodes)) * count / len(widths)
        ends = np.interp(np.concatenate([[0.0], switches, [1.0]]), nodes, order)
        phases = []
        for a, b in pairwise(ends):
            inner = np.interp(np.linspace(a, b, max(least, round(b - a)) + 1), order, nodes)
            phases.append(np.diff(inner) / (inner[-1] - inner[0]))
        return Mesh(tuple(phases))

    def halved(self) -> Mesh:
        """Return a mesh with two elements for each."""
        return Mesh(tuple(np.repeat(widths / 2, 2) for widths in self.phases))

    def through(self, places: Array) -> Mesh:
        """Return a mesh of one phase with the nodes nearest to places (k,), fractions, moved there.

        Places are inside, in order and further apart than its elements are wide.
        """
        (widths,) = self.phases
        nodes = np.append(0.0, np.cumsum(widths) / widths.sum())
        nodes[1 + np.abs(nodes[1:-1] - places[:, None]).argmin(axis=1)] = places
        return Mesh((np.diff(np.sort(nodes)),))

    def gathered(self, levels: int, ratio: float, where: Sequence[bool]) -> Mesh:
        """Return a mesh with more elements where phases meet: the last of each in `levels` more.

        Each is `ratio` times as wide as the one before. `where` says at which of these places.
        """
        split = ratio ** np.arange(levels + 1)
        split[:-1] *= 1 - ratio
        sides = zip((False, *where), (*where, False), self.phases, strict=True)
        phases = []
        for before, behind, widths in sides:
            parts = [widths[0] * split[::-1] if before else widths[:1], widths[1:-1]]
            parts.append(widths[-1] * split if behind else widths[-1:])
            phases.append(np.concatenate(parts if len(widths) > 1 else [widths]))
        return Mesh(tuple(widths / widths.sum() for widths in phases))

    def joined(self, switches: Array) -> Mesh:
        """Return the same elements in one phase; phases meet at `switches` (k,), fractions."""
        if len(self.phases) == 1:
            return self
        lengths = np.diff(np.concatenate([[0.0], switches, [1.0]]))
        widths = [a * part for a, part in zip(lengths, self.phases, strict=True)]
        whole = np.concatenate(widths)
        return Mesh((whole / whole.sum(),))

    @property
    def elements(self) -> tuple[int, ...]:
        """Number of elements of each phase."""
        return tuple(len(widths) for widths in self.phases)

    @property
    def widths(self) -> Array:
        """Widths of all elements, phase after phase."""
        return np.concatenate(self.phases)
