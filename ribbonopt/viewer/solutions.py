"""The view of a solution, with the other equilibria of its scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ribbonopt.output.results import load_solution
from ribbonopt.output.saved import read_summary
from ribbonopt.output.summary import summarize
from ribbonopt.solution.solution import Solution
from ribbonopt.views.subject import subject_of

from .facts import about_of, numbers_of, status_of
from .view import Ribbon, View
from .width import width_of

EQUILIBRIA = "equilibria"


def view_of_solution(solution: Solution, half_width: float | None = None) -> View:
    """Return the view of a solution and of the other equilibria that it knows.

    `half_width` as in `view_of`.
    """
    found = [solution, *solution.others]
    return _view(found, [summarize(one) for one in found], half_width)


def view_of_result(solution: Solution, folder: Path, half_width: float | None = None) -> View:
    """Return the view of a solution with what its folder says and holds besides.

    Raises
    ------
    OutputError
        If other equilibria, or summaries, cannot be read.
    ModelError
        If half_width is not positive.
    """
    others = folder / EQUILIBRIA
    names = [item.name for item in others.iterdir()] if others.is_dir() else []
    numbered = [others / name for name in sorted(filter(str.isdecimal, names), key=int)]
    found = [solution, *map(load_solution, numbered)]
    return _view(found, [read_summary(inner)[1] for inner in (folder, *numbered)], half_width)


def _view(
    solutions: Sequence[Solution],
    summaries: Sequence[Mapping[str, Any]],
    half_width: float | None,
) -> View:
    subjects = [subject_of(solution, complete=True) for solution in solutions]
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
    return View("result", first.name, about, tuple(ribbons), width, units=first.units)
