"""What is recorded of the points of a branch, and the conditions that end it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ribbonopt.accuracy.estimate import analyse, relative_error
from ribbonopt.checks.zero_moment import lacks_linearisation, unknown_of
from ribbonopt.errors import ModelError
from ribbonopt.plain import Row, finite
from ribbonopt.scene import Scene
from ribbonopt.scene.quantities import ANSWERS, START_VECTORS
from ribbonopt.scene.stages import parse_record, stages_of, words_of
from ribbonopt.solution.solution import Solution

from .curve import Curve
from .stops import Stops, conditions_of
from .walk.points import POINT, Point

#: numbers that every row has, besides what the scene records
NUMBERS = (
    *("value", "error", *ANSWERS),
    *("number", "stage", "branch", "negative", "intervals", "iterations"),
)
WORDS = ("parameter", "kind", "origin", "switches", "note")


class Recorder:
    """Rows of plain numbers: loads and strains at the start, energy, and what the scene records."""

    def __init__(self, scene: Scene) -> None:
        """Read the formulas of a scene.

        Raises
        ------
        ModelError
            If a condition of a stage names what is not recorded.
        """
        self.formulas = {name: parse_record(text, scene) for name, text in scene.record.items()}
        for name in self.formulas:
            if name in (*NUMBERS, *WORDS):
                raise ModelError(
                    f"record.{name}: every row has {name!r} already; choose another name",
                    f"record.{name}",
                )
        for stage in stages_of(scene):
            for text, left, _, right in conditions_of(stage):
                for side in (left, right):
                    self.known(words_of(side), f"continuation.stop: {text!r}", "continuation")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all numbers of a row."""
        return (*NUMBERS, *self.formulas)

    def known(self, words: Iterable[str], where: str, key: str = "") -> None:
        """Raise a ModelError where a word is none of the names of a row."""
        for word in words:
            if word not in self.names:
                raise ModelError(
                    f"{where}: found {word!r}, expected a recorded quantity: "
                    f"{', '.join(self.names)}; add others under `record`",
                    key,
                )

    def row(self, point: Point[Solution], curve: Curve) -> dict[str, Any]:
        """Return what is recorded of a point, in the units of the scene."""
        solution, stage = point.solution, curve.stage
        row: dict[str, Any] = {
            "number": point.number,
            "stage": point.stage,
            "branch": point.branch,
            "origin": point.origin,
            "parameter": stage.parameter,
            "value": curve.value(point.position),
            "kind": point.kind,
            "negative": _negative(solution) if stage.stability and point.kind == POINT else None,
            # At a fold the equations at a given parameter are singular: so is their estimate.
            "error": error_of(solution) if point.kind == POINT else None,
        }
        row |= self.varying(point, curve)
        row["switches"] = solution.switch_points.tolist()
        row["intervals"] = solution.dense.blocks.layout.element_count
        row["iterations"] = solution.iterations
        told = (*unknown_of(solution), *solution.given_up, *solution.fell_back)
        row["note"] = "; ".join(filter(None, [point.note, *told]))
        return row

    def varying(self, point: Point[Solution], curve: Curve) -> dict[str, float | None]:
        """Return the numbers of a row that vary along a branch, in the units of the scene."""
        found = sampled(point.solution, self.formulas)
        return {"value": curve.value(point.position), **numbers_of(point.solution), **found}


@dataclass(frozen=True, eq=False)
class StageRecords:
    """What is recorded of the points of one stage."""

    recorder: Recorder
    curve: Curve

    def row(self, point: Point[Solution]) -> Row:
        """Return what is recorded of a point."""
        return self.recorder.row(point, self.curve)

    @cached_property
    def stops(self) -> Stops:
        """What ends the stage."""
        return Stops(self.curve.stage)

    def stopped(self, row: Mapping[str, Any]) -> str:
        """Return the condition of the stage that a row meets, "" if none."""
        return self.stops.met(row)

    def stopped_at(self, kind: str, count: int) -> str:
        """Return what ends the stage at the special point of a kind and number, "" if nothing."""
        return self.stops.met_at(kind, count)

    def margins(self, point: Point[Solution]) -> dict[str, float]:
        """Return how far a point is beyond the conditions on what varies along the branch.

        Counts jump, and bounds of the error are none: conditions on them are met as they come.
        """
        if not self.stops.conditions:
            return {}
        return self.stops.margins(self.recorder.varying(point, self.curve))


def error_of(solution: Solution) -> float | None:
    """Relative error of the answer, a bound; None where it is not known.

    So for minima, singular equations and those without slope, and on meshes that step over layers.
    """
    if solution.problem.recovered or lacks_linearisation(solution):
        return None
    try:
        return relative_error(solution)[0] if analyse(solution).known else None
    except np.linalg.LinAlgError:
        return None


def sampled(
    solution: Solution, formulas: Mapping[str, tuple[str, float]]
) -> dict[str, float | None]:
    """Return the values of formulas at arclengths; None for what is not finite."""
    with np.errstate(all="ignore"):
        values = {name: float(solution.sample(s, text)) for name, (text, s) in formulas.items()}
    found: dict[str, float | None] = finite(values)
    return found


def numbers_of(solution: Solution) -> dict[str, float]:
    """Return energy, invariant, loads (lab frame) and strains at the start, in scene units."""
    row = {"energy": solution.energy, "H0": float(solution.start["H"])}
    for names, vector in zip(START_VECTORS, (solution.n0, solution.m0, solution.u0), strict=True):
        row |= {name: float(value) for name, value in zip(names, vector, strict=True)}
    return row


def _negative(solution: Solution) -> int | None:
    from ribbonopt.checks.stability import negative_directions  # builds second derivatives

    return negative_directions(solution)
