"""How a scene says that its ribbon stays in the plane across d2, and how it is told of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from .faults import Problem
from .model import Scene


class Said(NamedTuple):
    """What a scene says of a plane, in its words, the key of these, and what to write instead."""

    words: str
    key: str
    instead: str


def held(scene: Scene) -> Scene:
    """Return a scene with the states that `planar: true` stands for; any other as it is."""
    return replace(scene, states="planar") if scene.planar and scene.states != "planar" else scene


def said(scene: Scene) -> Said:
    """Return how a scene with planar states says that they are."""
    if scene.planar:
        return Said("planar: true", "planar", "leave planar out")
    return Said("states: planar", "states", "use states: reduced")


def check_plane(scene: Scene) -> Iterator[Problem]:
    """Yield what contradicts `planar: true`."""
    if scene.planar and scene.states == "full":
        message = "states: full has what is across the plane as well; leave one of the two out"
        yield Problem(("planar",), message, "true")
