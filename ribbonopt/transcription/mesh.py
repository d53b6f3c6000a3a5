"""Meshes: relative widths of the elements of every phase."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array
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

    def resampled(self, *counts: int) -> Mesh:
        """Return a mesh graded alike with other numbers of elements in the phases."""
        phases = []
        for widths, count in zip(self.phases, counts, strict=True):
            nodes = np.append(0.0, np.cumsum(widths) / widths.sum())
            index = np.linspace(0, len(widths), count + 1)
            phases.append(np.diff(np.interp(index, np.arange(len(nodes)), nodes)))
        return Mesh(tuple(phases))

    @property
    def elements(self) -> tuple[int, ...]:
        """Number of elements of each phase."""
        return tuple(len(widths) for widths in self.phases)

    @property
    def widths(self) -> Array:
        """Widths of all elements, phase after phase."""
        return np.concatenate(self.phases)
