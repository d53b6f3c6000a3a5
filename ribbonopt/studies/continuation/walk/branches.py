"""One branch of one stage: from its begin, or from where a history ends, to its ending."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol

import numpy as np

from .points import CROSSINGS, FOLD, POINT, Point, S
from .protocol import Records
from .walk import Ending, Walk

Key = tuple[int, int]  # stage, branch


class History(Protocol[S]):
    """Points that are known already, of each stage and branch."""

    endings: dict[Key, Ending]

    def points(self, stage: int, branch: int, kind: str) -> list[Point[S]]:
        """Points of a kind, in order."""


@dataclass(eq=False)
class Nothing(Generic[S]):
    """No history."""

    endings: dict[Key, Ending] = field(default_factory=dict)

    def points(self, stage: int, branch: int, kind: str) -> list[Point[S]]:
        """Return no points."""
        return []


@dataclass(eq=False)
class Register:
    """Numbers of points, and how branches have ended."""

    endings: dict[Key, Ending] = field(default_factory=dict)
    number: int = 0

    def entered(self, point: Point[S], records: Records[S], key: Key) -> Point[S]:
        """Return a point with its number and what is recorded of it."""
        point = replace(point, number=self.number, stage=key[0], branch=key[1])
        self.number += 1
        return replace(point, row=records.row(point))

    def known(self, point: Point[S]) -> None:
        """Take the number of a point that has one."""
        self.number = max(self.number, point.number + 1)


class Branch(Generic[S]):
    """One branch, followed once; `last` and `branch_points` are known then."""

    def __init__(
        self,
        register: Register,
        walk: Walk[S],
        records: Records[S],
        key: Key,
        history: History[S],
        begin: Callable[[], Point[S]],
    ) -> None:
        """Take what the history knows of it; `begin` gives the first point if that is nothing."""
        self.register, self.walk, self.records = register, walk, records
        self.key, self.begin = key, begin
        known = history.points(*key, POINT)
        self.last = known[-1] if known else None
        self.count = len(known)
        crossings = [point for kind in CROSSINGS for point in history.points(*key, kind)]
        self.branch_points = sorted(crossings, key=lambda point: point.number)
        folds = history.points(*key, FOLD)
        walk.turned += [walk.range.value(point.position) for point in folds]
        for point in (*known, *self.branch_points, *folds):
            register.known(point)
        self.ended = history.endings.get(key)

    def points(self) -> Iterator[Point[S]]:
        """Points that are not known yet; notes how the branch ends."""
        if self.ended is None:
            yield from self._followed()
            self.ended = self.walk.ending
        self.register.endings[self.key] = self.ended

    def _followed(self) -> Iterator[Point[S]]:
        walk = self.walk
        if self.last is None:
            try:
                self.last = self._entered(self.begin())
            except np.linalg.LinAlgError as error:
                walk.ending = Ending(False, str(error))
                return
            self.count = 1
            yield self.last
        if self._finished(self.last):
            return
        for point in walk.points(self.last):
            point = self._entered(point)
            if point.kind == POINT:
                self.last, self.count = point, self.count + 1
            elif point.kind in CROSSINGS:
                self.branch_points.append(point)
            yield point
            if point.kind == POINT and self._finished(point):
                return

    def _entered(self, point: Point[S]) -> Point[S]:
        return self.register.entered(point, self.records, self.key)

    def _finished(self, point: Point[S]) -> bool:
        """Whether no more points of this branch are wanted; sets the ending."""
        condition = self.records.stopped(point.row)
        if condition:
            self.walk.ending = Ending(True, f"stopped, as asked: {condition}")
        elif self.count >= self.walk.range.most:
            self.walk.ending = Ending(False, f"there are {self.count} points, as many as allowed")
        return bool(condition) or self.count >= self.walk.range.most
