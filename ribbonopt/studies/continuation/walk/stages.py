"""Stage after stage: each begins where the one before has ended; branches that cross are followed.

Where a stage ends short of its goal, no other follows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Protocol

from ribbonopt.arrays import Array

from .branches import Branch, History, Register
from .points import POINT, Point, S
from .protocol import Equations, Range, Records
from .switching import switched
from .walk import Ending, Walk


class WalkStage(Protocol[S]):
    """One stage: where it goes, what is recorded, and its equations."""

    @property
    def range(self) -> Range:
        """Where it goes."""

    @property
    def records(self) -> Records[S]:
        """What is recorded of its points."""

    @property
    def switch(self) -> bool:
        """Whether the branches that cross are followed, in both directions."""

    def first(self) -> tuple[S, Array]:
        """Solve where it begins: a solution and its unknowns (n + k,)."""

    def equations(self, first: S) -> Equations[S]:
        """Return its equations, with the metric of a stage that begins at a solution."""


def followed(
    count: int,
    stage_after: Callable[[int, Point[S] | None], WalkStage[S]],
    register: Register,
    history: History[S],
) -> Iterator[Point[S]]:
    """Points of all stages that a history does not know yet.

    Parameters
    ----------
    count
        Number of stages.
    stage_after
        Gives a stage by its number and the last point of the stage before.
    register
        Where points get their numbers, and endings are noted.
    history
        What is known already.
    """
    before: Point[S] | None = None
    for number in range(count):
        stage = stage_after(number, before)
        if stage.range.span == 0:
            register.endings[number, 0] = Ending(True, "its goal is where it begins")
            continue
        branch = _main(stage, number, register, history)
        yield from branch.points()
        if stage.switch:
            yield from _crossing(branch, history)
        if not register.endings[number, 0].reached or branch.last is None:
            return
        before = branch.last


def _main(stage: WalkStage[S], number: int, register: Register, history: History[S]) -> Branch[S]:
    """Return the branch that a stage begins on."""
    known = history.points(number, 0, POINT)
    solution, unknowns = (known[0].solution, known[0].unknowns) if known else stage.first()
    direction = 1 if stage.range.goals[-1] > stage.range.start else -1
    walk = Walk(stage.equations(solution), stage.range, direction)

    def begin() -> Point[S]:
        return walk.begin(solution, unknowns)

    return Branch(register, walk, stage.records, (number, 0), history, begin)


def _crossing(main: Branch[S], history: History[S]) -> Iterator[Point[S]]:
    """Follow the branches that cross at the branch points of another, in both directions."""
    number = 0
    for point in main.branch_points:
        for sign in (1, -1):
            number += 1
            walk = Walk(main.walk.equations, main.walk.range, 0)

            def begin(point: Point[S] = point, sign: int = sign) -> Point[S]:
                return switched(main.walk.equations, point, sign)

            key = main.key[0], number
            branch = Branch(main.register, walk, main.records, key, history, begin)
            yield from branch.points()
