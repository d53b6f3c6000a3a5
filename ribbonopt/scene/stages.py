"""Stages of a continuation in their order, and what is recorded and watched on the way, parsed."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Literal

from .continuation import ContinuationStage
from .faults import KeyPath
from .formulas.parsing import FormulaError, evaluate_value, parse_expression
from .formulas.words import RESERVED
from .lens import value_at, with_value
from .limits import COUNTED
from .model import Scene
from .quantities import OUTPUTS, Shape

#: words that no record and no condition can name, because formulas need them
GRAMMAR = RESERVED - OUTPUTS.keys()

_AT = re.compile(r"(.*)\sat\s(.*)", re.DOTALL)
_WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*")  # not the e of 1e3
_KINDS = "fold|branch point|buckling point|kink|cusp|isola centre|crossing|double point|turn"
_SPECIAL = re.compile(rf"(?:([0-9]+) +)?({_KINDS})(s?)")
_STOP = (
    "expected 'A > B' or 'A < B', such as 'energy > 30'; or fold, branch point, buckling point, "
    "kink, or a number of them, such as '2 folds'"
)


def stages_of(scene: Scene) -> tuple[ContinuationStage, ...]:
    """Return the stages of a scene with every `from_` filled in, in the units of the scene.

    A stage begins at its own `from_` or first value, or else where an earlier stage left its
    parameter, or else at the scene's own value. A locus that is followed from a branch of its own
    is two stages: that branch, up to its special point, and the locus.

    Raises
    ------
    SceneError
        If a parameter is no number of the scene.
    """
    stages: list[ContinuationStage] = []
    for _, stage in followed_stages(scene):
        begin, end = begin_of(stage, scene), end_of(stage)
        between = stage.between or (extent_of(stages[-1]) if stage.is_locus and stages else None)
        stages.append(replace(stage, from_=begin, between=between))
        scene = scene if end is None else with_value(scene, stage.moved, end)
    return tuple(stages)


def extent_of(stage: ContinuationStage) -> tuple[float, float]:
    """Return the least and the largest value that a stage goes to, whose `from_` is given."""
    assert stage.from_ is not None
    places = stage.from_, *ends_of(stage)
    return min(places), max(places)


def followed_stages(scene: Scene) -> Iterator[tuple[KeyPath, ContinuationStage]]:
    """Yield the stages as they are followed, each with where it stands: two for some loci."""
    before = None
    for path, stage in located_stages(scene):
        # What the stage before has moved is where it has stopped.
        begun = stage.branch is not None or before == stage.paths[0]
        if stage.is_locus and stage.of and stage.between and not begun:
            yield path, branch_of(stage, stage.of, stage.between)
        yield path, stage
        before = stage.moved


def branch_of(
    locus: ContinuationStage, kind: str, between: tuple[float, float]
) -> ContinuationStage:
    """Return the stage up to the special point that a locus begins with."""
    stop = kind if locus.number == 1 else f"{locus.number} {kind}s"
    begin, end = between
    return ContinuationStage(
        locus.paths[0], to=end, from_=begin, stop=(stop,), stability=locus.stability
    )


def located_stages(scene: Scene) -> Iterator[tuple[KeyPath, ContinuationStage]]:
    """Yield the stages as they are written, each with where it stands."""
    if isinstance(scene.continuation, ContinuationStage):
        yield ("continuation",), scene.continuation
    else:
        for index, stage in enumerate(scene.continuation or ()):
            yield ("continuation", index), stage


def begin_of(stage: ContinuationStage, scene: Scene) -> float:
    """Return where a stage begins in a scene to which earlier stages have led."""
    if stage.from_ is None and stage.values and not stage.is_locus:
        return stage.values[0]
    own = value_at(scene, stage.moved)
    return own if stage.from_ is None else stage.from_


def ends_of(stage: ContinuationStage) -> tuple[float, ...]:
    """Return where a stage ends: nowhere that it says, at one value, or at two."""
    if stage.values:
        return stage.values[-1:]
    if isinstance(stage.to, tuple):
        return stage.to
    return () if stage.to is None else (stage.to,)


def end_of(stage: ContinuationStage) -> float | None:
    """Return where a stage ends at last; None where it does not say."""
    return next(reversed(ends_of(stage)), None)


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
    parse_scalar(formula, OUTPUTS)
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


def special_stop(text: str) -> tuple[str, int] | None:
    """Return the kind and the number of special points that a text ends a stage at.

    None where it names none, so that it should be a condition.

    Raises
    ------
    FormulaError
        If the number and the word do not go together.
    """
    named = _SPECIAL.fullmatch(text.strip())
    if named is None:
        return None
    digits, kind, several = named[1] or "1", named[2], bool(named[3])
    count = int(digits) if len(digits) <= len(str(COUNTED)) else COUNTED + 1
    if count > COUNTED:
        raise FormulaError(text, None, f"found a number too large, expected at most {COUNTED}")
    if count < 1 or several != (count > 1):
        example = f"'{kind}', or '2 {kind}s' for the second one"
        raise FormulaError(text, None, f"found a number that does not fit, expected {example}")
    return kind, count


def parse_scalar(text: str, names: Mapping[str, Shape]) -> None:
    """Raise a FormulaError where a text is no formula of some names, or is a vector."""
    if parse_expression(text, names).shape == "vector":
        remedy = "write for example dot(r, ex) or norm(r)"
        raise FormulaError(text, None, f"found a vector, expected a scalar; {remedy}")


def words_of(text: str) -> list[str]:
    """Return the words of a formula that are not its grammar's own: names, dotted paths."""
    return [word for word in _WORD.findall(text) if word not in GRAMMAR]
