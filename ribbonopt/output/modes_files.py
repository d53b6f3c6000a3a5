"""Modes of small vibrations on disk: `modes.json`, `modes.csv` and, their shapes, `modes.npz`.

They stand beside the solution that they are of, which is written anew with all that was beside it.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.modes import Modes
from ribbonopt.classes import dataclass
from ribbonopt.plain import Row as PlainRow
from ribbonopt.plain import finite, json_text
from ribbonopt.reading import MEGA, Kind, read_json
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.solution.solution import Solution

from .archive import Row, arrays_of
from .declared import MODES_JSON, MODES_NPZ, MODES_PICTURES, MODES_TABLE
from .modes_rows import COLUMNS, rows_of, which_of
from .places import unwritable
from .records import checked
from .staging import replaced, replacing
from .summary import versions
from .table import write_table

SAVED = Kind("modes of ribbonopt", most=10 * MEGA, remedy="compute them again (ribbonopt modes)")
MOST = 1000  # modes of a ribbon
ARRAYS = {"squared": 1, "bounds": 1, "frequencies": 1, "errors": 1, "in_plane": 1, "s": 1}
SHAPES = {"displacement": 3, "rotation": 3}
WITHIN = 1e-9  # of the length: farthest beyond the ends that an arclength may be


@dataclass(frozen=True)
class SavedModes:
    """What a reload needs of `modes.json`."""

    unit: str
    negative: Annotated[int, Bounds(ge=0)]
    zero: tuple[str, ...]
    told: str = ""


def plain_of(solution: Solution, modes: Modes) -> PlainRow:
    """Return modes as plain values: what `modes.json` and `ribbonopt modes --json` say."""
    return {
        "name": solution.scene.name,
        "status": solution.status.name.lower(),
        "verified": solution.verified,
        "message": solution.message,
        "unit": modes.unit,
        "told": which_of(solution, modes),
        "negative": modes.negative,
        "zero": list(modes.zero),
        "modes": finite(rows_of(solution, modes)),
        "units": solution.units.name,
        "versions": versions(),
    }


def save_modes(solution: Solution, modes: Modes, folder: Path) -> list[Path]:
    """Write modes into an existing folder, that of their solution, and return where.

    A picture of older modes there is removed.

    `modes.npz` holds arrays by the names of `Modes`, its units: `s` (n,), of the whole band where
    symmetry gives one, and `displacement` and `rotation` (k, n, 3), lab frame.

    Parameters
    ----------
    solution, modes
        The equilibrium and its modes.
    folder
        Where; files of these names are replaced, the one that others read last.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    plain = plain_of(solution, modes)
    names = (MODES_TABLE, MODES_NPZ, MODES_JSON)
    arrays = {name: getattr(modes, name) for name in (*ARRAYS, *SHAPES)}
    try:
        write_table(folder / MODES_TABLE, COLUMNS, plain["modes"])
        for name in MODES_PICTURES:
            (folder / name).unlink(missing_ok=True)
        with replaced(folder / MODES_NPZ) as new, open(new, "wb") as file:
            np.savez(file, **arrays)
        with replacing(folder / MODES_JSON) as text:
            text.write(json_text(plain))
    except OSError as error:
        raise unwritable(folder, error) from error
    return [folder / name for name in names]


def load_modes(folder: Path, solution: Solution) -> Modes | None:
    """Return the modes that stand beside a solution; None where there are none.

    Raises
    ------
    OutputError
        If they are damaged, or of another ribbon.
    """
    if not os.path.lexists(folder / MODES_JSON):
        return None
    told, path = folder / MODES_JSON, folder / MODES_NPZ
    saved = checked(SavedModes, read_json(told, SAVED), str(told), SAVED)
    rows = [Row(name, axes=axes) for name, axes in (ARRAYS | SHAPES).items()]
    try:
        found = arrays_of(path, rows)
        _refuse_misfits(found, solution)
    except ValueError as error:
        raise SAVED.damaged(path, str(error)) from None
    return Modes(
        squared=found["squared"],
        frequencies=found["frequencies"],
        errors=found["errors"],
        zero=saved.zero,
        in_plane=found["in_plane"],
        s=found["s"],
        displacement=found["displacement"],
        rotation=found["rotation"],
        unit=saved.unit,
        negative=saved.negative,
        told=saved.told,
        bounds=found["bounds"],
    )


def _refuse_misfits(found: dict[str, Array], solution: Solution) -> None:
    """Refuse arrays that do not fit each other or the ribbon; ValueError says what does not."""
    count, s = len(found["squared"]), found["s"]
    start, end = solution.scene.interval
    if count > MOST:
        raise ValueError(f"squared: found {count} modes, expected at most {MOST}")
    for name in ("bounds", "frequencies", "errors", "in_plane"):
        if len(found[name]) != count:
            raise ValueError(f"{name}: expected one for each mode")
    for name in SHAPES:
        if found[name].shape != (count, len(s), 3):
            raise ValueError(f"{name}: expected a vector for each mode and arclength")
    for name in ("squared", "frequencies", "s", *SHAPES):
        if not np.isfinite(found[name]).all():
            raise ValueError(f"{name}: holds numbers that are not finite")
    room = WITHIN * (end - start)
    if len(s) < 2 or (np.diff(s) < 0).any() or abs(s[0] - start) > room or s[-1] < end - room:
        raise ValueError("s: expected arclengths along the ribbon of the scene")
