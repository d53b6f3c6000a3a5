"""What is asked of a walk: where it goes and in which steps, and what is recorded of its points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from .points import Point, S


class Range(Protocol):
    """Where one stage goes, and in which steps; the position is the parameter, or a scale of it."""

    @property
    def start(self) -> float:
        """Position where it begins."""

    @property
    def goals(self) -> tuple[float, ...]:
        """Positions that must be met exactly, in order; the last is the end."""

    @property
    def span(self) -> float:
        """Distance from the start to the end."""

    @property
    def first(self) -> float:
        """Change of the position in the first step."""

    @property
    def largest(self) -> float:
        """Largest change of the position in a step."""

    @property
    def smallest(self) -> float:
        """Change of the position below which a step is not tried."""

    @property
    def special(self) -> bool:
        """Whether folds and branch points are located."""

    @property
    def rounds(self) -> bool:
        """Whether a curve that has come back to where it began is all that was asked for."""

    @property
    def most(self) -> int:
        """Most points."""

    @property
    def name(self) -> str:
        """What the position is called."""

    def value(self, position: float) -> float:
        """Return the parameter at a position."""


class Records(Protocol[S]):
    """What is recorded of the points of a stage."""

    def row(self, point: Point[S]) -> Mapping[str, Any]:
        """Return what is recorded of a point."""

    def stopped(self, row: Mapping[str, Any]) -> str:
        """Return the condition that ends a branch at a row, "" if it goes on."""

    def margins(self, point: Point[S]) -> Mapping[str, float]:
        """Return how far a point is beyond each condition that is met exactly; > 0 where met."""

    def stopped_at(self, kind: str, count: int) -> str:
        """Return what ends a branch at its special point of a kind and number from 1, or ""."""
