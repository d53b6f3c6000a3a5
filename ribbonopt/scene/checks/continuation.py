"""Faults of what a scene records and of the stages of its continuation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise

from ribbonopt.scene.continuation import ContinuationStage
from ribbonopt.scene.faults import InvalidSceneError, KeyPath, Problem, dotted
from ribbonopt.scene.formulas.parsing import FormulaError
from ribbonopt.scene.lens import fault_of, with_value
from ribbonopt.scene.model import Scene
from ribbonopt.scene.quantities import OUTPUTS
from ribbonopt.scene.schema.validation import validate
from ribbonopt.scene.stages import (
    GRAMMAR,
    begin_of,
    end_of,
    ends_of,
    located_stages,
    parse_record,
    parse_scalar,
    parse_stop,
    special_stop,
    words_of,
)
from ribbonopt.scene.wording import written
from ribbonopt.text import is_word

from .locus import branch_scenes, locus_faults, way_faults

Check = Callable[[Scene], list[Problem]]


def check_continuation(scene: Scene, check: Check | None) -> list[Problem]:
    """Return what is wrong with `record` and `continuation`.

    Parameters
    ----------
    scene
        A scene whose single values are valid.
    check
        How to check the scenes at the ends of stages, which are not continued; None where all the
        rest of this scene is not sound, so that they would tell nothing.
    """
    problems = [*_records(scene)]
    if scene.continuation == ():
        problems.append(Problem(("continuation",), "expected at least one stage; or remove it"))
    now, check = scene, None if problems else check
    before: ContinuationStage | None = None
    for path, stage in located_stages(scene):
        found = [*_form(stage, scene, path), *locus_faults(stage, now, path, before)]
        before = stage
        if fault := fault_of(now, stage.moved):
            found.append(Problem((*path, "parameter"), fault))
        elif not found:
            found = list(_way(stage, now, path))
            if check and not found:
                found = list(_bad_ends(stage, now, path, check))
        end = end_of(stage)
        if not found and end is not None:
            now = with_value(now, stage.moved, end)
        problems += found
    return problems


def _records(scene: Scene) -> Iterator[Problem]:
    for name, text in scene.record.items():
        path: KeyPath = ("record", name)
        if not is_word(name) or name in GRAMMAR:
            message = "is no name for a record; use letters, digits and _, and no word of formulas"
            yield Problem(path, message)
        try:
            parse_record(text, scene)
        except FormulaError as error:
            yield Problem(path, str(error))


def _form(stage: ContinuationStage, scene: Scene, path: KeyPath) -> Iterator[Problem]:
    """Yield what is wrong with a stage whatever its parameter is."""
    if stage.to is None and stage.values is None:
        yield Problem(path, 'found neither `to` nor `values`; add for example "to: 0.1"')
    if stage.to is not None and stage.values is not None:
        message = "stands beside `values`, which say where the stage ends; keep one of the two"
        yield Problem((*path, "to"), message)
    if stage.values is not None:
        steps = [b - a for a, b in pairwise(stage.values)]
        if not stage.values or not (all(d > 0 for d in steps) or all(d < 0 for d in steps)):
            message = "expected at least one number, all increasing or all decreasing; write for "
            found = ", ".join(f"{value:g}" for value in stage.values)
            yield Problem((*path, "values"), f'{message}example "values: [1, 2, 3]"', f"[{found}]")
    sizes = {name: getattr(stage, name) for name in ("smallest", "first", "largest")}
    given = [(name, size) for name, size in sizes.items() if size is not None]
    for (small, a), (large, b) in pairwise(given):
        if a > b:
            message = f"step sizes reversed: {small} {a:g} > {large} {b:g}; expected smallest <= "
            yield Problem((*path, small), f"{message}first <= largest, so exchange the two")
    if stage.modes and scene.ribbon is not None and scene.ribbon.density is None:
        message = "frequencies in Hz need the density of the ribbon, in kg/m^3; write for example "
        yield Problem((*path, "modes"), f'{message}"density: 1390" under ribbon', f"{stage.modes}")
    for index, text in enumerate(stage.stop):
        yield from _stop(text, stage, scene, (*path, "stop", index))


def _stop(text: str, stage: ContinuationStage, scene: Scene, path: KeyPath) -> Iterator[Problem]:
    """Yield what is wrong with something that ends a stage."""
    try:
        if special := special_stop(text):
            if not stage.special:
                message = f"{special[0]}s are not located with special: false; remove one of the"
                yield Problem(path, f"{message} two", repr(text))
            return
        left, _, right = parse_stop(text)
        # What else is recorded is not known here: any other word may name a number.
        others = sorted({*words_of(text), *scene.record} - OUTPUTS.keys())
        for side in (left, right):
            parse_scalar(side, {**OUTPUTS, **dict.fromkeys(others, "scalar")})
    except FormulaError as error:
        yield Problem(path, str(error))


def _way(stage: ContinuationStage, scene: Scene, path: KeyPath) -> Iterator[Problem]:
    """Yield what is wrong with where a stage begins and ends."""
    begin, ends = begin_of(stage, scene), ends_of(stage)
    if stage.is_locus:
        yield from way_faults(stage, scene, path)
    elif stage.values and stage.from_ not in (None, stage.values[0]):
        message = f"stands beside `values`, which begin at {stage.values[0]:g}; remove it"
        yield Problem((*path, "from"), message, f"{begin:g}")
    if isinstance(stage.to, tuple):
        if not min(stage.to) < begin < max(stage.to):
            message = f"of which one is to be below and one above where {stage.moved} begins, "
            message += f"{begin:g}; for one direction write one number"
            yield Problem((*path, "to"), message, written(stage.to))
    elif not stage.values and begin in ends:
        message = f"which is where {stage.moved} begins; expected another value, or remove the"
        yield Problem((*path, "to"), f"{message} stage", f"{begin:g}")
    named = {"values": min(stage.values)} if stage.values else {"from": begin, "to": min(ends)}
    for key, value in named.items():
        if stage.scale == "log" and value <= 0:
            message = 'expected a number > 0, for the logarithm; or write "scale: linear"'
            yield Problem((*path, key), message, f"{value:g}")


def _bad_ends(
    stage: ContinuationStage, scene: Scene, path: KeyPath, check: Check
) -> Iterator[Problem]:
    """Yield the end values of a stage that no scene may have."""
    ends: dict[KeyPath, float | None] = {("from",): stage.from_}
    if stage.values:
        ends = {("values", i): stage.values[i] for i in (0, len(stage.values) - 1)}
    elif isinstance(stage.to, tuple):
        ends |= {("to", i): value for i, value in enumerate(stage.to)}
    else:
        ends |= {("to",): stage.to}
    trials = [
        ((*path, *key), value, _alone(with_value(scene, stage.moved, value)))
        for key, value in ends.items()
        if value is not None  # else the scene's own value, or where another stage ended
    ]
    for where, value, trial in [*trials, *branch_scenes(stage, scene, path)]:
        try:
            problems = check(validate(Scene, trial))
        except InvalidSceneError as error:
            problems = list(error.problems)
        for problem in problems:
            message = "which makes no valid scene; choose another value: "
            message += f"{dotted(problem.path)}: {problem}"
            yield Problem(where, message, f"{value:g}")


def _alone(scene: Scene) -> Scene:
    """Return a scene without what is followed from it."""
    return replace(scene, continuation=None, map=None)
