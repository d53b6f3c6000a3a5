"""Verb `plot`: pictures of a saved result, branch or batch."""

from __future__ import annotations

import argparse
import os
from typing import TYPE_CHECKING

from ribbonopt.errors import SceneError
from ribbonopt.reading import is_file

from .common import pairs_of, say_left_out
from .terminal import say_line

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.solution.solution import Solution


def plot(options: argparse.Namespace) -> int:
    """Draw the pictures of a saved result."""
    from ribbonopt.output.claims import pictures_in
    from ribbonopt.output.results import load_solution
    from ribbonopt.output.staging import recovered

    result, pairs = recovered(options.result), pairs_of(options.plot) or []
    if is_file(result / "branch.jsonl"):
        from .branch import draw as draw_branch

        def draw(folder: Path) -> list[Path]:
            return draw_branch(result, folder, pairs)

    elif is_file(result / "rows.jsonl"):
        from .batch import draw as draw_batch

        def draw(folder: Path) -> list[Path]:
            return draw_batch(result, folder, pairs)

    elif pairs:
        raise SceneError(
            f"--plot: {result} is no branch and no batch, whose columns could be drawn"
        )
    elif not os.path.isdir(result):
        beside = f"{result}-branch"
        near = f"; did you mean {beside}?" if os.path.isdir(beside) else ""
        wanted = "expected one written by ribbonopt solve, continue or batch"
        raise SceneError(f"{result}: no such folder; {wanted}{near}")
    else:
        solution = load_solution(result)

        def draw(folder: Path) -> list[Path]:
            return draw_solution(solution, folder)

    with pictures_in(options.out or result) as folder:
        paths = draw(folder)
    for path in paths:
        say_line(str(path))
    return 0


def draw_solution(solution: Solution, folder: Path) -> list[Path]:
    """Draw the pictures of a solution; say what was left out."""
    from ribbonopt.views.files import draw_figures

    paths, left_out = draw_figures(solution, folder)
    say_left_out(left_out)
    return paths
