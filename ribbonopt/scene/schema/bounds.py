"""What a type of the scene says beside itself, such as `Annotated[float, Bounds(gt=0)]`."""

from __future__ import annotations

from ribbonopt.classes import dataclass


@dataclass(frozen=True)
class Bounds:
    """Limits on a number: greater than, at least, less than, at most (None: no limit).

    `most` is a limit on its size that is so far off that only those who exceed it are told.
    """

    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None
    most: int | None = None


@dataclass(frozen=True)
class InPython:
    """Marks a class whose instances stand in scenes built in Python; no file can say them."""
