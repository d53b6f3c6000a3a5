"""Runs of the walk on the curves of `dense_curves`, from the start or from a history."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from dense_curves import Dense, DenseStage, Straight, Unit

from ribbonopt.studies.continuation.walk.branches import Key, Nothing, Register
from ribbonopt.studies.continuation.walk.points import POINT, Point
from ribbonopt.studies.continuation.walk.stages import followed
from ribbonopt.studies.continuation.walk.walk import Ending

Array = np.ndarray


class Run(NamedTuple):
    """Points by kind and branch, and endings."""

    points: list[Point[Unit]]
    endings: dict[Key, Ending]

    def of(self, kind: str = POINT, branch: int = 0, stage: int = 0) -> list[Array]:
        return [
            point.row["z"]
            for point in self.points
            if (point.kind, point.branch, point.stage) == (kind, branch, stage)
        ]


def run(
    stages: Sequence[DenseStage],
    known: Iterable[Point[Unit]] = (),
    ended: Mapping[Key, Ending] | None = None,
) -> Run:
    """Follow stages to their end; one without a begin starts where the one before has ended.

    `known` are points of a history, `ended` its endings.
    """

    def stage_after(
        number: int, before: Point[Unit] | None, special: Point[Unit] | None
    ) -> DenseStage:
        stage = stages[number]
        if before is None or len(stage.begin):
            return stage
        return replace(stage, begin=before.row["z"])

    register, known = Register(), list(known)
    history = Known(known, dict(ended or {})) if known else Nothing()
    points = list(followed(len(stages), stage_after, register, history))
    return Run([*known, *points], register.endings)


class Known:
    """A history in memory."""

    def __init__(self, points: list[Point[Unit]], endings: dict[Key, Ending]) -> None:
        self.endings = endings
        self.all = points

    def points(self, stage: int, branch: int, kind: str) -> list[Point[Unit]]:
        wanted = stage, branch, kind
        return [point for point in self.all if (point.stage, point.branch, point.kind) == wanted]


def stage(curve: Dense, range_: Straight, begin: Iterable[float], **others: object) -> DenseStage:
    return DenseStage(curve, range_, np.array(list(begin), dtype=float), **others)
