"""Stages of a continuation in their order, what is recorded and watched, and faults of both."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Literal

from ribbonopt.scene.continuation import ContinuationStage
from ribbonopt.scene.faults import InvalidSceneError, Path, Problem, dotted
from ribbonopt.scene.formulas.expressions import Shape
from ribbonopt.scene.formulas.parsing import (
    RESERVED,
    FormulaError,
    evaluate_value,
    parse_expression,
)
from ribbonopt.scene.lens import fault_of, value_at, with_value
from ribbonopt.scene.model import Scene
from ribbonopt.scene.schema.validation import validate

from .whole import check

OUTPUTS: dict[str, Shape] = {
    **dict.fromkeys(("r", "d1", "d2", "d3", "n", "m", "u"), "vector"),
    **dict.fromkeys(("n1", "n2", "n3", "m1", "m2", "m3", "u2", "u3"), "scalar"),
    **dict.fromkeys(("eta", "energy", "H", "n_dot_m"), "scalar"),
}
"""What a solution has at every arclength, by name (see `Solution.sample`)."""

_AT = re.compile(r"(.*)\sat\s(.*)", re.DOTALL)
_WORD = re.compile(r"[A-Za-z_]\w*")
_STOP = "expected 'A > B' or 'A < B', such as 'energy > 30'"
_Located = tuple[Path, ContinuationStage]


def stages_of(scene: Scene) -> tuple[ContinuationStage, ...]:
    """Return the stages of a scene with every `from_` filled in, in the units of the scene.

    A stage begins at its own `from_` or first value, or else where an earlier stage left its
    parameter, or else at the scene's own value.

    Raises
    ------
    SceneError
        If a parameter is no number of the scene.
    """
    stages = []
    for _, stage in _located(scene):
        begin, end = _begin(stage, scene), _end(stage)
        stages.append(replace(stage, from_=begin))
        scene = scene if end is None else with_value(scene, stage.parameter, end)
    return tuple(stages)


def parse_record(text: str, scene: Scene) -> tuple[str, float]:
    """Return the formula of a record such as "dot(r, ex) at 0.5" and its arclength.

    Without an arclength, a number or a formula of parameters, it is the end of the interval.

    Raises
    ------
    FormulaError
        If the formula is no scalar of named outputs, or the arclength is outside the interval.
    """
    start, end = scene.interval
    split = _AT.fullmatch(text)
    formula, place = (part.strip() for part in split.groups()) if split else (text.strip(), "")
    _parse_scalar(formula, OUTPUTS)
    s = evaluate_value(place, scene.parameters) if split else end
    if not start <= s <= end:
        message = f"found arclength {s:g}, expected one from {start:g} to {end:g}, the interval"
        raise FormulaError(text, None, f"{message}; write for example '{formula} at {end:g}'")
    return formula, s


def parse_stop(text: str) -> tuple[str, Literal[">", "<"], str]:
    """Return both sides of a condition such as "energy > 30", and its sign.

    Raises
    ------
    FormulaError
        If it is not two formulas with one sign > or < between them.
    """
    for sign in (">=", "<=", "=>", "=<", "=="):
        if sign in text:
            raise FormulaError(text, text.index(sign), f"found {sign!r}, {_STOP}")
    signs = [character for character in text if character in "<>"]
    if len(signs) != 1:
        found = f"{len(signs)} signs" if signs else "no sign"
        raise FormulaError(text, None, f"found {found} > or <, {_STOP}")
    left, right = (side.strip() for side in text.split(signs[0]))
    if not (left and right):
        raise FormulaError(text, text.index(signs[0]), f"found nothing beside it, {_STOP}")
    return left, ">" if signs[0] == ">" else "<", right


def words_of(text: str) -> list[str]:
    """Return the words of a formula that are not its grammar's own: names of quantities."""
    return [word for word in _WORD.findall(text) if word not in RESERVED - OUTPUTS.keys()]


