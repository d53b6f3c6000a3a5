"""Results on disk: `scene.yaml`, `summary.json`, `solution.npz`, and pictures where asked for.

A result folder appears whole or not at all: files are written to a folder beside it, which takes
its place when complete. An older result there is replaced; other files are never touched.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from ribbonopt.discretize import discretize
from ribbonopt.errors import OutputError
from ribbonopt.problem import pose
from ribbonopt.scene import dump_scene, load_scene
from ribbonopt.scene.units import in_special_units
from ribbonopt.solution import Solution, Verification
from ribbonopt.solvers import Status
from ribbonopt.summary import summarize

ROWS = 201
OWN_FILES = frozenset(
    (
        "scene.yaml",
        "summary.json",
        "solution.npz",
        "strains.png",
        "plane.png",
        "ribbon.png",
        "equilibria",
    )
)


@dataclass(frozen=True, eq=False)
class Stage:
    """A folder beside the wanted one, into which a result is written first."""

    folder: Path
    target: Path
    own: frozenset[str]

    def commit(self, failure: str = "") -> Path:
        """Put the files in place and return where: a failed solve never hides an older result.

        `failure` names what there is instead of a result, such as "not-converged".
        """
        target = self.target
        if failure:
            target = target.with_name(f"{target.name}.{failure}")
            _refuse_foreign(target, self.own)
        _replace(target, self.folder)
        return target


@contextmanager
def staged_result(target: str | Path, own: frozenset[str] = OWN_FILES) -> Iterator[Stage]:
    """Give a stage to write into; what is not committed leaves no trace.

    `own` names the files that an older result may consist of: what it would replace.

    Raises
    ------
    OutputError
        If `target` cannot be written, is a file, or holds files that are not a result.
    """
    target = Path(target)
    _refuse_foreign(target, own)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
        folder.chmod(0o777 & ~_umask())
    except OSError as error:
        raise _unwritable(target, error) from error
    try:
        yield Stage(folder, target, own)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


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
        raise _unwritable(folder, error) from error


def _write(solution: Solution, folder: Path) -> None:
    s = np.linspace(*solution.scene.interval, ROWS)
    rows = solution.outputs(s)
    names = ("r", "d1", "d2", "d3", "n", "m", "u")
    dense = solution.dense
    arrays: dict[str, Any] = {"s": s} | {name: rows[name] for name in names}
    arrays |= {"w": dense.w, "widths": dense.blocks.widths(dense.p)}
    arrays |= {"theta": dense.theta, "multipliers": solution.multipliers}
    np.savez(
        folder / "solution.npz",
        **arrays,
    )
    (folder / "scene.yaml").write_text(dump_scene(solution.scene), encoding="utf-8")
    text = json.dumps(summarize(solution), indent=2, allow_nan=False)
    (folder / "summary.json").write_text(text + "\n", encoding="utf-8")
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
        status = Status[summary["status"].upper()]
    except (ValueError, KeyError, TypeError, OSError, EOFError, BadZipFile) as error:
        raise OutputError(f"{folder}: damaged result ({error}); solve the scene again") from error
    _, problem = pose(in_special_units(scene))
    nlp = discretize(scene, problem, len(widths))
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
        problem=problem,
        dense=nlp.blocks.dense(w, p),
        status=status,
        message=summary["message"],
        iterations=summary["iterations"],
        multipliers=multipliers,
        timings=summary["timings"],
        path=tuple(summary["path"]),
        skipped=tuple(summary["skipped"]),
        verification=Verification((), worst, between, law, drift),
    )


def picture_folder(target: str | Path) -> Path:
    """Return a folder for pictures, made if need be; a file of a result stands for its folder.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    folder = Path(target)
    folder = folder.parent if folder.is_file() else folder
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise _unwritable(folder, error) from error
    return folder


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


def _refuse_foreign(target: Path, own: frozenset[str]) -> None:
    try:
        found = sorted(os.listdir(target)) if target.exists() else []
    except NotADirectoryError as error:
        raise OutputError(f"{target}: is a file, expected a folder for results") from error
    except OSError as error:
        raise OutputError(f"{target}: cannot be read ({error.strerror})") from error
    foreign = [name for name in found if name not in own]
    if foreign:
        raise OutputError(
            f"{target}: holds files that are not a result of ribbonopt ({', '.join(foreign[:3])}); "
            "choose a new or an empty folder"
        )


def _replace(target: Path, staging: Path) -> None:
    """Put the complete staging folder in the place of `target`, which may hold an older result."""
    try:
        if target.exists():
            retired = Path(tempfile.mkdtemp(prefix=f".{target.name}.old.", dir=target.parent))
            target.replace(retired)
            try:
                staging.replace(target)
            except OSError:
                retired.replace(target)
                raise
            shutil.rmtree(retired, ignore_errors=True)
        else:
            staging.replace(target)
    except OSError as error:
        raise _unwritable(target, error) from error


def _unwritable(target: Path, error: OSError) -> OutputError:
    return OutputError(f"{target}: cannot be written ({error.strerror}); choose another folder")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
