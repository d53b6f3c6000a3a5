"""The verb `continue`: branches of equilibria, written as they are found."""

from __future__ import annotations

import argparse
import gc
import time
from collections.abc import Generator
from contextlib import closing
from typing import TYPE_CHECKING

from ribbonopt.errors import SceneError

from .branch_drawing import draw_branch
from .branch_report import report, took
from .common import (
    INTERRUPTED,
    NOT_CONVERGED,
    default_folder,
    drawn,
    load,
    pairs_of,
    refuse_idle_verbose,
)
from .progress import ProgressLine
from .terminal import complain, say, say_json

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.solution.solution import Solution
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import BranchFolder
    from ribbonopt.studies.continuation.recorded import Recorder
    from ribbonopt.studies.continuation.walk.points import Point

    from .drawing import Wanted

BAR = 12


def follow(options: argparse.Namespace) -> int:
    """Follow the branches of a scene's `continuation`."""
    refuse_idle_verbose(options)
    pairs, begun = pairs_of(options.plot), time.perf_counter()
    scene, _ = load(options)
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import BranchFolder

    gc.enable()  # many solutions, each soon done with
    continuation = Continuation(scene)
    pairs = None if pairs is None else _columns(pairs, continuation.recorder)
    place = options.out or default_folder(scene.name, "continue")
    folder = BranchFolder(place, scene, resume=options.resume)
    status = 0
    try:
        with closing(folder):
            shown = _shown(folder, continuation, ProgressLine(quiet=options.quiet))
            with closing(shown):  # takes the line away before anything is said
                for _ in shown:
                    pass
            if pairs is not None:
                place = folder.folder
                status = drawn(lambda: draw_branch(continuation, folder.lines, pairs, place, place))
    except KeyboardInterrupt:
        complain(
            f"interrupted; {len(folder.rows)} points kept in {folder.folder}, "
            "--resume goes on from there"
        )
        return INTERRUPTED
    return _tell(options, folder, continuation, time.perf_counter() - begun) or status


def draw(result: Path, out: Path, pairs: list[tuple[str, str]], asked: Wanted) -> list[Path]:
    """Draw the figures of a branch folder again and return where."""
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import load_branch, rows_of
    from ribbonopt.studies.continuation.recorded import Recorder

    scene, lines = load_branch(result)
    if not rows_of(lines):
        raise SceneError(
            f"{result}: the branch has no points, so there is nothing to draw; "
            "`ribbonopt continue --resume` goes on with it"
        )
    pairs = _columns(pairs, Recorder(scene))  # before anything is built
    return draw_branch(Continuation(scene), lines, pairs, out, result, asked)


def _columns(pairs: list[tuple[str, str]], recorder: Recorder) -> list[tuple[str, str]]:
    """Return pairs with the names of columns; SceneError for what no row has."""
    for x, y in pairs:
        if fault := recorder.fault_of((x, y)):
            raise SceneError(f"--plot {x}:{y}: {fault}")
    return [(recorder.column(x), recorder.column(y)) for x, y in pairs]


def _tell(
    options: argparse.Namespace, folder: BranchFolder, continuation: Continuation, seconds: float
) -> int:
    ending = continuation.ending
    if options.json:
        say_json(
            {
                "name": folder.scene.name,
                "status": "converged" if ending.reached else "target_not_reached",
                "verified": True,
                "reached": ending.reached,
                "message": ending.reason,
                "endings": [
                    {"stage": key[0], "branch": key[1], "reached": e.reached, "reason": e.reason}
                    for key, e in continuation.endings.items()
                ],
                "folder": str(folder.folder),
                "points": folder.rows,
            }
        )
    elif not options.quiet:
        say(report(folder, continuation))
        if options.verbose:
            say(took(folder, continuation, seconds))
    if ending.reached:
        return 0
    complain(
        f"{folder.scene.name}: the goal was not reached: {ending.reason}; "
        f"{len(folder.rows)} points kept in {folder.folder}"
    )
    return NOT_CONVERGED


def _shown(
    folder: BranchFolder, continuation: Continuation, line: ProgressLine
) -> Generator[Point[Solution], None, None]:
    """Give the points as they are written, with a line of progress on a terminal."""
    with closing(line), closing(folder.follow(continuation)) as points:
        for count, point in enumerate(points, start=1):
            if line.due:
                line.show(f"{_progress(point, continuation)}, {line.rate(count):.1f}/s")
            yield point


def _progress(point: Point[Solution], continuation: Continuation) -> str:
    from ribbonopt.scene.stages import ends_of

    row, stage = point.row, continuation.stages[point.stage]
    value = row[stage.moved]
    ends = ends_of(stage)
    bar = _bar(value, stage.from_, ends[min(point.branch, len(ends) - 1)])
    where = f"stage {point.stage + 1}, " if len(continuation.stages) > 1 else ""
    where += f"branch {point.branch}, " if point.branch else ""
    parts = [f"{bar} {where}{stage.moved} = {value:.6g}", f"step {point.step:.2g}"]
    if row["error"] is not None:
        parts.append(f"error {row['error']:.0e}")
    if row["negative"] is not None:
        parts.append(f"{row['negative']} negative")
    return ", ".join(parts)


def _bar(value: float, begin: float | None, end: float) -> str:
    assert begin is not None
    share = (value - begin) / (end - begin)
    if value > 0 and begin > 0 and end > 0 and max(begin, end) > 50 * min(begin, end):
        from math import log

        share = log(value / begin) / log(end / begin)
    done = round(BAR * min(max(share, 0.0), 1.0))
    return f"[{'#' * done}{'.' * (BAR - done)}]"
