"""Studies: what a batch solves, scene by scene, as text and overrides; nothing is solved here.

A study file names a scene (or several) and what is swept over it:

    name: arches
    scene: clamped_arch.yaml             # beside the study file; or several; or a scene itself
    set: {tolerance: 1e-6}               # for all
    sweep:                               # kinds given together are multiplied
      grid: {parameters.distance: {from: 0.5, to: 0.9, count: 20}, parameters.turn: [0, 1, 2]}
      zip: {law.delta: [0.1, 0.2], parameters.a: [1, 2]}
      list: [{parameters.a: 1}, {parameters.a: 2, law.delta: 0.1}]
      random: {count: 100, seed: 1, over: {parameters.a: {uniform: [0, 1]}}}
      csv: rows.csv                      # a column for each key
    continue: true                       # follow the `continuation` of each; false: solve it alone
    save: failed                         # full solutions: all | failed | none
    time_limit: 60                       # seconds for a ribbon
    labels: {parameters.a: $a$}          # what columns are called beside the axes of figures
"""

from __future__ import annotations

import glob
import itertools
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.plain import is_number
from ribbonopt.reading import read_text
from ribbonopt.scene import Scene
from ribbonopt.scene.faults import InvalidSceneError, KeyPath, Place, dotted, report, suggestion
from ribbonopt.scene.limits import SECONDS
from ribbonopt.scene.schema.annotations import written_keys
from ribbonopt.scene.yamlio import SCENE, plain_yaml, read_yaml
from ribbonopt.text import name_fault

from .cells import as_yaml
from .inputs import NOTHING, Inputs, fault, rows_of, text_of
from .study import Source, Study, Sweep

KEYS = ("name", "scene", "set", "sweep", "continue", "save", "time_limit", "labels")
SETTINGS = ("save", "time_limit", "labels")
SAVE = ("all", "failed", "none")


def load_study(paths: Sequence[str | Path], overrides: Sequence[str] = ()) -> Study:
    """Read study files, scenes, folders of them and patterns such as `scenes/*.yaml`.

    No ribbon is made yet, however many there are.

    Raises
    ------
    SceneError
        If one cannot be read, or is no study; a scene that is bad only spoils its own ribbon.
    """
    files = [file for path in paths for file in _files(str(path))]
    sweeps: list[Sweep] = []
    settings: dict[str, Any] = {}
    common = dict(_assignment(text) for text in overrides)
    for file in files:
        text = text_of(file)
        try:
            found = read_yaml(text, str(file), (*KEYS, *written_keys(Scene)))
        except SceneError:
            if len(files) == 1:
                raise
            sweeps.append(Sweep(Source(str(file), text), common))  # spoils its own row
            continue
        if isinstance(found.data, dict) and ("sweep" in found.data or "scene" in found.data):
            try:
                sweeps += _study(file, text, found.data, found.places, common)
            except InvalidSceneError as error:
                raise SceneError(report(str(file), error.problems, found.places)) from None
            settings |= {k: found.data[k] for k in SETTINGS if k in found.data}
            settings.setdefault("name", found.data.get("name", _named_after(file)))
        else:
            sweeps.append(Sweep(Source(str(file), text), common))
    name = settings.pop("name", None) or (_named_after(files[0]) if len(files) == 1 else "batch")
    return Study(name, tuple(sweeps), **settings)


def is_study(path: str | Path) -> bool:
    """Whether a path is that of a study, or of several files; False where it cannot be read."""
    if os.path.isdir(path) or any(character in str(path) for character in "*?["):
        return True
    try:
        found = plain_yaml(read_text(path, replace(SCENE, piped=False)), str(path))
    except SceneError:
        return False
    return isinstance(found, dict) and ("sweep" in found or "scene" in found)


def _named_after(file: Path) -> str:
    """Return the name of what a file says, where no other is given."""
    return "batch" if name_fault(file.stem) else file.stem


