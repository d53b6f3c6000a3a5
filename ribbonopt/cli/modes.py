"""Verb `modes`: natural frequencies and shapes of small vibrations about an equilibrium."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError, SceneError
from ribbonopt.reading import is_file

from .common import default_folder, drawn, listing, load, say_left_out
from .terminal import say, say_json, say_line
from .values import count

if TYPE_CHECKING:
    from ribbonopt.checks.modes import Modes
    from ribbonopt.solution.solution import Solution

MOST = 200
NONE = "no_modes"  # the status where there are none
YAML = (".yaml", ".yml")


@dataclass(frozen=True, eq=False)
class _Found:
    """A solution with its modes, or why there are none."""

    solution: Solution
    modes: Modes | str

    def refuse(self, kept: Path | None) -> Modes:
        """Return the modes; raise a ConvergenceError where there are none."""
        where = f"; the solution is in {kept}" if kept else ""
        name = self.solution.scene.name
        if not self.solution.verified:
            status = self.solution.status.name.lower()
            raise ConvergenceError(f"{name}: {self.solution.message}{where}", status)
        if isinstance(self.modes, str):
            raise ConvergenceError(f"{name}: there are no modes: {self.modes}{where}", NONE)
        return self.modes


def modes(options: argparse.Namespace) -> int:
    """Solve a scene, or take a saved result, and report its modes."""
    number = count("--count", options.count, MOST)
    given = Path(options.scene)
    if given.is_dir() or (is_file(given) and given.suffix not in YAML):
        return _saved(options, number)
    scene, _ = load(options)
    from ribbonopt.pipeline.prepared import solve

    if not (options.out or options.plot):
        found = _found(solve(scene), number, options.planar)
        return _tell(options, found, found.refuse(None), None)
    from ribbonopt.output.modes_files import save_modes
    from ribbonopt.output.results import save_solution
    from ribbonopt.output.staging import staged_result

    with staged_result(options.out or default_folder(scene.name, "modes")) as stage:
        found = _found(solve(scene), number, options.planar)
        say_left_out(save_solution(found.solution, stage.folder))
        if not isinstance(found.modes, str):
            save_modes(found.solution, found.modes, stage.folder)
        written = stage.commit(found.solution.status.failure)
        known = found.refuse(written)
        status = drawn(lambda: _draw(found.solution, known, written)) if options.plot else 0
    return _tell(options, found, known, written) or status


def _saved(options: argparse.Namespace, number: int) -> int:
    """Report the modes of a saved result, and write them beside it."""
    if options.set:
        raise SceneError(f"--set: {options.scene} is a saved result; expected a scene to change")
    from ribbonopt.output.claims import claimed
    from ribbonopt.output.declared import MODES_FILES
    from ribbonopt.output.modes_files import save_modes
    from ribbonopt.solution.solution import Solution
    from ribbonopt.studies.loading import folder_of, load

    solution, folder = load(options.scene), folder_of(options.scene)
    if not isinstance(solution, Solution):
        raise SceneError(
            f"{options.scene}: is a branch or a batch, expected a scene or the result of one; of "
            "the points of a branch `continuation: {..., modes: 3}` records frequencies"
        )
    found = _found(solution, number, options.planar)
    known = found.refuse(None)
    with claimed(options.out or folder, MODES_FILES, alone=False) as place:
        save_modes(solution, known, place)
        status = drawn(lambda: _draw(solution, known, place)) if options.plot else 0
    return _tell(options, found, known, Path(options.out or folder)) or status


def _found(solution: Solution, number: int, planar: bool) -> _Found:
    from ribbonopt.checks.modes import modes_of

    return _Found(solution, modes_of(solution, number, planar=planar))


def _draw(solution: Solution, modes: Modes, folder: Path) -> None:
    from ribbonopt.views.modes import save_modes_figure

    say_left_out(save_modes_figure(solution, modes, folder).left_out)


def _tell(options: argparse.Namespace, found: _Found, modes: Modes, written: Path | None) -> int:
    from ribbonopt.output.modes_files import plain_of
    from ribbonopt.output.modes_rows import rows_of

    if options.json:
        say_json(plain_of(found.solution, modes))
    elif not options.quiet:
        from ribbonopt.output.modes_told import told

        say(told(found.solution, modes, rows_of(found.solution, modes)))
        if written:
            say_line(f"  written: {listing(written)}")
    return 0
