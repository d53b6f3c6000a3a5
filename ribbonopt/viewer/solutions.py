"""The view of a solution, with the other equilibria of its scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ribbonopt.output.results import load_solution
from ribbonopt.output.saved import read_summary
from ribbonopt.output.staging import recovered
from ribbonopt.output.summary import summarize
from ribbonopt.reading import is_file
from ribbonopt.solution.solution import Solution
from ribbonopt.views.subject import subject_of

from .facts import about_of, numbers_of, status_of
from .view import Ribbon, View
from .width import width_of

EQUILIBRIA = "equilibria"


def view_of(solution: Solution, half_width: float | None = None) -> View:
    """Return the view of a solution and of the other equilibria that it knows.

    Parameters
    ----------
    solution
        Verified or not.
    half_width
        To which it is drawn where its relative width is 1; in the units of the scene. Default: its
        own, where the scene says it, else one with which generatrices keep apart.

    Raises
    ------
    ModelError
        If half_width is not positive.
    """
    found = [solution, *solution.others]
    return _view(found, [summarize(one) for one in found], half_width)


def saved_view(path: str | Path, half_width: float | None = None) -> View:
    """Return the view of a result folder, as `view_of`.

    Raises
    ------
    OutputError
        If there is no whole result, or its files are damaged or do not belong together.
    ModelError
        If half_width is not positive.
    """
    folder = recovered(path)
    folder = folder.parent if is_file(folder) else folder
    first, others = load_solution(folder), folder / EQUILIBRIA
    names = [item.name for item in others.iterdir()] if others.is_dir() else []
    numbered = sorted((name for name in names if name.isdecimal()), key=int)
    folders = [folder, *(others / name for name in numbered)]
    found = [first, *(load_solution(inner) for inner in folders[1:])]
    return _view(found, [read_summary(inner)[1] for inner in folders], half_width)


def _view(
    solutions: Sequence[Solution],
    summaries: Sequence[Mapping[str, Any]],
    half_width: float | None,
) -> View:
    subjects = [subject_of(solution, complete=True) for solution in solutions]
    ribbons = []
    for i, (subject, summary) in enumerate(zip(subjects, summaries, strict=True), start=1):
        status = status_of(summary)
        told = [subject.rest] if subject.mirrored else []
        ribbons.append(
            Ribbon(
                subject,
                caption=status if len(subjects) == 1 else f"equilibrium {i}, {status}",
                note=f"{told[0]} (light, dashed)" if told else "",
                verified=bool(summary.get("verified")),
                numbers=numbers_of(summary),
                warnings=tuple(summary.get("warnings") or ()),
            )
        )
    width, words = width_of(subjects, half_width)
    about = ", ".join(filter(None, [about_of(summaries[0]), words]))
    first = subjects[0]
    return View("result", first.name, about, tuple(ribbons), width, units=first.units)
