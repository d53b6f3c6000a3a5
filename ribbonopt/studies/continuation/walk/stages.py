"""Stage after stage: each begins where the one before has ended; branches that cross are followed.

A stage that goes two ways from where it begins follows one after the other: the second way is a
branch of its own that leaves the first where that begins. Where a stage ends short of a goal, no
other follows; else the next begins where the last way has ended.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Generic, Protocol

from ribbonopt.arrays import Array

from .asked import Range, Records
from .branches import Branch, Common, History, Register
from .endless import CLOSED
from .known import Atlas
from .points import POINT, Point, S
from .protocol import Equations
from .switching import switched
from .walk import Ending, Walk


class WalkStage(Protocol[S]):
    """One stage: where it goes, what is recorded, and its equations."""

    @property
    def range(self) -> Range:
        """Where it goes, from end to end."""

    @property
    def ways(self) -> tuple[Range, ...]:
        """The same in each direction from where it begins, which is one of them, or two."""

    @property
    def records(self) -> Records[S]:
        """What is recorded of its points."""

    @property
    def switch(self) -> int:
        """How deep branches that cross are followed, in both directions: 2 for those of those."""

    @property
    def missing(self) -> str:
        """What it would need to begin, in words; "" where it can."""

    def first(self) -> tuple[S, Array]:
        """Solve where it begins: a solution and its unknowns (n + k,)."""

    def equations(self, first: S) -> Equations[S]:
        """Return its equations, with the metric of a stage that begins at a solution."""


def followed(
    count: int,
    stage_after: Callable[[int, Point[S] | None, Point[S] | None], WalkStage[S]],
    register: Register,
    history: History[S],
) -> Iterator[Point[S]]:
    """Points of all stages that a history does not know yet.

    Parameters
    ----------
    count
        Number of stages.
    stage_after
        Gives a stage by its number, and of the stage before the last point and the special point
        where it has stopped.
    register
        Where points get their numbers, and endings are noted.
    history
        What is known already.
    """
    before: Point[S] | None = None
    special: Point[S] | None = None
    for number in range(count):
        stage = stage_after(number, before, special)
        if stage.missing:
            register.endings[number, 0] = Ending(False, stage.missing)
            return
        if stage.range.span == 0:
            register.endings[number, 0] = Ending(True, "its goal is where it begins")
            continue
        ways = _Ways(stage, number, register, history)
        yield from ways.points()
        if stage.switch:
            yield from ways.crossing()
        main = ways.branches[len(stage.ways) - 1]
        before, special = main.last or ways.branches[0].first, main.special
        if not all(register.endings[number, way].reached for way in range(len(stage.ways))):
            # What the next one would have needed tells more than how far this one came.
            if number + 1 < count and (why := stage_after(number + 1, before, None).missing):
                register.endings[number + 1, 0] = Ending(False, why)
            return


class _Ways(Generic[S]):
    """The branches of one stage, in the order of their numbers."""

    def __init__(
        self, stage: WalkStage[S], number: int, register: Register, history: History[S]
    ) -> None:
        """Solve where it begins, unless that is known."""
        known = next(iter(history.points(number, 0, POINT)), None)
        begin = (known.solution, known.unknowns) if known else stage.first()
        self.stage, self.solution, self.unknowns = stage, *begin
        self.equations = stage.equations(self.solution)
        self.common = Common(number, register, stage.records, history, Atlas(self.equations))
        self.branches: list[Branch[S]] = []

    def points(self) -> Iterator[Point[S]]:
        """Follow the branch that the stage begins on, each way."""
        for way in self.stage.ways:
            first = self.branches[0].first if self.branches else None
            walk = Walk(self.equations, way, 1 if way.goals[-1] > way.start else -1)

            def begin(walk: Walk[S] = walk, first: Point[S] | None = first) -> Point[S]:
                point = walk.begin(self.solution, self.unknowns)
                return point if first is None else replace(point, row=first.row)

            branch = self._branch(walk, begin, first)
            if first is not None and self.branches[0].closed:
                branch.ended = Ending(way.rounds, f"is branch 0 already, which is {CLOSED}")
            yield from branch.points()

    def crossing(self) -> Iterator[Point[S]]:
        """Follow the branches that cross, in both directions, and those that cross them."""
        level = self.branches
        for _ in range(self.stage.switch):
            known = len(self.branches)
            for left, origin in [(b, point) for b in level for point in b.branch_points]:
                itself = partial(self.common.atlas.leads_to, left.trace)
                for sign in (1, -1):
                    begin = partial(switched, self.equations, origin, sign, itself)
                    walk = Walk(self.equations, self.stage.range, 0)
                    yield from self._branch(walk, begin, origin).points()
            level = self.branches[known:]

    def _branch(
        self, walk: Walk[S], begin: Callable[[], Point[S]], origin: Point[S] | None
    ) -> Branch[S]:
        """Return the next branch."""
        branch = Branch(self.common, len(self.branches), walk, begin, origin)
        self.branches = [*self.branches, branch]
        return branch
