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
    save: failed                         # full solutions: all | failed | none
    time_limit: 60                       # seconds for a ribbon
"""

from __future__ import annotations

import glob
import hashlib
import itertools
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from ribbonopt.errors import SceneError
from ribbonopt.scene.yamlio import loads_scene, plain_yaml

from .inputs import Inputs, inputs_of, text_of

KEYS = ("name", "scene", "set", "sweep", "save", "time_limit")
SAVE = ("all", "failed", "none")


@dataclass(frozen=True)
class Source:
    """A scene as text, and where it was read."""

    name: str
    text: str


@dataclass(frozen=True)
class Sweep:
    """A source with the inputs of its ribbons, and what holds for all of them."""

    source: Source
    common: Inputs
    inputs: tuple[Inputs, ...]


@dataclass(frozen=True)
class Ribbon:
    """One ribbon of a study: its number, its scene and its inputs."""

    number: int
    source: Source
    common: Inputs
    inputs: Inputs

    @property
    def overrides(self) -> list[str]:
        """Overrides of the scene, as `load_scene` takes them."""
        return [f"{key}={json.dumps(value)}" for key, value in (self.common | self.inputs).items()]


@dataclass(frozen=True)
class Study:
    """All ribbons of a batch, in order.

    Attributes
    ----------
    name : str
        Name of the study.
    sweeps : tuple of Sweep
        Scenes and their inputs.
    save : str
        Which full solutions are kept: all, failed or none.
    time_limit : float
        Seconds that a ribbon may take.
    """

    name: str
    sweeps: tuple[Sweep, ...]
    save: Literal["all", "failed", "none"] = "failed"
    time_limit: float = 300.0

    @property
    def count(self) -> int:
        """Number of ribbons."""
        return sum(len(sweep.inputs) for sweep in self.sweeps)

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of all inputs, in order."""
        found: dict[str, None] = {}
        for sweep in self.sweeps:
            for inputs in sweep.inputs:
                found |= dict.fromkeys(inputs)
        return tuple(found)

    @property
    def ribbons(self) -> Iterator[Ribbon]:
        """The ribbons, numbered from 1."""
        numbers = itertools.count(1)
        for sweep in self.sweeps:
            for inputs in sweep.inputs:
                yield Ribbon(next(numbers), sweep.source, sweep.common, inputs)

    def check(self) -> None:
        """Refuse a study whose keys fit no scene: the first ribbon of every sweep is read.

        Raises
        ------
        SceneError
            If one of the keys swept is unknown, or its first value wrong. A scene that is bad by
            itself only spoils its own rows.
        """
        for sweep in self.sweeps:
            if not (sweep.inputs[0] or sweep.common):
                continue
            try:
                loads_scene(sweep.source.text, sweep.source.name)
            except SceneError:
                continue
            ribbon = Ribbon(1, sweep.source, sweep.common, sweep.inputs[0])
            loads_scene(sweep.source.text, sweep.source.name, ribbon.overrides)

    @property
    def digest(self) -> str:
        """What tells this study from others: everything that decides its rows."""
        parts = [[sweep.source.text, sweep.common, list(sweep.inputs)] for sweep in self.sweeps]
        return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def load_study(paths: Sequence[str | Path], overrides: Sequence[str] = ()) -> Study:
    """Read study files, scenes, folders of them and patterns such as `scenes/*.yaml`.

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
        data = plain_yaml(text, str(file))
        if isinstance(data, dict) and ("sweep" in data or "scene" in data):
            sweeps += _study(file, data, common)
            settings |= {key: data[key] for key in ("save", "time_limit") if key in data}
            settings.setdefault("name", str(data.get("name", file.stem)))
        else:
            sweeps.append(Sweep(Source(str(file), text), common, ({},)))
    name = settings.pop("name", None) or (files[0].stem if len(files) == 1 else "batch")
    study = Study(name, tuple(sweeps), **settings)
    if not study.count:
        raise SceneError(f"{', '.join(map(str, paths))}: the sweep is empty; give it values")
    return study


def _files(path: str) -> list[Path]:
    """Files that a path, a folder or a pattern stands for, sorted."""
    if Path(path).is_dir():
        found = sorted(file for file in Path(path).iterdir() if file.suffix in (".yaml", ".yml"))
        if not found:
            raise SceneError(f"{path}: holds no .yaml file; name a folder of scenes")
        return found
    if any(character in path for character in "*?["):
        matches = sorted(glob.glob(path, recursive=True))
        if not matches:
            raise SceneError(f"{path}: no file matches")
        return [Path(match) for match in matches]
    return [Path(path)]


def _study(file: Path, data: dict[str, Any], common: Inputs) -> list[Sweep]:
    def fail(key: str, message: str) -> SceneError:
        return SceneError(f"{file}: {key}: {message}")

    for key in data:
        if key not in KEYS:
            raise fail(str(key), f"unknown key of a study; expected {', '.join(KEYS)}")
    if data.get("save", "none") not in SAVE:
        raise fail("save", f"found {data['save']!r}, expected one of {', '.join(SAVE)}")
    limit = data.get("time_limit", 1.0)
    if not isinstance(limit, int | float) or isinstance(limit, bool) or not limit > 0:
        raise fail("time_limit", f"found {limit!r}, expected a number of seconds > 0")
    given = data.get("set") or {}
    if not isinstance(given, dict):
        raise fail("set", f"found {given!r}, expected keys of the scene and their values")
    sweep = data.get("sweep")
    inputs = [{}] if sweep is None else list(inputs_of(file, sweep))
    scenes = data.get("scene")
    if scenes is None:
        raise fail("scene", "missing; name a scene file, or several, or write a scene here")
    sources = [_source(file, item) for item in (scenes if isinstance(scenes, list) else [scenes])]
    return [Sweep(source, given | common, tuple(inputs)) for source in sources]


def _source(file: Path, item: Any) -> Source:
    if isinstance(item, dict):
        return Source(f"{file}: scene", json.dumps(item))
    if not isinstance(item, str):
        raise SceneError(f"{file}: scene: found {item!r}, expected the name of a scene file")
    path = file.parent / item
    return Source(str(path), text_of(path))


def _assignment(text: str) -> tuple[str, Any]:
    key, equals, value = text.partition("=")
    if not equals:
        raise SceneError(f"--set {text}: expected path=value, such as law.epsilon=1e-3")
    return key.strip(), plain_yaml(value, f"--set {text}")
