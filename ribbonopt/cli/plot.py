"""Verb `plot`: pictures of a saved result, branch, batch or map."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from ribbonopt.errors import SceneError
from ribbonopt.reading import is_file

from .common import pairs_of, say_left_out
from .terminal import say_line

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.checks.modes import Modes
    from ribbonopt.solution.solution import Solution
    from ribbonopt.views.paper_style import Style


def plot(options: argparse.Namespace) -> int:
    """Draw the pictures of a saved result."""
    from ribbonopt.output.claims import pictures_in
    from ribbonopt.output.results import load_solution
    from ribbonopt.studies.loading import folder_of

    from .drawing import wanted

    result, pairs = folder_of(options.result), pairs_of(options.plot) or []
    asked = wanted(options)
    if not is_file(result / "rows.jsonl"):
        asked.refuse_field()
    if is_file(result / "branch.jsonl"):
        from .branch import draw as draw_branch

        def draw(folder: Path) -> list[Path]:
            return draw_branch(result, folder, pairs, asked)

    elif is_file(result / "rows.jsonl"):
        from .batch import draw as draw_batch

        def draw(folder: Path) -> list[Path]:
            return draw_batch(result, folder, pairs, asked)

    elif is_file(result / "map.json"):
        from .map import draw as draw_map

        refuse_pairs = pairs and f"--plot: {result} is a map, which has no columns to be drawn"
        if refuse_pairs:
            raise SceneError(refuse_pairs)

        def draw(folder: Path) -> list[Path]:
            return draw_map(result, folder, asked)

    elif pairs:
        raise SceneError(
            f"--plot: {result} is no branch and no batch, whose columns could be drawn"
        )
    else:
        asked.refuse(f"{result} is no branch, along which ribbons are drawn", "inset", "animate")
        from ribbonopt.output.modes_files import load_modes

        solution = load_solution(result)
        modes = load_modes(result, solution)

        def draw(folder: Path) -> list[Path]:
            paths = draw_solution(solution, folder, asked.style)
            return paths + ([] if modes is None else _modes(solution, modes, folder, asked.style))

    with pictures_in(options.out or result) as folder:
        paths = draw(folder)
    for path in paths:
        say_line(str(path))
    return 0


def draw_solution(solution: Solution, folder: Path, style: Style | None = None) -> list[Path]:
    """Draw the pictures of a solution; say what was left out."""
    from ribbonopt.views.files import draw_figures
    from ribbonopt.views.paper_style import PLAIN

    paths, left_out = draw_figures(solution, folder, style=style or PLAIN)
    say_left_out(left_out)
    return paths


def _modes(solution: Solution, modes: Modes, folder: Path, style: Style) -> list[Path]:
    """Draw the modes that stand beside a solution."""
    from ribbonopt.views.modes import save_modes_figure

    paths, left_out = save_modes_figure(solution, modes, folder, style)
    say_left_out(left_out)
    return paths
