"""The view of a solution, with the other equilibria of its scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ribbonopt.checks.modes import Modes, modes_of
from ribbonopt.errors import ViewError
from ribbonopt.output.modes_files import load_modes
from ribbonopt.output.modes_rows import rows_of, which_of
from ribbonopt.output.results import other_equilibria
from ribbonopt.output.saved import read_summary
from ribbonopt.output.summary import summarize
from ribbonopt.solution.solution import Solution
from ribbonopt.views.moved import subject_with
from ribbonopt.views.subject import subject_of

from .facts import about_of, numbers_of, status_of
from .motion import Motion
from .view import Ribbon, View
from .width import width_of

EQUILIBRIA = "equilibria"


def view_of_solution(
    solution: Solution, half_width: float | None = None, modes: Modes | None = None
) -> View:
    """Return the view of a solution and of the other equilibria that it knows.

    `half_width` as in `view_of`; `modes` are those of the solution, to be seen in motion.
    """
    found = [solution, *solution.others]
    return _view(found, [summarize(one) for one in found], half_width, modes)


def view_of_result(
    solution: Solution, folder: Path, half_width: float | None = None, modes: bool = False
) -> View:
    """Return the view of a solution with what its folder says and holds besides.

    Its modes of small vibrations are shown where they stand there, or are asked for.

    Raises
    ------
    OutputError
        If other equilibria, summaries or modes cannot be read.
    ModelError
        If half_width is not positive.
    ViewError
        If modes are asked for, and there are none.
    """
    known = load_modes(folder, solution)
    if known is None and modes:
        known = _modes(solution)
    others = folder / EQUILIBRIA
    names = [item.name for item in others.iterdir()] if others.is_dir() else []
    numbered = [others / name for name in sorted(filter(str.isdecimal, names), key=int)]
    found = [solution, *other_equilibria(folder)]
    told = [read_summary(inner)[1] for inner in (folder, *numbered)]
    return _view(found, told, half_width, known)


def _modes(solution: Solution) -> Modes:
    found = modes_of(solution)
    if isinstance(found, str):
        raise ViewError(f"{solution.scene.name}: there are no modes to be seen: {found}")
    return found


def _view(
    solutions: Sequence[Solution],
    summaries: Sequence[Mapping[str, Any]],
    half_width: float | None,
    modes: Modes | None,
) -> View:
    subjects = [subject_of(solution, complete=True) for solution in solutions]
    motion = None
    if modes is not None:
        subjects[0] = subject_with(solutions[0], modes)
        motion = Motion(modes, rows_of(solutions[0], modes), which_of(solutions[0], modes))
    ribbons = []
    for i, (subject, summary) in enumerate(zip(subjects, summaries, strict=True), start=1):
        status = status_of(summary)
        ribbons.append(
            Ribbon(
                subject,
                caption=status if len(subjects) == 1 else f"equilibrium {i}, {status}",
                note=f"{subject.rest} (light, dashed)" if subject.mirrored else "",
                verified=bool(summary.get("verified")),
                numbers=numbers_of(summary),
                warnings=tuple(summary.get("warnings") or ()),
            )
        )
    width, words = width_of(subjects, half_width)
    about = ", ".join(filter(None, [about_of(summaries[0]), words]))
    first = subjects[0]
    return View(
        "result", first.name, about, tuple(ribbons), width, units=first.units, motion=motion
    )
