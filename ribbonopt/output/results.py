"""Results on disk: `scene.yaml`, `summary.json`, `solution.npz`, and pictures where asked for."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ribbonopt.attempt.structure import Structure
from ribbonopt.errors import OutputError
from ribbonopt.problem import BoundaryValueProblem, Posed
from ribbonopt.reading import is_file
from ribbonopt.scene import Scene, validate_scene
from ribbonopt.scene.faults import shown
from ribbonopt.scene.units import Units, units_of
from ribbonopt.solution.made import solution_at
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.verification import Verification

from .declared import declare
from .exports import EQUILIBRIA, STANDARD, Export
from .places import unwritable
from .saved import (
    NUMBERS,
    RESULT,
    SAME,
    SUMMARY,
    SavedNumbers,
    SavedSummary,
    answers_of,
    read_numbers,
    read_scene,
    read_summary,
    refuse_other,
)
from .staging import OWN_FILES, recovered
from .summary import settings_of

#: what a summary says of its scene that decides what the numbers are
#: what was built for solutions, by the structure of their scenes
Built = dict[tuple[object, ...], Structure]
SETTINGS = ("name", "formulation", "states", "transcription", "scheme", "parameters", "interval")


def save_solution(
    solution: Solution, folder: str | Path, exports: Iterable[Export] = ()
) -> tuple[str, ...]:
    """Write the files of a solution into an existing folder.

    `solution.npz` holds rows along s: `s` (k,), `r`, `d1`, `d2`, `d3`, `n`, `m` (k, 3, lab frame),
    `u` (k, 3, along the directors), all in the units of the scene, and what a reload needs, in
    units Dw = L = 1: `w`, `widths`, `theta`. Other equilibria go to `equilibria/2`, and so on.

    Parameters
    ----------
    solution
        What to write.
    folder
        Where; files of these names are replaced.
    exports
        What to write besides.

    Returns
    -------
    tuple of str
        What had to be left out, each with its reason: `scene.yaml` where the scene was declared in
        Python, pictures that there are none of.

    Raises
    ------
    OutputError
        If they cannot be written, or two exports want the same file.
    """
    folder, more, left_out = Path(folder), tuple(exports), list[str]()
    _refuse_twice((*STANDARD, *more))
    try:
        for export in (*STANDARD, *more):
            left_out += export.write(solution, folder) or ()
        declare(folder, {name for export in more for name in export.files} - OWN_FILES)
    except OutputError:  # an OSError too, but one that says what to do
        raise
    except OSError as error:
        raise unwritable(folder, error) from error
    return tuple(left_out)


def _refuse_twice(exports: Sequence[Export]) -> None:
    writers = {EQUILIBRIA: "other equilibria"}
    for export in exports:
        for name in export.files:
            if name in writers:
                raise OutputError(
                    f"export {export.name!r} writes {name}, as {writers[name]!r} does; choose "
                    "another name"
                )
            writers[name] = export.name


def load_solution(
    path: str | Path, scene: Scene | None = None, built: Built | None = None
) -> Solution:
    """Load a saved solution: its result folder, or any of the files in it.

    `scene` is that of the solution, where it was declared in Python, so that no file says it.
    `built` is what was built for other solutions, an empty dict at first: of many that differ in
    numbers only, as those of a batch, it is built for the first and serves all.

    Raises
    ------
    OutputError
        If there is no whole result, or its files are damaged or do not belong together.
    """
    folder = recovered(path)
    folder = folder.parent if is_file(folder) else folder
    needed = [SUMMARY, NUMBERS] + (["scene.yaml"] if scene is None else [])
    missing = [name for name in needed if not os.path.exists(folder / name)]
    if missing == ["scene.yaml"]:
        raise OutputError(
            f"{path}: scene.yaml missing; if the scene was declared in Python, give it: "
            "load_solution(path, scene=...)"
        )
    if missing:
        raise OutputError(
            f"{path}: not a result of ribbonopt, {', '.join(missing)} missing; expected a folder "
            "written by `ribbonopt solve --out`"
        )
    scene = read_scene(folder / "scene.yaml") if scene is None else validate_scene(scene)
    summary, plain = read_summary(folder)
    saved = read_numbers(folder, summary)
    try:
        posed = Posed.of(scene, _units(scene, saved.units))
        built = {} if built is None else built
        if posed.structure not in built:
            built[posed.structure] = Structure.of(posed)
        structure = built[posed.structure].in_phases(saved.sheets)
        problem = structure.problem
        if len(saved.elements) != len(problem.phases):
            raise ValueError(
                f"elements: expected a number of them for each of the {len(problem.phases)} phases"
            )
        nlp, _ = structure.on(saved.elements)
        _refuse_other_scene(plain, saved, posed, problem, nlp.unknowns)
        # The saved parameters, because some follow from the solution (loads from costates).
        p = np.concatenate([saved.theta, saved.widths])
        solution = solution_at(
            posed,
            problem,
            nlp,
            saved.w,
            p,
            status=summary.ended,
            message=summary.message,
            iterations=summary.iterations,
            multipliers=saved.multipliers,
            timings=summary.timings,
            steps=tuple(plain["path"]),
            skipped=summary.skipped,
            given_up=summary.given_up,
            fell_back=summary.fell_back,
            verification=_verification(summary),
            sheets=saved.sheets,
        )
        if summary.ended.converged:
            refuse_other(answers_of(solution), plain)
    except (ValueError, ArithmeticError, RuntimeError) as error:
        raise RESULT.damaged(folder, str(error)) from error
    return solution


def _refuse_other_scene(
    plain: Mapping[str, Any],
    saved: SavedNumbers,
    posed: Posed,
    problem: BoundaryValueProblem,
    unknowns: int,
) -> None:
    """Refuse numbers of another scene; ValueError says what tells them apart."""
    names, theta, given = problem.parameter_names, saved.theta, posed.values
    if len(saved.w) != unknowns or len(theta) != len(names):
        raise ValueError(f"{len(saved.w)} unknowns, its scene has {unknowns}")
    settings = settings_of(posed.given)
    for key, value in ((key, settings[key]) for key in SETTINGS):
        if plain.get(key, value) != value:
            raise ValueError(f"{SUMMARY} says {key}: {shown(plain[key])}, its scene {shown(value)}")
    for name, here, there in zip(names, theta, given, strict=True):
        if name not in problem.recovered and not np.isclose(here, there, rtol=SAME, atol=1e-12):
            raise ValueError(f"it was solved at {name} = {here:.6g}, its scene says {there:.6g}")


def _verification(summary: SavedSummary) -> Verification:
    return Verification(
        (),
        _number(summary.worst_condition),
        _number(summary.residual_between_nodes),
        _number(summary.law_residual),
        {name: _number(value) for name, value in summary.invariant_drift.items()},
    )


def _units(scene: Scene, inside: tuple[float, ...] | None) -> Units:
    """Return the units that numbers were saved in; older results do not say."""
    if inside is None:
        return Units() if scene.ribbon is None else units_of(scene)
    length, force, stiffness = inside
    return Units(length, force, scene.ribbon is not None, stiffness)


def _number(value: float | None) -> float:
    return float("nan") if value is None else value
