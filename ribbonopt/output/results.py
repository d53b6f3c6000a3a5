"""Results on disk: `scene.yaml`, `summary.json`, `solution.npz`, and pictures where asked for."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from ribbonopt.attempt.discretize import transcription_of
from ribbonopt.errors import OutputError
from ribbonopt.plain import json_text
from ribbonopt.problem import pose
from ribbonopt.problem.switched import switched
from ribbonopt.scene import dump_scene, load_scene
from ribbonopt.scene.quantities import VECTORS
from ribbonopt.scene.units import in_special_units
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solution.verification import Verification
from ribbonopt.solvers import Status

from .staging import unwritable
from .summary import summarize

ROWS = 201


def save_solution(solution: Solution, folder: str | Path) -> None:
    """Write the files of a solution into an existing folder.

    `solution.npz` holds rows along s: `s` (k,), `r`, `d1`, `d2`, `d3`, `n`, `m` (k, 3, lab frame),
    `u` (k, 3, along the directors), all in the units of the scene, and what a reload needs, in
    units Dw = L = 1: `w`, `widths`, `theta`. Other equilibria go to `equilibria/2`, and so on.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    folder = Path(folder)
    try:
        _write(solution, folder)
    except OSError as error:
        raise unwritable(folder, error) from error


def _write(solution: Solution, folder: Path) -> None:
    s = np.linspace(*solution.scene.interval, ROWS)
    rows = solution.outputs(s)
    dense = solution.dense
    arrays: dict[str, Any] = {"s": s} | {name: rows[name] for name in VECTORS}
    arrays |= {"w": dense.w, "widths": dense.blocks.widths(dense.p)}
    arrays |= {"theta": dense.theta, "multipliers": solution.multipliers}
    arrays |= {"sheets": solution.sheets, "elements": dense.blocks.layout.elements}
    np.savez(
        folder / "solution.npz",
        **arrays,
    )
    (folder / "scene.yaml").write_text(dump_scene(solution.scene), encoding="utf-8")
    (folder / "summary.json").write_text(json_text(summarize(solution)), encoding="utf-8")
    for i, other in enumerate(solution.others, start=2):
        inner = folder / "equilibria" / str(i)
        inner.mkdir(parents=True)
        _write(other, inner)


def load_solution(path: str | Path) -> Solution:
    """Load a saved solution: its result folder, or any of the files in it.

    Raises
    ------
    OutputError
        If there is no whole result.
    """
    folder = Path(path)
    folder = folder.parent if folder.is_file() else folder
    missing = [
        name
        for name in ("scene.yaml", "summary.json", "solution.npz")
        if not (folder / name).is_file()
    ]
    if missing:
        raise OutputError(
            f"{path}: not a result of ribbonopt, {', '.join(missing)} missing; expected a folder "
            "written by `ribbonopt solve --out`"
        )
    scene = load_scene(folder / "scene.yaml")
    try:
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        with open(folder / "solution.npz", "rb") as file, np.load(file) as data:
            names = ("w", "widths", "theta", "multipliers")
            w, widths, theta, multipliers = (data[name] for name in names)
            sheets, elements = (
                tuple(int(v) for v in data[name]) for name in ("sheets", "elements")
            )
        status = Status[summary["status"].upper()]
    except (ValueError, KeyError, TypeError, OSError, EOFError, BadZipFile) as error:
        raise OutputError(f"{folder}: damaged result ({error}); solve the scene again") from error
    ribbon, problem = pose(in_special_units(scene))
    if sheets:
        problem = switched(ribbon, sheets)
    nlp = transcription_of(scene).transcribe(problem, elements)
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
    return Solution(
        scene=scene,
        trajectory=Trajectory(problem, nlp.blocks.dense(w, p)),
        status=status,
        message=summary["message"],
        iterations=summary["iterations"],
        multipliers=multipliers,
        timings=summary["timings"],
        path=tuple(summary["path"]),
        skipped=tuple(summary["skipped"]),
        verification=Verification((), worst, between, law, drift),
        sheets=sheets,
    )


def _number(value: float | None) -> float:
    return float("nan") if value is None else value
