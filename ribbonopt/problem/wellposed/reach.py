"""Goals of a continuation that no ribbon reaches, because its ends would be too far apart.

A ribbon that stretches reaches a little further (`limits.STRETCH`), and need not be straight there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.boundary import gap_between_ends
from ribbonopt.mechanics.ends.frames import components, frame_of
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.scene import ContinuationStage, Scene
from ribbonopt.scene.faults import KeyPath, dotted
from ribbonopt.scene.limits import STRETCH

PLACES = 201  # along the way, and those that tell whether the distance changes
SOME = [1, 7, 30, 71, 113, 158, 193, -1]
ROUNDING = 1e-12  # of the length
PARALLEL = 1e-9  # angle between a tangent and the line between the ends
CLOSE = 60  # halvings of the last piece
CLOSER = 0.99  # of the way to where the ribbon is straight: a goal to try


def refuse_far_goals(scene: Scene) -> None:
    """Raise a ModelError where a stage leads to where the ends are further apart than the length.

    The whole way of each stage is looked at, and each stage begins where the one before has led.
    """
    if scene.continuation is None:
        return
    from ribbonopt.scene.lens import with_value
    from ribbonopt.scene.stages import begin_of, end_of, located_stages

    for path, stage in located_stages(scene):
        begin = begin_of(stage, scene)
        for key, end in _goals(stage, path):
            _refuse_far(scene, stage, begin, end, key)
        last = end_of(stage)
        scene = scene if last is None else with_value(scene, stage.moved, last)


def stretch_of(scene: Scene) -> float:
    """Return the share of its length by which a ribbon may be stretched between its ends."""
    return STRETCH if scene.membrane is not None and capabilities(scene).stretches else 0.0


def held_along(scene: Scene) -> bool:
    """Whether the tangents at the ends may be along the line between them."""
    ends = scene.boundary.start, scene.boundary.end
    first, last = (components(end.position, scene.parameters) for end in ends)
    if len(first) < len("xyz") or len(last) < len("xyz"):
        return True
    line = np.array([last[axis] - first[axis] for axis in "xyz"])
    line = line / np.linalg.norm(line)
    frames = [frame_of(end, scene.parameters) for end in ends]
    return all(
        frame is None or float(np.linalg.norm(frame[:, 2] - line)) < PARALLEL for frame in frames
    )


def _goals(stage: ContinuationStage, path: KeyPath) -> list[tuple[KeyPath, float]]:
    """Return where a stage goes to, each with its key."""
    if stage.values:
        return [((*path, "values", i), value) for i, value in enumerate(stage.values)]
    if isinstance(stage.to, tuple):
        return [((*path, "to", i), value) for i, value in enumerate(stage.to)]
    return [] if stage.to is None else [((*path, "to"), stage.to)]


def _refuse_far(
    scene: Scene, stage: ContinuationStage, begin: float, end: float, key: KeyPath
) -> None:
    from ribbonopt.scene.lens import with_value

    name, share = stage.moved, stretch_of(scene)

    def slack(value: float) -> float:
        return share + _slack(with_value(scene, name, value))

    here = slack(begin)
    if not here >= -ROUNDING:
        return  # solving where it begins says so
    values = _way(stage, begin, end)
    if all(slack(float(value)) == here for value in values[SOME]):
        return  # the distance does not depend on it
    found = np.array([slack(float(value)) for value in values])
    values, found = _with_dips(values, found, slack)
    beyond = np.flatnonzero(found < -ROUNDING)
    there = with_value(scene, name, end)
    if not len(beyond):
        if share or abs(slack(end)) > ROUNDING or held_along(there):
            return
        limit = end
    else:
        first = int(beyond[0])
        limit = _limit(slack, float(values[first - 1]), float(values[first]))
    raise ModelError(_message(there, name, begin, end, limit, dotted(key), share), dotted(key))


def _message(
    there: Scene, name: str, begin: float, end: float, limit: float, key: str, share: float
) -> str:
    gap, length = gap_between_ends(there), there.interval[1] - there.interval[0]
    if gap > length * (1 + share + ROUNDING):
        where = f"where the ends are {gap:.6g} apart and the ribbon is {length:.6g} long"
    elif limit == end:
        where = f"where the ends are as far apart as the ribbon is long, {length:.6g}, and it would"
        where += " have to be straight, but is held across that line"
    else:
        where = "and on the way to it the ends are further apart than the ribbon is long"
    if share:
        where += f", which may stretch by {share:.0%}"
        return (
            f"{key}: found {end:g}, {where}; from {begin:g} it can go up to {name} = {limit:.10g}"
        )
    return (
        f"{key}: found {end:g}, {where}; from {begin:g} it can go up to {name} = {limit:.10g}, "
        "where it is straight and where loads grow without bound if it is held across that line; "
        f"choose a value before that, such as {begin + CLOSER * (limit - begin):.6g}"
    )


def _way(stage: ContinuationStage, begin: float, end: float) -> Array:
    """Return values from where a stage begins to where it ends."""
    between = np.geomspace if stage.scale == "log" else np.linspace
    return np.array([begin, *between(begin, end, PLACES)[1:-1], end])


def _with_dips(values: Array, found: Array, slack: Callable[[float], float]) -> tuple[Array, Array]:
    """Return values and what is left there, with the least between them where it may be less."""
    left, middle, right = found[:-2], found[1:-1], found[2:]
    low = (middle <= left) & (middle <= right) & ((middle < left) | (middle < right))
    dips = 1 + np.flatnonzero(low)
    for i in [int(i) for i in dips if found[i] >= 0]:
        below, above = float(values[i - 1]), float(values[i + 1])
        for _ in range(CLOSE):
            a, b = below + 0.382 * (above - below), below + 0.618 * (above - below)
            below, above = (below, b) if slack(a) < slack(b) else (a, above)
        values, found = np.append(values, below), np.append(found, slack(below))
    order = np.argsort(np.abs(values - values[0]), kind="stable")
    return values[order], found[order]


def _limit(slack: Callable[[float], float], inside: float, outside: float) -> float:
    """Return the last value where the length does."""
    for _ in range(CLOSE):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if slack(middle) >= 0 else (inside, middle)
    return inside


def _slack(scene: Scene) -> float:
    """Return the share of its length by which a ribbon is longer than its ends are apart."""
    length = scene.interval[1] - scene.interval[0]
    return float(1 - gap_between_ends(scene) / length)
