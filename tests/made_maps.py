"""A map whose work costs nothing: a planar arch, folds and counts of which are written down.

Folds of the arch of which one clamp is turned are where angle = c sqrt(shortening); the number of
stable shapes is two before the first and one behind it.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ribbonopt.errors import ConvergenceError
from ribbonopt.plain import Row
from ribbonopt.studies.batch.study import StudyRibbon

X, Y = "parameters.angle", "parameters.shortening"
SCENE = """\
name: made
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {angle: 0, shortening: 0.1, idle: 1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 1 - shortening], directors: {turns: [{y: angle*deg}]}}
states: planar
labels: {angle: "angle (degrees)"}
map:
  parameters: {parameters.angle: [0, 80], parameters.shortening: [0.05, 0.4]}
"""
SLOPES = (102.0, 107.0, 128.0)  # degrees over sqrt(shortening): of three folds


def folds(y: float) -> list[float]:
    return [float(c * np.sqrt(y)) for c in SLOPES]


def done(ribbon: StudyRibbon, slopes: Sequence[float] = SLOPES, wrong: bool = False) -> Row:
    """The row of a job; where `wrong`, one region has a shape too few."""
    row: Row = {"number": ribbon.number, "scene": "made", **ribbon.inputs}
    row |= {"status": "converged", "verified": True, "message": "", "seconds": 0.0}
    if ribbon.task == "line":
        row |= _line(ribbon.inputs, slopes)
    elif ribbon.task == "locus":
        row |= _locus(ribbon.inputs["point"], slopes)
    else:
        row |= _count(ribbon.inputs[X], ribbon.inputs[Y], wrong)
    return row


def _line(inputs: Row, slopes: Sequence[float]) -> Row:
    y = inputs[Y]
    specials = [
        {
            **inputs,
            X: float(c * np.sqrt(y)),
            "kind": "fold",
            "branch": 0,
            "folder": "map-branches/1/1",
            "near": {"point": i, "value": float(c * np.sqrt(y)) - 1},
            "point": i,
        }
        for i, c in enumerate(slopes)
    ]
    inside = [special for special in specials if special[X] <= 80]
    return {"branches": 1, "seeds": 6, "endings": ["at its end"], "specials": inside}


def _locus(number: int, slopes: Sequence[float]) -> Row:
    ways = (np.linspace(0.2, 0.05, 12), np.linspace(0.2, 0.4, 12))
    points = [
        {
            "number": n,
            "stage": 1,
            "branch": way,
            "kind": "point",
            "error": 1e-10,
            "negative": number,
            X: float(slopes[number] * np.sqrt(y)),
            Y: float(y),
        }
        for way, ys in enumerate(ways)
        for n, y in enumerate(ys)
    ]
    return {"points": points, "ending": "at its end"}


def _count(x: float, y: float, wrong: bool) -> Row:
    indices = [0]  # negative directions of each shape
    for lower, fold in enumerate(folds(y)):
        indices += [lower, lower + 1] if x < fold else []
    if wrong and x < folds(y)[0]:
        indices.remove(0)
    shapes = [{"energy": float(1 + k), "negative": k, "stable": k == 0} for k in sorted(indices)]
    stable = sum(shape["stable"] for shape in shapes)
    return {"count": len(shapes), "stable": stable, "shapes": shapes, "told": "made up"}


class MadeCrew:
    """Stands for `crew.Crew`: does what is asked at once, and dies when it has had enough."""

    asked: ClassVar[list[str]] = []
    alive: ClassVar[int | None] = None  # jobs until it dies

    def __init__(self, folder: str, jobs: int | None = None) -> None:
        self.folder = folder

    def rows(self, ribbons: Sequence[StudyRibbon]) -> Iterator[Row]:
        for ribbon in ribbons:
            if MadeCrew.alive == 0:
                raise ConvergenceError("died", "workers_lost")
            if MadeCrew.alive is not None:
                MadeCrew.alive -= 1
            MadeCrew.asked.append(ribbon.place)
            (Path(self.folder) / ribbon.place).mkdir(parents=True)
            yield self.done(ribbon)

    def done(self, ribbon: StudyRibbon) -> Row:
        return done(ribbon)

    def close(self) -> None:
        """Nothing to end."""

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(name)
