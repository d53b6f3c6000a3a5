"""A file of numbers with sources: scenes, and rows that say what comes out of them.

    scenes:
      half: {law: {type: sadowsky}, ...}     # as a user writes it; its `name` may be left out
    rows:
      - {scene: half, quantity: n0.y, value: 43.496408017, digits: 11, source: ..., about: ...}
      - {scene: half, set: {law: {type: kirchhoff}}, quantity: energy, ...}

`set` are overrides as of `--set`, `digits` the significant digits of the source that stand, `exact`
for a count or a number in closed form. `about` is for who reads it.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.plain import is_number
from ribbonopt.reading import MEGA, Kind, read_text
from ribbonopt.scene import Scene
from ribbonopt.scene.faults import (
    InvalidSceneError,
    KeyPath,
    Problem,
    dotted,
    report,
    shown,
    suggestion,
)
from ribbonopt.scene.text.overrides import override
from ribbonopt.scene.text.yamltext import PlainData
from ribbonopt.scene.validated import validated
from ribbonopt.scene.yamlio import read_yaml
from ribbonopt.studies.batch.study import assignments

from .claims import Claim
from .number import UnknownNumberError
from .quantities import quantity

OWN = Path(__file__).with_name("verification.yaml")
FILE = Kind("a file of numbers with sources", most=10 * MEGA, error=SceneError, piped=True)
PARTS, KEYS = ("scenes", "rows"), ("scene", "set", "quantity", "value", "digits", "source", "about")
NEEDED = ("scene", "quantity", "value", "digits", "source")
EXACT = "exact"
MOST = 30  # digits that a source may have


def load_claims(path: str | os.PathLike[str] = OWN) -> tuple[Claim, ...]:
    """Read a file of numbers with sources.

    Raises
    ------
    SceneError
        If it cannot be read, or for all problems of it together, each with its line and key.
    """
    source = os.fspath(path)
    found = read_yaml(read_text(path, FILE), source, PARTS)
    reader = _Reader(found, os.path.dirname(source))
    claims = reader.claims()
    if reader.problems:
        raise SceneError(report(source, reader.problems, found.places))
    return claims


class _Reader:
    """Makes rows of plain data, and notes the problems of all of them."""

    def __init__(self, found: PlainData, folder: str) -> None:
        self.found, self.folder = found, folder
        self.problems: list[Problem] = []
        self.scenes: dict[str, PlainData] = {}
        self.cases: dict[tuple[str, ...], Scene | None] = {}

    def claims(self) -> tuple[Claim, ...]:
        """Return all rows, those without problems."""
        data = self.found.data
        if not isinstance(data, dict) or not all(key in data for key in PARTS):
            self._note((), f"expected the keys {' and '.join(PARTS)}")
            return ()
        for key in data:
            if key not in PARTS:
                self._note((key,), f"unknown key{suggestion(key, PARTS)}")
        scenes, rows = data["scenes"], data["rows"]
        if not isinstance(scenes, dict):
            self._note(("scenes",), "expected scenes by name", scenes)
            return ()
        if not isinstance(rows, list) or not rows:
            self._note(("rows",), "expected a list of rows", rows)
            return ()
        for name, scene in scenes.items():
            self._read_scene(name, scene)
        claims = (self._claim(i, row) for i, row in enumerate(rows))
        return tuple(claim for claim in claims if claim is not None)

    def _read_scene(self, name: str, scene: Any) -> None:
        path: KeyPath = ("scenes", name)
        if not isinstance(scene, dict):
            self._note(path, "expected a scene with law, boundary", scene)
            return
        places = {p[2:]: place for p, place in self.found.places.items() if p[:2] == path and p[2:]}
        plain = PlainData({"name": name} | scene, places, [])
        self.scenes[name] = plain
        try:
            self.cases[(name,)] = validated(plain.data, self.folder)
        except InvalidSceneError as error:
            self.cases[(name,)] = None
            self.problems += [p._replace(path=(*path, *p.path)) for p in error.problems]

    def _claim(self, i: int, row: Any) -> Claim | None:
        path: KeyPath = ("rows", i)
        if not isinstance(row, dict):
            self._note(path, f"expected keys {', '.join(NEEDED)}", row)
            return None
        before = len(self.problems)
        for key in row:
            if key not in KEYS:
                known = f"unknown key{suggestion(key, KEYS)} (known: {', '.join(KEYS)})"
                self._note((*path, key), known)
        for key in NEEDED:
            if key not in row:
                self._note(path, f"{key} is missing")
        if len(self.problems) > before:
            return None
        self._check(path, row)
        case = self._case(path, row) if len(self.problems) == before else None
        if case is None:
            return None
        try:
            asked = quantity(row["quantity"], case)
        except UnknownNumberError as error:
            self._note((*path, "quantity"), str(error))
            return None
        digits = None if row["digits"] == EXACT else row["digits"]
        given = tuple(assignments(row.get("set") or {}))
        words = row["quantity"], float(row["value"]), digits, row["source"], row.get("about", "")
        return Claim(i + 1, row["scene"], given, *words, case, asked)

    def _check(self, path: KeyPath, row: Mapping[str, Any]) -> None:
        """Note what is wrong with the values of a row."""
        for key in ("quantity", "source", "about"):
            text = row.get(key, "-")
            if not isinstance(text, str) or not text.strip():
                self._note((*path, key), "expected a text", text)
        if not is_number(row["value"]):
            self._note((*path, "value"), "expected a number", row["value"])
        digits = row["digits"]
        whole = isinstance(digits, int) and not isinstance(digits, bool) and 1 <= digits <= MOST
        if not whole and digits != EXACT:
            wanted = f"expected significant digits, from 1 to {MOST}, or {EXACT}"
            self._note((*path, "digits"), wanted, digits)
        if not isinstance(row.get("set") or {}, dict):
            self._note((*path, "set"), "expected keys of the scene and their values", row["set"])
        if row["scene"] not in self.scenes:
            near = suggestion(str(row["scene"]), self.scenes)
            self._note((*path, "scene"), f"is no scene of this file{near}", row["scene"])

    def _case(self, path: KeyPath, row: Mapping[str, Any]) -> Scene | None:
        """Return the scene of a row with its overrides, None for one that is not sound."""
        name, given = row["scene"], tuple(assignments(row.get("set") or {}))
        key = (name, *given)
        if self.cases[(name,)] is None:
            return None
        if key not in self.cases:
            self.cases[key] = None
            try:
                data = override(self.scenes[name], given).data
                self.cases[key] = validated(data, self.folder)
            except InvalidSceneError as error:
                for problem in error.problems:
                    self._note((*path, "set"), f"{dotted(problem.path)}: {problem}")
            except SceneError as error:
                self._note((*path, "set"), str(error))
        return self.cases[key]

    def _note(self, path: KeyPath, message: str, *found: Any) -> None:
        self.problems.append(Problem(path, message, *(shown(value) for value in found)))
