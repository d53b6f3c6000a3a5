"""One branch of one stage: from its begin, or from where a history ends, to its ending."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from .points import BRANCH_POINT, FOLD, POINT, Point
from .recorded import Recorder, stopped
from .walk import Ending, Walk

Key = tuple[int, int]


class History(Protocol):
    """Points that are known already, of each stage and branch."""

    endings: dict[Key, Ending]

    def points(self, stage: int, branch: int, kind: str) -> list[Point]:
        """Points of a kind, in order."""


@dataclass(eq=False)
class Nothing:
    """No history."""

    endings: dict[Key, Ending] = field(default_factory=dict)

    def points(self, stage: int, branch: int, kind: str) -> list[Point]:
        """Return no points."""
        return []


@dataclass(eq=False)
class Ledger:
    """Numbers of points, what is recorded of them, and how branches have ended."""

    recorder: Recorder
    endings: dict[Key, Ending] = field(default_factory=dict)
    number: int = 0

    def entered(self, point: Point, walk: Walk, key: Key) -> Point:
        """Return a point with its number and what is recorded of it."""
        point = replace(point, number=self.number, stage=key[0], branch=key[1])
        self.number += 1
        return replace(point, row=self.recorder.row(point, walk.curve))

    def known(self, point: Point) -> None:
        """Take the number of a point that has one."""
        self.number = max(self.number, point.number + 1)


class Branch:
    """One branch, followed once; `last` and `branch_points` are known then."""

    def __init__(
        self,
        ledger: Ledger,
        walk: Walk,
        key: Key,
        history: History,
        begin: Callable[[], Point],
    ) -> None:
        """Take what the history knows of it; `begin` gives the first point if that is nothing."""
        self.ledger, self.walk, self.key, self.begin = ledger, walk, key, begin
        known = history.points(*key, POINT)
        self.last = known[-1] if known else None
        self.count = len(known)
        self.branch_points = history.points(*key, BRANCH_POINT)
        folds = history.points(*key, FOLD)
        walk.turned += [walk.curve.value(point.position) for point in folds]
        for point in (*known, *self.branch_points, *folds):
            ledger.known(point)
        self.ended = history.endings.get(key)

    def points(self) -> Iterator[Point]:
        """Points that are not known yet; notes how the branch ends."""
        if self.ended is None:
            yield from self._followed()
            self.ended = self.walk.ending
        self.ledger.endings[self.key] = self.ended

    def _followed(self) -> Iterator[Point]:
        ledger, walk = self.ledger, self.walk
        if self.last is None:
            try:
                self.last = ledger.entered(self.begin(), walk, self.key)
            except np.linalg.LinAlgError as error:
                walk.ending = Ending(False, str(error))
                return
            self.count = 1
            yield self.last
        if self._finished(self.last):
            return
        for point in walk.points(self.last):
            point = ledger.entered(point, walk, self.key)
            if point.kind == POINT:
                self.last, self.count = point, self.count + 1
            elif point.kind == BRANCH_POINT:
                self.branch_points.append(point)
            yield point
            if point.kind == POINT and self._finished(point):
                return

    def _finished(self, point: Point) -> bool:
        """Whether the scene wants no more points of this branch; sets the ending."""
        stage = self.walk.curve.stage
        condition = stopped(point.row, stage)
        if condition:
            self.walk.ending = Ending(True, f"stopped, as asked: {condition}")
        elif self.count >= stage.points:
            self.walk.ending = Ending(False, f"there are {self.count} points, as many as allowed")
        return bool(condition) or self.count >= stage.points
