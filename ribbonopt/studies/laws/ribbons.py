"""The ribbons of a study under another law, whose numbers are those of each ribbon."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from functools import cached_property, partial
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.scene import Law, Scene
from ribbonopt.scene.units import units_of
from ribbonopt.scene.yamlio import loads_scene
from ribbonopt.studies.batch.inputs import InputRows, Inputs
from ribbonopt.studies.batch.study import Study, Sweep, assignments

from .choice import Sizes, choices, edges_of

EDGES = ("boundary.start.edge", "boundary.end.edge")


@dataclass(frozen=True)
class Ribbons:
    """The ribbons of a study as scenes, and the laws that are wanted of them."""

    study: Study
    names: tuple[str, ...]
    given: Sizes

    @cached_property
    def lengths(self) -> list[float | None]:
        """Units of length by ribbon; None for a scene that cannot be read."""
        return [
            None if scene is None else units_of(scene).length
            for sweep in self.study.sweeps
            for scene in map(partial(_scene, sweep), sweep.inputs)
        ]

    def firsts(self) -> Iterator[Scene]:
        """Yield the first ribbon of every sweep, where it can be read."""
        for sweep in self.study.sweeps:
            scene = _scene(sweep, sweep.inputs[0])
            if scene is not None:
                yield scene

    def law(self, name: str, scene: Scene) -> Law | None:
        """Return a law with the numbers of one ribbon."""
        found = {choice.name: choice.law for choice in choices(scene, (name,), self.given)}
        return found[name]

    def under(self, name: str) -> Study:
        """Return the study under another law."""
        sweeps = tuple(self._sweep(sweep, name) for sweep in self.study.sweeps)
        return replace(self.study, sweeps=sweeps, save="none")

    def _sweep(self, sweep: Sweep, name: str) -> Sweep:
        def at(index: int) -> Inputs:
            inputs, scene = sweep.inputs[index], _scene(sweep, sweep.inputs[index])
            law = None if scene is None else self.law(name, scene)
            kept = {key: value for key, value in inputs.items() if key.split(".")[0] != "law"}
            if law is None or scene is None:
                return kept | {"law": name}
            edges = dict(zip(EDGES, edges_of(scene, law, self.given.edges), strict=True))
            said = {key: edge for key, edge in edges.items() if edge or _edge(scene, key)}
            return kept | {"law": _plain(law)} | said

        keys = tuple(dict.fromkeys((*sweep.inputs.keys, "law")))
        common = {k: v for k, v in sweep.common.items() if k.split(".")[0] != "law"}
        return replace(sweep, common=common, inputs=InputRows(sweep.inputs.size, keys, at))


def _scene(sweep: Sweep, inputs: Inputs) -> Scene | None:
    try:
        return loads_scene(sweep.source.text, sweep.source.name, assignments(sweep.common | inputs))
    except SceneError:
        return None  # its row says why


def _edge(scene: Scene, key: str) -> str | None:
    """Return what an end says of its edge by itself."""
    ends = scene.boundary.start, scene.boundary.end
    return ends[EDGES.index(key)].edge


def _plain(law: Law) -> dict[str, Any]:
    """Return a law as a scene file says it."""
    named = {f.name: getattr(law, f.name) for f in fields(law)}
    return {k: list(v) if isinstance(v, tuple) else v for k, v in named.items() if v is not None}