def check_continuation(scene: Scene, *, sound: bool) -> list[Problem]:
    """Return what is wrong with `record` and `continuation`.

    Parameters
    ----------
    scene
        A scene whose single values are valid.
    sound
        Whether all the rest of it is: only then do the scenes at the ends of stages tell anything.
    """
    problems = [*_records(scene)]
    if scene.continuation == ():
        problems.append(Problem(("continuation",), "expected at least one stage; or remove it"))
    now, sound = scene, sound and not problems
    for path, stage in _located(scene):
        found = list(_form(stage, scene, path))
        if fault := fault_of(now, stage.parameter):
            found.append(Problem((*path, "parameter"), fault))
        elif not found:
            found = list(_way(stage, now, path))
            if sound and not found:
                found = list(_bad_ends(stage, now, path))
        end = _end(stage)
        if not found and end is not None:
            now = with_value(now, stage.parameter, end)
        problems += found
    return problems


def _located(scene: Scene) -> Iterator[_Located]:
    if isinstance(scene.continuation, ContinuationStage):
        yield ("continuation",), scene.continuation
    else:
        for index, stage in enumerate(scene.continuation or ()):
            yield ("continuation", index), stage


def _begin(stage: ContinuationStage, scene: Scene) -> float:
    if stage.from_ is None and stage.values:
        return stage.values[0]
    own = value_at(scene, stage.parameter)
    return own if stage.from_ is None else stage.from_


def _end(stage: ContinuationStage) -> float | None:
    return stage.values[-1] if stage.values else stage.to


def _parse_scalar(text: str, names: dict[str, Shape]) -> None:
    if parse_expression(text, names).shape == "vector":
        remedy = "write for example dot(r, ex) or norm(r)"
        raise FormulaError(text, None, f"found a vector, expected a scalar; {remedy}")


def _records(scene: Scene) -> Iterator[Problem]:
    for name, text in scene.record.items():
        path: Path = ("record", name)
        if not (name.isascii() and name.isidentifier()) or name in RESERVED - OUTPUTS.keys():
            message = "is no name for a record; use letters, digits and _, and no word of formulas"
            yield Problem(path, message)
        try:
            parse_record(text, scene)
        except FormulaError as error:
            yield Problem(path, str(error))


def _form(stage: ContinuationStage, scene: Scene, path: Path) -> Iterator[Problem]:
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
    for index, text in enumerate(stage.stop):
        try:
            left, _, right = parse_stop(text)
            # What else is recorded is not known here: any other word may name a number.
            words: dict[str, Shape] = dict.fromkeys(set(_WORD.findall(text)) - RESERVED, "scalar")
            for side in (left, right):
                _parse_scalar(side, words | OUTPUTS | dict.fromkeys(scene.record, "scalar"))
        except FormulaError as error:
            yield Problem((*path, "stop", index), str(error))


def _way(stage: ContinuationStage, scene: Scene, path: Path) -> Iterator[Problem]:
    """Yield what is wrong with where a stage begins and ends."""
    begin, end = _begin(stage, scene), _end(stage)
    if stage.values and stage.from_ not in (None, stage.values[0]):
        message = f"stands beside `values`, which begin at {stage.values[0]:g}; remove it"
        yield Problem((*path, "from"), message, f"{begin:g}")
    if not stage.values and begin == end:
        message = f"which is where {stage.parameter} begins; expected another value, or remove the"
        yield Problem((*path, "to"), f"{message} stage", f"{end:g}")
    ends = {"values": min(stage.values)} if stage.values else {"from": begin, "to": end}
    for key, value in ends.items():
        if stage.scale == "log" and value is not None and value <= 0:
            message = 'expected a number > 0, for the logarithm; or write "scale: linear"'
            yield Problem((*path, key), message, f"{value:g}")


def _bad_ends(stage: ContinuationStage, scene: Scene, path: Path) -> Iterator[Problem]:
    """Yield the end values of a stage that no scene may have."""
    ends: dict[Path, float | None] = {("from",): stage.from_, ("to",): stage.to}
    if stage.values:
        ends = {("values", i): stage.values[i] for i in (0, len(stage.values) - 1)}
    for key, value in ends.items():
        if value is None:
            continue  # the scene's own value, or where another stage ended
        trial = replace(with_value(scene, stage.parameter, value), continuation=None)
        try:
            problems = check(validate(Scene, trial))
        except InvalidSceneError as error:
            problems = list(error.problems)
        for problem in problems:
            message = "which makes no valid scene; choose another value: "
            message += f"{dotted(problem.path)}: {problem}"
            yield Problem((*path, *key), message, f"{value:g}")
