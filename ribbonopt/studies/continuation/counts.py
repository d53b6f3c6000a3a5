"""The count of negative directions as a witness: what of its change no special point explains."""

from __future__ import annotations

from ribbonopt.checks.stability import negative_directions, negative_range
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.solution.solution import Solution


def unexplained(a: Solution, b: Solution, changes: int) -> str:
    """Say how the count changes between two points of a branch, "" if that is explained.

    Each of the `changes` of test functions between them adds a negative direction, or takes one
    away. Where all states are in a plane, special points that lead out of it are not seen.
    """
    before, after = negative_directions(a), negative_directions(b)
    if before is None or after is None or a.scene.states == "planar":
        return ""
    if _fits(after - before, changes):
        return ""
    # Next to special points one direction is nearly neutral: it may be counted or not.
    if any(_fits(n - m, changes) for m in _counts(a) for n in _counts(b)):
        return ""
    pair = "" if changes or abs(after - before) != 2 else _pair(b)
    return f"a change of the count of negative directions from {before} to {after}{pair}"


def _pair(solution: Solution) -> str:
    """Say why two directions may have changed at once."""
    if not capabilities(solution.scene).spins:
        return ""
    return " (modes of an isotropic rod come in pairs: a half held by `support: flip` has one)"


def _counts(solution: Solution) -> range:
    found = negative_range(solution)
    return range(0) if found is None else range(found[0], found[1] + 1)


def _fits(change: int, changes: int) -> bool:
    return abs(change) <= changes and (change - changes) % 2 == 0
