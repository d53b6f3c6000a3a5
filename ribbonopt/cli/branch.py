"""The verb `continue`: branches of equilibria, written as they are found."""

from __future__ import annotations

import argparse
import gc
import sys
from collections.abc import Generator, Iterator, Mapping
from contextlib import closing
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any

from .common import (
    INTERRUPTED,
    NOT_CONVERGED,
    load,
    pairs_of,
    print_json,
    say_left_out,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.solution.solution import Solution
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import BranchFolder
    from ribbonopt.studies.continuation.walk.points import Point

PICTURES = 5
BAR = 24


def follow(options: argparse.Namespace) -> int:
    """Follow the branches of a scene's `continuation`."""
    pairs = pairs_of(options.plot)
    scene, _ = load(options)
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import BranchFolder

    gc.enable()  # many solutions, each soon done with
    continuation = Continuation(scene)
    for x, y in pairs or []:
        continuation.recorder.known((x, y), f"--plot {x}:{y}")
    folder = BranchFolder(options.out or f"results/{scene.name}", scene, resume=options.resume)
    shown = _shown(folder.follow(continuation), continuation)
    try:
        with closing(shown):  # takes the bar away before anything is said
            for _ in shown:
                pass
        if pairs is not None:
            _draw(continuation, folder.lines, pairs, folder.folder)
    except KeyboardInterrupt:
        print(
            f"ribbonopt: interrupted; {len(folder.rows)} points kept in {folder.folder}, "
            "--resume goes on from there",
            file=sys.stderr,
        )
        return INTERRUPTED
    return _tell(options, folder, continuation)


def draw(result: Path, out: Path, pairs: list[tuple[str, str]]) -> list[Path]:
    """Draw the figures of a branch folder again and return where."""
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import load_branch

    scene, lines = load_branch(result)
    continuation = Continuation(scene)
    for pair in pairs:
        continuation.recorder.known(pair, ":".join(pair))
    return _draw(continuation, lines, pairs, out)


def _draw(
    continuation: Continuation,
    lines: list[dict[str, Any]],
    pairs: list[tuple[str, str]],
    out: Path,
) -> list[Path]:
    from ribbonopt.studies.continuation.files import rows_of
    from ribbonopt.studies.continuation.stored import spread
    from ribbonopt.views.branch import save_branch_figures

    rows, points = rows_of(lines), spread(continuation, lines, PICTURES)
    captions = [_caption(row) for row, _ in points]
    ribbons = [solution for _, solution in points]
    log = [stage.parameter for stage in continuation.stages if stage.scale == "log"]
    chosen = pairs or _usual(continuation.scene.record)
    drawn = save_branch_figures(rows, ribbons, captions, out, chosen, log=log)
    say_left_out(drawn.left_out)
    return drawn.paths


def _caption(row: dict[str, Any]) -> str:
    branch = f"\nbranch {row['branch']}" if row["branch"] else ""
    return f"{row['parameter']} = {row['value']:.4g}{branch}"


def _tell(options: argparse.Namespace, folder: BranchFolder, continuation: Continuation) -> int:
    ending = continuation.ending
    if options.json:
        print_json(
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
        print(_report(folder, continuation))
    if ending.reached:
        return 0
    print(
        f"ribbonopt: {folder.scene.name}: the goal was not reached: {ending.reason}; "
        f"{len(folder.rows)} points kept in {folder.folder}",
        file=sys.stderr,
    )
    return NOT_CONVERGED


def _report(folder: BranchFolder, continuation: Continuation) -> str:
    lines = [f"{folder.scene.name}: {len(folder.rows)} points"]
    for (stage, branch), ending in continuation.endings.items():
        rows = [r for r in folder.rows if (r["stage"], r["branch"]) == (stage, branch)]
        where = f"stage {stage + 1}" + (f", branch {branch}" if branch else "")
        lines.append(f"  {where}: {_extent(rows)}: {ending.reason}")
        lines += _notes(rows)
        for row in rows:
            if row["kind"] != "point":
                more = _how_on(row, continuation.stages[stage].switch)
                lines.append(f"    {row['kind']} at {row['parameter']} = {row['value']:.10g}{more}")
        lines += [f"    {change}" for change in _changes(rows)]
    names = ", ".join(sorted(path.name for path in folder.folder.iterdir()))
    return "\n".join([*lines, f"  written: {folder.folder}: {names}"])


def _how_on(row: Mapping[str, Any], switch: bool | int) -> str:
    """Say how to reach the ribbons that leave a straight one where it buckles."""
    if row["kind"] != "buckling point" or switch:
        return ""
    return " (`switch: true` follows the buckled ribbon)"


def _extent(rows: list[dict[str, Any]]) -> str:
    if not rows:
        return "no points"
    first, last = rows[0], rows[-1]
    errors = [row["error"] for row in rows if row["error"] is not None]
    return (
        f"{len(rows)} points, {first['parameter']} = {first['value']:.6g} to {last['value']:.6g}, "
        + (f"relative error at most {max(errors):.0e}" if errors else "errors not known")
    )


def _notes(rows: list[dict[str, Any]]) -> Iterator[str]:
    """Say what is to be told of points; once for those that follow one another."""
    regular = [row for row in rows if row["kind"] == "point"]
    for note, run in groupby(regular, key=lambda row: row.get("note")):
        if note:
            same = list(run)
            values = dict.fromkeys(f"{row['value']:.6g}" for row in (same[0], same[-1]))
            yield f"    note at {same[0]['parameter']} = {' to '.join(values)}: {note}"


def _changes(rows: list[dict[str, Any]]) -> Iterator[str]:
    """Say where stability changes, and how it is where it is known and does not."""
    known = [row for row in rows if row["negative"] is not None]
    for a, b in pairwise(known):
        if a["negative"] != b["negative"]:
            yield (
                f"{a['negative']} negative directions at {a['value']:.6g}, {b['negative']} at "
                f"{b['value']:.6g}"
            )
    if known and len({row["negative"] for row in known}) == 1:
        count = known[0]["negative"]
        yield "stable" if count == 0 else f"unstable: {count} negative directions"


def _shown(
    points: Iterator[Point[Solution]], continuation: Continuation
) -> Generator[Point[Solution], None, None]:
    """Give the points on, with a bar of progress on a terminal."""
    if not sys.stderr.isatty():
        yield from points
        return
    width = 0
    try:
        for point in points:
            line = _progress(point, continuation)
            print("\r" + line.ljust(width), end="", file=sys.stderr, flush=True)
            width = len(line)
            yield point
    finally:
        print("\r" + " " * width + "\r", end="", file=sys.stderr, flush=True)


def _progress(point: Point[Solution], continuation: Continuation) -> str:
    from ribbonopt.scene.stages import ends_of

    row, stage = point.row, continuation.stages[point.stage]
    ends = ends_of(stage)
    bar = _bar(row, stage.from_, ends[min(point.branch, len(ends) - 1)])
    line = f"{bar} {row['parameter']} = {row['value']:.6g}  step {point.step:.2g}"
    return line if row["error"] is None else f"{line}  error {row['error']:.0e}"


def _bar(row: Mapping[str, Any], begin: float | None, end: float) -> str:
    assert begin is not None
    share = (row["value"] - begin) / (end - begin)
    if row["value"] > 0 and begin > 0 and end > 0 and max(begin, end) > 50 * min(begin, end):
        from math import log

        share = log(row["value"] / begin) / log(end / begin)
    done = round(BAR * min(max(share, 0.0), 1.0))
    return f"[{'#' * done}{'.' * (BAR - done)}]"


def _usual(record: Mapping[str, str]) -> list[tuple[str, str]]:
    return [("value", name) for name in [*record, "u2", "energy", "H0"][:4]]
