"""What a row asks of a scene: a number of its solution, of a point of its branch, a buckling load.

    fold.1.value branch_point.2.energy kink.1.value        the k-th special point of a kind
    folds branch_points kinks buckling_points              how many there are
    at(0.25).energy at(0.25, 1).negative                   the point of branch 0, or 1, at a value
    locus(0.25)                                            the first of two parameters where the
                                                           second of a locus has a value
    buckling.1                                             the k-th load of `buckling_loads`

Anything else is a number of the scene's solution (`numbers`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from re import Match

from ribbonopt.classes import dataclass
from ribbonopt.scene import Scene
from ribbonopt.scene.stages import stages_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import PARAMETERS, VALUE
from ribbonopt.studies.continuation.walk.points import (
    BRANCH_POINT,
    BUCKLING,
    FOLD,
    KINK,
    POINT,
    Point,
)

from .answers import Answers, Branch
from .measured import COUNT, TOLERANCE, Measured, NoAnswerError
from .number import USUAL, Number, UnknownNumberError
from .numbers import number

Quantity = Callable[[Answers], Measured]
KINDS = {
    "fold": FOLD,
    "branch_point": BRANCH_POINT,
    "kink": KINK,
    "buckling_point": BUCKLING,
}


def quantity(text: str, scene: Scene) -> Quantity:
    """Return what a row asks for.

    Raises
    ------
    UnknownNumberError
        If the scene has no such number: says why.
    """
    for pattern, make in QUANTITIES:
        if found := re.fullmatch(pattern, text):
            if scene.continuation is None:
                raise UnknownNumberError("the scene has no `continuation` that could be followed")
            return make(found, scene)
    return _OfSolution(number(text, scene))


@dataclass(frozen=True, eq=False)
class _OfSolution:
    """A number of the solution."""

    number: Number

    def __call__(self, answers: Answers) -> Measured:
        return self.number.measured(answers.solution)


@dataclass(frozen=True, eq=False)
class _OfSpecial:
    """The value of the parameter at a special point, or another number there (`number`)."""

    kind: str
    k: int
    number: Number | None

    def __call__(self, answers: Answers) -> Measured:
        branch = answers.branch
        found = branch.of_kind(self.kind)
        if not 1 <= self.k <= len(found):
            raise NoAnswerError(f"the branch has {len(found)} points that are a {self.kind}")
        point = found[self.k - 1]
        if self.number is not None:
            # Its equations are singular at the parameter's value: so would its bar be.
            return self.number.measured(point.solution, barred=False)
        stage = branch.continuation.stages[point.stage]
        value = float(point.row[stage.moved])
        if point.error is None:
            tolerance = answers.scene.tolerance or USUAL
            return Measured(value, tolerance * abs(value), TOLERANCE)
        decades = stage.scale == "log"  # what the error is of, then
        return Measured(value, point.error * (math.log(10) * abs(value) if decades else 1.0))


@dataclass(frozen=True, eq=False)
class _At:
    """A number of the point of a branch where the parameter has a value."""

    value: float
    branch: int
    number: Number

    def __call__(self, answers: Answers) -> Measured:
        branch = answers.branch
        found = [
            point
            for point in branch.of_kind(POINT)
            if point.branch == self.branch and self._there(branch, point)
        ]
        if len(found) != 1:
            raise NoAnswerError(
                f"branch {self.branch} has {len(found)} points at {self.value:g}, expected one"
            )
        return self.number.measured(found[0].solution)

    def _there(self, branch: Branch, point: Point[Solution]) -> bool:
        return bool(point.row[branch.parameter(point)] == self.value)


@dataclass(frozen=True, eq=False)
class _OfLocus:
    """The first of two parameters at the point of a locus where the second has a value."""

    value: float

    def __call__(self, answers: Answers) -> Measured:
        stages = answers.branch.continuation.stages
        found = [
            (float(point.row[stages[point.stage].paths[0]]), point.row["error"])
            for point in answers.branch.of_kind(POINT)
            if stages[point.stage].is_locus and point.row[stages[point.stage].moved] == self.value
        ]
        if len(found) != 1:
            raise NoAnswerError(f"the locus has {len(found)} points at {self.value:g}, not one")
        ((value, error),) = found
        if error is None:
            tolerance = answers.scene.tolerance or USUAL
            return Measured(value, tolerance * abs(value), TOLERANCE)
        return Measured(value, error * abs(value))


@dataclass(frozen=True, eq=False)
class _Count:
    """How many special points of a kind there are."""

    kind: str

    def __call__(self, answers: Answers) -> Measured:
        return Measured(float(len(answers.branch.of_kind(self.kind))), 0.0, COUNT)


@dataclass(frozen=True, eq=False)
class _Buckling:
    """A buckling load, by increasing distance from where the stage begins."""

    k: int

    def __call__(self, answers: Answers) -> Measured:
        found = answers.buckling
        if not 1 <= self.k <= len(found):
            raise NoAnswerError(f"there are {len(found)} buckling loads in the range")
        return Measured(found[self.k - 1].value, found[self.k - 1].error)


def _special(found: Match[str], scene: Scene) -> Quantity:
    name, kind, k = found["what"], KINDS[found["kind"]], int(found["number"])
    moved = {stage.moved for stage in stages_of(scene)}
    moved |= {path.removeprefix(PARAMETERS) for path in moved} | {VALUE}
    return _OfSpecial(kind, k, None if name in moved else number(name, scene))


def _at(found: Match[str], scene: Scene) -> Quantity:
    return _At(_value(found["value"]), int(found["branch"] or 0), number(found["what"], scene))


def _locus(found: Match[str], scene: Scene) -> Quantity:
    if not any(stage.is_locus for stage in stages_of(scene)):
        raise UnknownNumberError("the scene's `continuation` follows no locus: no two parameters")
    return _OfLocus(_value(found["value"]))


def _value(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise UnknownNumberError(
            f"found {text.strip()!r}, expected the parameter's value"
        ) from None


def _count(found: Match[str], scene: Scene) -> Quantity:
    return _Count(KINDS[found["kind"]])


def _buckling(found: Match[str], scene: Scene) -> Quantity:
    stage = stages_of(scene)[0]
    if not isinstance(stage.to, float):
        raise UnknownNumberError("buckling loads are sought from `from` to one value of `to`")
    return _Buckling(int(found["number"]))


_KIND = rf"(?P<kind>{'|'.join(KINDS)})"
_K = r"(?P<number>[0-9]{1,3})"
QUANTITIES: tuple[tuple[str, Callable[[Match[str], Scene], Quantity]], ...] = (
    (rf"{_KIND}\.{_K}\.(?P<what>.+)", _special),
    (rf"{_KIND}s", _count),
    (r"at\((?P<value>[^,()]+)(?:,\s*(?P<branch>[0-9]{1,3})\s*)?\)\.(?P<what>.+)", _at),
    (r"locus\((?P<value>[^(),]+)\)", _locus),
    (rf"buckling\.{_K}", _buckling),
)
