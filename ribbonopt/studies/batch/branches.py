"""Branches of a study: a ribbon that is continued as its scene says, and what its row holds.

The row is that of the whole branch: whether each stage reached its goal, how many points there are,
the largest bound of their errors, and all special points. The full branch is kept where the study
wants it, as `ribbonopt continue` writes it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

from ribbonopt.mechanics.ends.smallest import settled
from ribbonopt.output.declared import BRANCH_PICTURES
from ribbonopt.output.staging import OWN_FILES, staged_result
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.plain import SPECIALS, Row, finite
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import with_value
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.studies.continuation.continuation import Continuation, asked_of
from ribbonopt.studies.continuation.files import FILE, TABLE, BranchFolder
from ribbonopt.studies.continuation.walk.points import POINT, Point
from ribbonopt.studies.continuation.walk.steps import JUMPED, NOT_RESOLVED

from .special import POINTS

OWN = {*OWN_FILES, FILE, TABLE, *BRANCH_PICTURES}
NOT_REACHED = "target_not_reached"
DOUBTFUL = "doubtful"  # the goal was reached, but what is on the way is not resolved


def follow(
    scene: Scene,
    prepared: Callable[[Scene], Prepared],
    save: str,
    place: Path | None,
    wait: float,
) -> Row:
    """Follow the branches of a scene and return what a row holds of them.

    Parameters
    ----------
    scene
        The scene, with a `continuation`.
    prepared
        Gives what is built for the structure of a scene.
    save, place
        Which branches are kept (all, failed or none), and the folder of this one; None for nowhere.
    wait
        Seconds to wait for another process that writes there.
    """
    scene = settled(scene)
    stage = asked_of(scene)[0]
    assert stage.from_ is not None
    first = replace(with_value(scene, stage.moved, stage.from_), continuation=None)
    continuation = Continuation(scene, prepared(first))
    if place is None or save == "none":
        return _told(continuation, _rows(continuation))
    # Written as it is found, so that no solution need be kept; not on disk at once.
    with staged_result(place, OWN, wait=wait, durable=False) as stage_:
        with closing(BranchFolder(stage_.folder, scene, resume=False)) as folder:
            row = _told(continuation, _rows(folder.follow(continuation)))
        if save == "all" or not row["verified"]:
            stage_.commit()
    return row


def _rows(points: Iterable[Point[Solution]]) -> Iterator[Row]:
    return (finite(dict(point.row)) for point in points)


def _told(continuation: Continuation, points: Iterator[Row]) -> Row:
    """Return the row of a branch from those of its points."""
    rows = list(points)
    regular = [row for row in rows if row["kind"] == POINT]
    errors = [row["error"] for row in regular if row["error"] is not None]
    notes = (part for row in rows for part in row["note"].split("; "))
    doubts = [part for part in notes if part.startswith((JUMPED, NOT_RESOLVED))]
    ending = continuation.ending
    status = Status.CONVERGED.name.lower() if ending.reached else NOT_REACHED
    message = "" if ending.reached else ending.reason
    if ending.reached and doubts:
        status, message = DOUBTFUL, doubts[0]
    reasons = {key: each.reason for key, each in continuation.endings.items()}
    told: dict[str, Any] = {
        "status": status,
        "verified": not message,
        "message": message,
        "error": max(errors, default=None),
        "start": "own",
        "iterations": sum(row["iterations"] for row in regular),
        "path": "; ".join(_ended(key, reason) for key, reason in reasons.items()),
        POINTS: len(rows),
        SPECIALS: [row for row in rows if row["kind"] != POINT],
    }
    return told


def _ended(key: tuple[int, int], reason: str) -> str:
    stage, branch = key
    return f"stage {stage + 1}{f', branch {branch}' if branch else ''}: {reason}"
