"""Which files of a folder are ours: each is declared by who writes it, so that it may be replaced.

What every version knows is passed as `own`. Whoever writes more says so to the folder itself
(`declare`), in `exports.json`: the next result there then knows it, whoever writes that.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable
from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.plain import json_text
from ribbonopt.reading import MEGA, Kind, read_json

MANIFEST = "exports.json"
FILE = Kind("names of files", most=10 * MEGA)

NONE: frozenset[str] = frozenset()

#: what `ribbonopt.views` writes beside a solution, a branch and a batch
FORMATS = ("png", "svg", "pdf")
PICTURES = tuple(f"{name}.{f}" for name in ("strains", "plane", "ribbon") for f in FORMATS)
BRANCH_PICTURES = (
    *(f"{name}.{f}" for name in ("branch", "ribbons") for f in FORMATS),
    *("branch.gif", "branch.mp4"),
)
BATCH_PICTURES = (
    "report.html",
    *(f"{name}.{f}" for name in ("outcomes", "scatter", "special") for f in FORMATS),
)
MAP_PICTURES = tuple(f"map.{f}" for f in FORMATS)

#: modes of small vibrations, and their figure
MODES_JSON, MODES_TABLE, MODES_NPZ = "modes.json", "modes.csv", "modes.npz"
MODES_PICTURES = tuple(f"modes.{f}" for f in FORMATS)
MODES_FILES = (MODES_JSON, MODES_TABLE, MODES_NPZ, *MODES_PICTURES)

#: what `ribbonopt.viewer` writes beside any of them
PAGE = "view.html"


def declare(folder: Path, names: Iterable[str]) -> None:
    """Add names of files or folders, directly in a folder, to those that are ours there."""
    if names := {*names}:
        text = json_text({"files": sorted({*_declared(folder), *names})})
        (folder / MANIFEST).write_text(text, encoding="utf-8")


def foreign_in(folder: Path, own: Collection[str]) -> list[str]:
    """Return the names in a folder that are neither `own` nor declared there, sorted.

    Raises
    ------
    OSError
        If the folder cannot be read.
    """
    found = sorted(os.listdir(folder))
    declared = _declared(folder) if MANIFEST in found else NONE
    ours = {MANIFEST, *declared} if declared else declared
    return [name for name in found if name not in own and name not in ours]


def _declared(folder: Path) -> frozenset[str]:
    """Return what a folder says; nothing where it says nothing that can be understood."""
    try:
        found = read_json(folder / MANIFEST, FILE)
    except OutputError:
        return NONE
    names = found.get("files") if isinstance(found, dict) else None
    return frozenset(n for n in names if isinstance(n, str)) if isinstance(names, list) else NONE
