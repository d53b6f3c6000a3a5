"""A scene in one line, as Python shows it; `dump_scene` says all of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ribbonopt.text import one_line, shortened

from .ends import End

if TYPE_CHECKING:
    from .model import Scene

LONGEST = 40  # letters of a name


def in_short(scene: Scene) -> str:
    """Return name, law, interval, and how the ends are held."""
    loop, (start, end) = scene.boundary.loop, scene.interval
    if loop is None:
        both = (_support(end) for end in (scene.boundary.start, scene.boundary.end))
        held = "start {}, end {}".format(*both)
    else:
        count = f"{loop.half_twists} half twist{'s' * (abs(loop.half_twists) != 1)}"
        held = f"loop of {count}, piece {loop.piece}"
    name, law = (_name(text) for text in (scene.name, scene.law.type))
    return f"<Scene {name}: law {law}, s from {start:.6g} to {end:.6g}, {held}>"


def _support(end: End) -> str:
    """Return the name of a support; where there is none, whether anything is prescribed."""
    support = end.declared_support
    if support is None:
        return "free" if end == End() else "with conditions"
    return _name(support.name)


def _name(text: str) -> str:
    return shortened(one_line(text), LONGEST)
