"""Results on disk: `scene.yaml`, `summary.json`, `solution.npz`, and pictures where asked for."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from ribbonopt.attempt.structure import Structure
from ribbonopt.errors import OutputError
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene, load_scene, validate_scene
from ribbonopt.scene.units import Units, units_of
from ribbonopt.solution.made import solution_at
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.verification import Verification
from ribbonopt.solvers import Status

from .declared import declare
from .exports import EQUILIBRIA, STANDARD, Export
from .places import unwritable
from .staging import OWN_FILES, recovered


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


def load_solution(path: str | Path, scene: Scene | None = None) -> Solution:
    """Load a saved solution: its result folder, or any of the files in it.

    `scene` is that of the solution, where it was declared in Python, so that no file says it.

    Raises
    ------
    OutputError
        If there is no whole result.
    """
    folder = recovered(path)
    folder = folder.parent if folder.is_file() else folder
    needed = ["summary.json", "solution.npz"] + (["scene.yaml"] if scene is None else [])
    missing = [name for name in needed if not (folder / name).is_file()]
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
    scene = load_scene(folder / "scene.yaml") if scene is None else validate_scene(scene)
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        with open(folder / "solution.npz", "rb") as file, np.load(file) as data:
            names = ("w", "widths", "theta", "multipliers")
            w, widths, theta, multipliers = (data[name] for name in names)
            inside = tuple(map(float, data["units"])) if "units" in data else None
            sheets, elements = (
                tuple(int(v) for v in data[name]) for name in ("sheets", "elements")
            )
        status = Status[summary["status"].upper()]
    except (ValueError, KeyError, TypeError, OSError, EOFError, BadZipFile) as error:
        raise OutputError(f"{folder}: damaged result ({error}); solve the scene again") from error
    posed = Posed.of(scene, _units(scene, inside))
    structure = Structure.of(posed).in_phases(sheets)
    problem, (nlp, _) = structure.problem, structure.on(elements)
    if len(w) != nlp.unknowns or len(theta) != problem.parameters.numel():
        raise OutputError(
            f"{folder}: damaged result ({len(w)} unknowns, its scene has {nlp.unknowns}); "
            "solve the scene again"
        )
    # The saved parameters, because some follow from the solution (loads from costates).
    p = np.concatenate([theta, widths])
    drift = {k: _number(v) for k, v in summary["invariant_drift"].items()}
    keys = ("worst_condition", "residual_between_nodes", "law_residual")
    worst, between, law = (_number(summary[key]) for key in keys)
    return solution_at(
        posed,
        problem,
        nlp,
        w,
        p,
        status=status,
        message=summary["message"],
        iterations=summary["iterations"],
        multipliers=multipliers,
        timings=summary["timings"],
        steps=tuple(summary["path"]),
        skipped=tuple(summary["skipped"]),
        given_up=tuple(summary.get("given_up", ())),
        fell_back=tuple(summary.get("fell_back", ())),
        verification=Verification((), worst, between, law, drift),
        sheets=sheets,
    )


def _units(scene: Scene, inside: tuple[float, ...] | None) -> Units:
    """Return the units that numbers were saved in; older results do not say."""
    if inside is None:
        return Units() if scene.ribbon is None else units_of(scene)
    length, force, stiffness = inside
    return Units(length, force, scene.ribbon is not None, stiffness)


def _number(value: float | None) -> float:
    return float("nan") if value is None else value
