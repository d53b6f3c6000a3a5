"""Known fields k(s) as numbers: data along s that enter a program as its parameters do.

A field is read at relative positions sigma of a phase, wherever equations are evaluated; from one
mesh or scheme to another it is read anew, never interpolated. `ribbonopt.transcription.fields` has
data over arclengths, over fractions of the length, and in tables.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import TranscriptionError


class Known(Protocol):
    """Known fields of all phases."""

    def __call__(self, phase: int, sigma: Array, /) -> Array:
        """Return the fields (k, nk) at the relative positions sigma (k,) of a phase."""


def sampled(known: Known | None, phase: int, sigma: Array, count: int) -> Array:
    """Return `count` known fields (k, nk) at sigma (k,); TranscriptionError if they are not that.

    Where a problem has none, fields that are given are refused as well.
    """
    if known is None or not count:
        found = "none" if known is None else "some"
        raise TranscriptionError(
            f"known fields: the problem has {count}, found {found}; give the fields where the "
            "parameters are made and where a solution is read, for problems that have them"
        )
    values = np.asarray(known(phase, sigma), dtype=float)
    if values.shape != (len(sigma), count):
        raise TranscriptionError(
            f"known fields of phase {phase} are expected to have shape ({len(sigma)}, {count}) at "
            f"{len(sigma)} positions, found {values.shape}"
        )
    if not np.isfinite(values).all():
        where = sigma[~np.isfinite(values).all(axis=1)][0]
        raise TranscriptionError(
            f"known fields of phase {phase} are not finite at its relative position {where:.6g}"
        )
    return values


def at_places(known: Known | None, phase: int, sigma: Array, count: int) -> Array:
    """Positions sigma (k,), with `count` known fields after each: (k, 1 + nk), or sigma if none."""
    return np.column_stack([sigma, sampled(known, phase, sigma, count)]) if count else sigma
