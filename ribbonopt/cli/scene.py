"""Verbs of one scene: `solve`, `check`, `schema`."""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING, Any

from ribbonopt.errors import OutputError

from .common import (
    NOT_CONVERGED,
    default_folder,
    drawn,
    listing,
    load,
    refuse_idle_verbose,
    say_left_out,
)
from .terminal import complain, say, say_json, say_line

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.scene import Scene
    from ribbonopt.solution.solution import Solution


def solve(options: argparse.Namespace) -> int:
    """Solve a scene and report its numbers."""
    refuse_idle_verbose(options)
    scene, import_seconds = load(options)
    if not (options.out or options.plot):
        return _tell(options, _solved(options, scene), import_seconds, None)
    from ribbonopt.output.results import save_solution
    from ribbonopt.output.staging import staged_result

    # Claimed before solving, so that a folder that cannot be written costs no solve.
    with staged_result(options.out or default_folder(scene.name, "solve")) as stage:
        solution = _solved(options, scene)
        try:
            say_left_out(save_solution(solution, stage.folder))
            written = stage.commit(solution.status.failure)
        except OutputError:  # such as of a disk that is full by now
            _tell(options, solution, import_seconds, None)
            raise
        status = 0
        if options.plot:
            from .plot import draw_solution

            status = drawn(lambda: draw_solution(solution, written))
    return _tell(options, solution, import_seconds, written) or status


def _solved(options: argparse.Namespace, scene: Scene) -> Solution:
    """Solve a scene as it asks, for one equilibrium or for all, which are counted on the way."""
    if scene.equilibria is None:
        from ribbonopt.pipeline.prepared import solve

        return solve(scene)
    from ribbonopt.studies.equilibria.solved import solved

    from .progress import ProgressLine

    line = ProgressLine(quiet=options.quiet)

    def tell(text: str) -> None:
        if line.due:
            line.show(f"{scene.name}: {text}")

    try:
        return solved(scene, tell=tell)
    finally:
        line.close()


def _tell(
    options: argparse.Namespace, solution: Solution, import_seconds: float, written: Path | None
) -> int:
    from ribbonopt.output.summary import summarize

    summary = summarize(solution)
    summary["timings"] = {"import": import_seconds} | summary["timings"]
    if options.json:
        say_json(summary)
    elif not options.quiet:
        _say_found(options, solution, summary, written)
        if written:
            say_line(f"  written: {listing(written)}")
    if solution.verified:
        return 0
    kept = f"; kept in {written}" if written else ""
    complain(f"{solution.scene.name}: {solution.message}{kept}")
    return NOT_CONVERGED


def _say_found(
    options: argparse.Namespace,
    solution: Solution,
    summary: dict[str, Any],
    written: Path | None,
) -> None:
    """Say what was found in short, or at length and how."""
    begun = time.perf_counter()
    verdict = _stability(solution)
    judged = time.perf_counter() - begun
    if not options.verbose:
        from ribbonopt.output.brief import brief

        say(brief(summary, verdict))
        return
    from ribbonopt.output.report import report
    from ribbonopt.output.steps import steps_of

    say(report(summary, steps=False, verdict=verdict))
    say(steps_of(summary, drawn=options.plot, written=written is not None, judged=judged))


def _stability(solution: Solution) -> str:
    """Return what the second variation says, in words; "" where there is no equilibrium."""
    if not solution.status.converged:
        return ""
    from ribbonopt.checks.stability import second_variation

    found = second_variation(solution)
    return f"not known: {found}" if isinstance(found, str) else found.verdict


def check(options: argparse.Namespace) -> int:
    """Validate a scene and count unknowns and conditions."""
    scene, _ = load(options)
    from ribbonopt.pipeline.check import check_scene

    found = check_scene(scene)
    if options.json:
        say_json(found)
    elif not options.quiet:
        say(_checked(found))
    return 0


def _checked(found: dict[str, Any]) -> str:
    unknowns = ", ".join(f"{name} {count}" for name, count in found["unknowns"].items())
    lines = [
        f"{found['name']}: valid",
        f"  {sum(found['unknowns'].values())} unknown numbers: {unknowns}",
        f"  {len(found['conditions'])} conditions:",
        *(f"    {name}" for name in found["conditions"]),
        f"  {found['size']} unknowns once discretised",
        "  will be skipped:",
        *(f"    {reason}" for reason in found["skipped"]),
        *(f"  hint: {hint}" for hint in found["hints"]),
    ]
    return "\n".join(lines)


def schema(options: argparse.Namespace) -> int:
    """Print the JSON schema of scenes, or of studies."""
    if options.what == "study":
        from ribbonopt.studies.batch.written import study_schema

        say_json(study_schema(), indent=2)
    else:
        from ribbonopt.scene import json_schema

        say_json(json_schema(), indent=2)
    return 0
