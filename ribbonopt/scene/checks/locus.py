"""Faults of the stages of a continuation that follow a locus in two parameters."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ribbonopt.scene.continuation import ContinuationStage
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.lens import fault_of, value_at, with_value
from ribbonopt.scene.model import Scene
from ribbonopt.scene.wording import written

OF_LOCI = ("of", "between", "branch")  # keys that only a locus has
PAIR = 'write for example "parameter: [parameters.angle, parameters.distance]"'


def locus_faults(
    stage: ContinuationStage, scene: Scene, path: KeyPath, before: ContinuationStage | None
) -> Iterator[Problem]:
    """Yield what is wrong with the keys of loci in a stage; `before` is the stage before it."""
    if not stage.is_locus:
        given = {key: getattr(stage, key) for key in OF_LOCI}
        given["number"] = stage.number if stage.number > 1 else None
        for key, value in given.items():
            if value is not None:
                message = f"which is for a locus in two parameters: {PAIR}; or remove it"
                found = written(value) if isinstance(value, tuple) else repr(value)
                yield Problem((*path, key), message, found)
                return
        return
    first, second = stage.paths
    if first == second:
        message = "expected two different parameters: branches move the first, and the locus is "
        message += "followed in the second"
        yield Problem((*path, "parameter"), message, f"{first} twice")
    elif fault := fault_of(scene, first):
        yield Problem((*path, "parameter"), fault)
    if stage.of is None:
        message = "two parameters are those of a locus; say of what: "
        yield Problem((*path, "parameter"), message + '"of: fold" or "of: branch point"')
    yield from _beginning(stage, path, before)
    for key in ("from", "switch"):
        if value := getattr(stage, "from_" if key == "from" else key):
            reason = {
                "from": f"a locus begins where its special point is: set {second} in the scene",
                "switch": "no branches are followed from a locus: switch on a branch of its own",
            }[key]
            yield Problem((*path, key), f"{reason}, and remove this key", f"{value}")


def _beginning(
    stage: ContinuationStage, path: KeyPath, before: ContinuationStage | None
) -> Iterator[Problem]:
    """Yield what is wrong with where a locus begins."""
    first = stage.paths[0]
    follows = before is not None and not before.is_locus and before.moved == first
    if stage.between is None and not follows:
        message = f"a locus needs the range of {first}: add for example "
        yield Problem(path, message + '"between: [0, 60]", where the branch goes from 0 to 60')
    if stage.between is not None and stage.between[0] == stage.between[1]:
        message = f"expected two different values of {first}: the branch goes from the one to the "
        yield Problem((*path, "between"), message + "other", written(stage.between))
    if stage.branch is not None and follows:
        message = f"stands beside a stage before it in {first}, whose special point is taken; keep "
        yield Problem((*path, "branch"), message + "one of the two", repr(stage.branch))
    if follows and stage.number != 1:
        message = 'the special point is that where the stage before stops; write there "stop: [2 '
        message += f'{stage.of}s]" for the second one, and remove this key'
        yield Problem((*path, "number"), message, f"{stage.number}")


def way_faults(stage: ContinuationStage, scene: Scene, path: KeyPath) -> Iterator[Problem]:
    """Yield what is wrong with where a locus goes from its scene's own value."""
    begin, values = value_at(scene, stage.moved), stage.values
    if values and not (begin <= values[0] < values[-1] or begin >= values[0] > values[-1]):
        if len(values) > 1 or begin == values[0]:
            message = f"expected values that go away from {begin:g}, where {stage.moved} is in the "
            message += "scene; set it before the first, or write `to: [A, B]` for both ways"
            yield Problem((*path, "values"), message, written(values))


def branch_scenes(
    stage: ContinuationStage, scene: Scene, path: KeyPath
) -> Iterator[tuple[KeyPath, float, Scene]]:
    """Yield the scenes at both ends of the branch of a locus, with where these stand."""
    for i, value in enumerate(stage.between or ()):
        there = with_value(scene, stage.paths[0], value)
        yield (*path, "between", i), value, replace(there, continuation=None, map=None)
