"""One branch of one stage: from its begin, or from where a history ends, to its ending."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, Protocol

import numpy as np

from .asked import Records
from .endless import CLOSED, IDLE, IDLE_POINTS, comes_home, homeward, is_home, is_idle
from .known import Atlas
from .landing import landed
from .points import CROSSINGS, OF_LOCI, POINT, SPECIAL, Point, S
from .strides import Stride
from .walk import Ending, Walk

Key = tuple[int, int]  # stage, branch

HOME = "home"  # margin of a branch that comes back to its first point


class History(Protocol[S]):
    """Points that are known already, of each stage and branch."""

    endings: dict[Key, Ending]

    def points(self, stage: int, branch: int, kind: str) -> Iterable[Point[S]]:
        """Points of a kind, in order, each made when it is asked for."""


@dataclass(eq=False)
class Nothing(Generic[S]):
    """No history."""

    endings: dict[Key, Ending] = field(default_factory=dict)

    def points(self, stage: int, branch: int, kind: str) -> Iterable[Point[S]]:
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


@dataclass(frozen=True, eq=False)
class Common(Generic[S]):
    """What all branches of one stage share."""

    stage: int
    register: Register
    records: Records[S]
    history: History[S]
    atlas: Atlas[S]


class Branch(Generic[S]):
    """One branch, followed once; `first`, `last` and `branch_points` are known then.

    It may begin at a point of another (`origin`). Where that is a crossing, it is followed only if
    it is none that is known, and no further than to where it meets these.
    """

    def __init__(
        self,
        common: Common[S],
        number: int,
        walk: Walk[S],
        begin: Callable[[], Point[S]],
        origin: Point[S] | None = None,
    ) -> None:
        """Take what the history knows of it; `begin` gives the first point if that is nothing.

        One that has a row already is not entered again.
        """
        self.common, self.walk, self.begin, self.origin = common, walk, begin, origin
        self.crosses = origin is not None and origin.kind in CROSSINGS
        self.key = common.stage, number
        self.trace = common.atlas.begun(number, origin)
        self.kinds: Counter[str] = Counter()
        self.first: Point[S] | None = None
        self.last: Point[S] | None = None
        self.branch_points: list[Point[S]] = []
        self.special: Point[S] | None = None  # beyond the last point
        kinds = (POINT, *SPECIAL, *OF_LOCI)
        points = [point for kind in kinds for point in common.history.points(*self.key, kind)]
        for point in sorted(points, key=lambda point: point.number):
            common.register.known(point)
            self._note(point)
            walk.note(point)
        self.ended = common.history.endings.get(self.key)

    def points(self) -> Iterator[Point[S]]:
        """Points that are not known yet; notes how the branch ends."""
        if self.ended is None:
            yield from self._followed()
            self.ended = self.walk.ending
        self.common.register.endings[self.key] = self.ended

    @property
    def closed(self) -> bool:
        """Whether its last point is its first one again."""
        return self.last is not None and is_home(self.common.atlas, self.trace, self.last)

    def _followed(self) -> Iterator[Point[S]]:
        if self.last is None:
            try:
                self.last = self.begin()
            except np.linalg.LinAlgError as error:
                self.walk.ending = Ending(False, str(error))
                return
            branch = self.common.atlas.known(self.last, self.trace) if self.crosses else None
            if branch is not None:
                self.walk.ending = Ending(True, f"is branch {branch} already")
                return
            if not self.last.row:
                yield self._entered(self.last)
        if self._finished(self.last):
            return
        for point in self.walk.points(self.last, self._landed):
            if self.crosses and self._arrived(point):
                return
            point = self._entered(point)
            yield point
            if self._finished(point):
                return

    def _entered(self, point: Point[S]) -> Point[S]:
        origin = None if self.origin is None else self.origin.number
        point = replace(point, origin=origin)
        point = self.common.register.entered(point, self.common.records, self.key)
        self._note(point)
        return point

    def _note(self, point: Point[S]) -> None:
        """Keep a point of this branch."""
        self.common.atlas.note(self.trace, point)
        self.kinds[point.kind] += 1
        if point.kind == POINT:
            self.first, self.last, self.special = self.first or point, point, None
            return
        self.special = point
        if point.kind in CROSSINGS:
            self.branch_points.append(point)

    def _arrived(self, point: Point[S]) -> bool:
        """Whether a point is one where known branches cross; sets the ending."""
        there = self.common.atlas.crossing_at(point) if point.kind in CROSSINGS else None
        if there is None:
            return False
        range_ = self.walk.range
        where = f"{there.kind} at {range_.name} = {range_.value(there.position):.10g}"
        closed = self.origin is not None and there.number == self.origin.number
        reason = f"{CLOSED}, the {where}" if closed else f"has come to the {where}"
        self.walk.ending = Ending(True, f"{reason} (point {there.number})")
        return True

    def _finished(self, point: Point[S]) -> bool:
        """Whether no more points of this branch are wanted; sets the ending."""
        records, most = self.common.records, self.walk.range.most
        if point.kind != POINT:
            condition = records.stopped_at(point.kind, self.kinds[point.kind])
        else:
            condition = records.stopped(point.row)
        count = self.kinds[POINT]
        if condition:
            self.walk.ending = Ending(True, f"stopped, as asked: {condition}")
        elif point.kind != POINT:
            return False
        elif self.closed:
            self.walk.ending = Ending(self.walk.range.rounds, CLOSED)
        elif is_idle(self.common.atlas, self.trace, point):
            self.walk.ending = Ending(
                False,
                f"no progress: the last {IDLE_POINTS} points are less than {IDLE:g} of the first "
                "step apart",
            )
        elif count >= most:
            self.walk.ending = Ending(
                False, f"there are {count} points, as many as allowed; `points` may allow more"
            )
        else:
            return False
        return True

    def _landed(self, point: Point[S], stride: Stride[S]) -> Stride[S]:
        """Return a step that goes no further than to a condition, or to the first point."""
        atlas, trace = self.common.atlas, self.trace
        home = comes_home(atlas, trace, point, stride.following)

        def margins(there: Point[S]) -> Mapping[str, float]:
            found = self.common.records.margins(there)
            return {**found, HOME: homeward(atlas, trace, there)} if home else found

        return landed(self.walk.equations, point, stride, margins)