def _files(path: str) -> list[Path]:
    """Files that a path, a folder or a pattern stands for, sorted."""
    if os.path.isdir(path):
        try:
            names = os.listdir(path)
        except OSError as error:
            raise SceneError(f"{path}: cannot be read: {error.strerror}") from None
        found = sorted(Path(path, name) for name in names if name.endswith((".yaml", ".yml")))
        if not found:
            raise SceneError(f"{path}: holds no .yaml file; name a folder of scenes")
        return found
    if any(character in path for character in "*?[") and not os.path.exists(path):
        matches = sorted(glob.glob(path, recursive=True))
        if not matches:
            raise SceneError(f"{path}: no file matches")
        return [Path(match) for match in matches]
    return [Path(path)]


def _study(
    file: Path, text: str, data: dict[str, Any], places: Mapping[KeyPath, Place], common: Inputs
) -> list[Sweep]:
    for key in data:
        if key not in KEYS:
            known = f"unknown key of a study{suggestion(str(key), KEYS)} (known: {', '.join(KEYS)})"
            raise fault((key,), known)
    name = data.get("name", "study")
    if not isinstance(name, str):
        raise fault(("name",), "expected a name for the study and its folder of results", name)
    if wrong := name_fault(name):
        raise fault(("name",), wrong, name)
    followed = data.get("continue", False)
    if not isinstance(followed, bool):
        raise fault(
            ("continue",), "expected true or false: whether ribbons are continued", followed
        )
    if data.get("save", "none") not in SAVE:
        raise fault(("save",), f"expected one of {', '.join(SAVE)}", data["save"])
    limit = data.get("time_limit", 1.0)
    if not is_number(limit) or limit <= 0:
        raise fault(("time_limit",), "expected a number of seconds > 0", limit)
    if limit > SECONDS:
        raise fault(("time_limit",), f"expected at most {SECONDS:,.0f} seconds", limit)
    labels = data.get("labels", {})
    if not (isinstance(labels, dict) and all(isinstance(v, str) for v in labels.values())):
        raise fault(("labels",), "expected columns and what they are called", labels)
    given = {} if data.get("set") is None else data["set"]
    if not isinstance(given, dict):
        raise fault(("set",), "expected keys of the scene and their values", given)
    given = {str(key): value for key, value in given.items()}
    if data.get("scene") is None:
        example = "missing; name a scene file, or several, or write a scene here"
        raise fault(("scene",), example)
    scenes = data["scene"] if isinstance(data["scene"], list) else [data["scene"]]
    if not scenes:
        raise fault(("scene",), "names no scene; give one or more", scenes)
    try:
        rows = rows_of(file.parent, data["sweep"]) if "sweep" in data else NOTHING
    except InvalidSceneError as error:
        problems = [p._replace(path=("sweep", *p.path)) for p in error.problems]
        raise InvalidSceneError(problems) from None
    where = dict.fromkeys(rows.keys, f"{file}: sweep")
    for part in ("set", "sweep"):
        for path, place in places.items():
            if path[:1] == (part,):
                where[str(path[-1])] = f"{file}, {place}, {dotted(path)}"
    for key in common:
        if key in rows.keys:
            raise SceneError(f"--set {key}: is swept, {where.get(key, file)}; change it there")
        where[key] = f"--set {key}"
    return [
        Sweep(_source(file, text, item, places), given | common, rows, where, followed)
        for item in scenes
    ]


def _source(file: Path, text: str, item: Any, places: Mapping[KeyPath, Place]) -> Source:
    if isinstance(item, str):
        path = file.parent / item
        return Source(str(path), text_of(path, ("scene",)))
    if not isinstance(item, dict):
        raise fault(("scene",), "expected the name of a scene file, or a scene", item)
    # The lines of the scene, where they stand in the study, so that messages name them.
    line = places[("scene",)].line
    lines = text.splitlines()[line:]
    own = itertools.takewhile(lambda line: not line.strip() or line[0] in " #", lines)
    part = "\n" * line + "\n".join(own)
    try:
        same = plain_yaml(part, str(file)) == item
    except SceneError:  # it is not written on lines of its own
        same = False
    return Source(str(file), part if same else as_yaml(item))


def _assignment(text: str) -> tuple[str, Any]:
    key, equals, value = text.partition("=")
    if not equals:
        raise SceneError(f"--set {text}: expected path=value, such as law.epsilon=1e-3")
    return key.strip(), plain_yaml(value, f"--set {text}")
