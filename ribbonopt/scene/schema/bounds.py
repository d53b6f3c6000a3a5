"""Bounds on a number of a scene, written in its type: `Annotated[float, Bounds(gt=0)]`."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Bounds:
    """Limits on a number: greater than, at least, less than, at most (None: no limit)."""

    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None
