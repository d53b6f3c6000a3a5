"""What is recorded of the points of a branch: rows of plain numbers, and their names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import chain
from typing import Any

import numpy as np

from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import analyse, relative_error
from ribbonopt.checks.zero_moment import lacks_linearisation, unknown_of
from ribbonopt.errors import ModelError
from ribbonopt.plain import Row, finite
from ribbonopt.scene import ContinuationStage, Scene
from ribbonopt.scene.faults import suggestion
from ribbonopt.scene.lens import value_at
from ribbonopt.scene.quantities import ANSWERS, START_VECTORS
from ribbonopt.scene.stages import parse_record, stages_of, words_of
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution

from .curve import Curve
from .frequencies import frequencies, names_of
from .stops import conditions_of
from .walk.points import POINT, Point

#: numbers that every row has, besides the parameters and what the scene records
NUMBERS = (
    *("error", *ANSWERS),
    *("number", "stage", "branch", "negative", "intervals", "iterations"),
)
SOFTEST = "softest"  # a number of rows where a stage asks for it
OF = "of"  # kind of the special points that a locus is of
WORDS = (OF, "parameter", "kind", "origin", "switches", "note")
VALUE = "value"  # stands for the parameter that a row's own stage moves
PARAMETERS = "parameters."


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
        stages = stages_of(scene)
        self.parameters = tuple(dict.fromkeys(chain.from_iterable(s.paths for s in stages)))
        self.measured = any(stage.measured for stage in stages)
        self.located = any(stage.is_locus for stage in stages)
        self.frequencies = names_of(stages)
        for name in self.formulas:
            if name in (*NUMBERS, *WORDS, VALUE, SOFTEST, *self.frequencies, *self.parameters):
                raise ModelError(
                    f"record.{name}: every row has {name!r} already; choose another name",
                    f"record.{name}",
                )
        for stage in stages:
            for text, left, _, right in conditions_of(stage):
                if fault := self.fault_of((*words_of(left), *words_of(right))):
                    raise ModelError(f"continuation.stop: {text!r}: {fault}", "continuation")

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all numbers of a row."""
        softest = [SOFTEST] if self.measured else []
        return (*self.parameters, *NUMBERS, *softest, *self.frequencies, *self.formulas)

    @property
    def short(self) -> dict[str, str]:
        """Columns by other names: a parameter of the scene by its own, as formulas call it."""
        paths = [path for path in self.parameters if path.startswith(PARAMETERS)]
        others = {path.removeprefix(PARAMETERS): path for path in paths}
        return {name: path for name, path in others.items() if name not in self.names}

    def column(self, word: str) -> str:
        """Return the column that a word means, VALUE for itself; the word where it means none."""
        return self.short.get(word, word)

    def fault_of(self, words: Iterable[str]) -> str:
        """Return what is wrong with words that should be names of numbers; "" if nothing."""
        for word in words:
            if word != VALUE and self.column(word) not in self.names:
                near = suggestion(word, [*self.names, *self.short])
                known = ", ".join((*self.names, *self.short, VALUE))
                return (
                    f"found {word!r}, expected a recorded quantity{near}: {known}; "
                    "add others under `record`"
                )
        return ""

    def row(self, point: Point[Solution], curve: Curve) -> dict[str, Any]:
        """Return what is recorded of a point, in the units of the scene."""
        solution, stage = point.solution, curve.stage
        row: dict[str, Any] = {
            "number": point.number,
            "stage": point.stage,
            "branch": point.branch,
            "origin": point.origin,
            "parameter": stage.moved,
            **self._parameters(solution.scene, stage, curve.value(point.position)),
            "kind": point.kind,
            "negative": None,
            # At a fold the equations at a given parameter are singular: so is their estimate.
            "error": curve.error_of(point),
        }
        if self.located:
            row[OF] = stage.of
        if point.kind == POINT and not stage.is_locus:
            row["negative"] = _negative(solution) if stage.stability else None
            row["error"] = error_of(solution)
        row |= self.varying(point, curve)
        row["switches"] = solution.switch_points.tolist()
        row["intervals"] = solution.dense.blocks.layout.element_count
        if self.measured:
            row[SOFTEST] = _softest(solution) if stage.measured and point.kind == POINT else None
        if self.frequencies:
            row |= dict.fromkeys(self.frequencies)
            if stage.modes and point.kind == POINT:
                row |= frequencies(solution, stage.modes)
        row["iterations"] = solution.iterations
        told = [*unknown_of(solution), *solution.given_up, *solution.fell_back]
        if row["negative"] is not None and solution.scene.states == "planar":
            told.append(_told_of_plane(solution))
        row["note"] = "; ".join(filter(None, [point.note, *told]))
        return row

    def _parameters(
        self, scene: Scene, stage: ContinuationStage, value: float
    ) -> dict[str, float | None]:
        """Values of the parameters of all stages: of the others as they are in the scene."""
        given = {path: value_at(scene, path) for path in self.parameters if path != stage.moved}
        return {path: given.get(path, value) for path in self.parameters}

    def named(self, row: Mapping[str, Any], stage: ContinuationStage) -> Row:
        """Return a row of a stage with the numbers by all their names, as conditions may say."""
        others = {name: row.get(path) for name, path in self.short.items()}
        return {**row, VALUE: row.get(stage.moved), **others}

    def varying(self, point: Point[Solution], curve: Curve) -> dict[str, float | None]:
        """Return the numbers of a row that vary along a branch, in the units of the scene."""
        solution, value = point.solution, curve.value(point.position)
        found = numbers_of(solution) | sampled(solution, self.formulas)
        return {**self._parameters(solution.scene, curve.stage, value), **found}


def value_of(row: Mapping[str, Any]) -> float:
    """Return the value of the parameter that the stage of a row moves."""
    return float(row[row["parameter"]])


def error_of(solution: Solution) -> float | None:
    """Relative error of the answer, a bound; None where it is not known.

    So for minima on one mesh, singular equations and those without slope, and on meshes that step
    over layers.
    """
    if alone(solution) or lacks_linearisation(solution):
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


def numbers_of(solution: Solution) -> dict[str, float | None]:
    """Return energy, potential, H, loads (lab frame) and strains at the start, in scene units."""
    row: dict[str, float | None] = {"energy": solution.energy, "potential": potential(solution)}
    row["H0"] = float(solution.start["H"])
    for names, vector in zip(START_VECTORS, (solution.n0, solution.m0, solution.u0), strict=True):
        row |= {name: float(value) for name, value in zip(names, vector, strict=True)}
    return row


def _negative(solution: Solution) -> int | None:
    from ribbonopt.checks.stability import negative_directions  # builds second derivatives

    return negative_directions(solution)


def _told_of_plane(solution: Solution) -> str:
    from ribbonopt.checks.stability import told_of_plane  # as above

    return told_of_plane(solution)


def _softest(solution: Solution) -> float | None:
    from ribbonopt.checks.softest import softest  # builds second derivatives

    found = softest(solution)
    return None if isinstance(found, str) else found.eigenvalue
