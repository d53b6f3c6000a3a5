"""What all verbs share: exit status, reading the scene, columns to draw."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from ribbonopt.errors import RibbonoptError, SceneError

from .terminal import complain

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.scene import Scene

BAD_INPUT, NOT_CONVERGED = 2, 3
INTERRUPTED, READER_GONE = 130, 141
BESIDE = {"continue": "-branch", "map": "-map"}


def load(options: argparse.Namespace) -> tuple[Scene, float]:
    """Read the scene; also return the seconds that imports took."""
    start = time.perf_counter()
    from ribbonopt.scene import load_scene

    reading = time.perf_counter()
    scene = load_scene(options.scene, options.set)
    # The heavy import comes after the scene is known to be good.
    read = time.perf_counter()
    import ribbonopt.pipeline.prepared  # noqa: F401

    return scene, (reading - start) + (time.perf_counter() - read)


def refuse_idle_verbose(options: argparse.Namespace) -> None:
    """Refuse `--verbose` beside what prints nothing but its own."""
    if options.verbose and (options.json or options.quiet):
        other = "--json" if options.json else "--quiet"
        raise SceneError(f"--verbose: found {other} as well, which prints nothing but its own")


def default_folder(name: str, verb: str) -> str:
    """Return the folder of what a verb makes of a scene, where no other is asked for.

    The branch of a scene stands beside its solution, and so does its map.
    """
    return f"results/{name}{BESIDE.get(verb, '')}"


def pairs_of(texts: list[str] | None) -> list[tuple[str, str]] | None:
    """Read the X:Y of `--plot`; None where no figure is wanted."""
    if texts is None:
        return None
    pairs = []
    for text in texts:
        x, colon, y = text.partition(":")
        if not (x and colon and y):
            raise SceneError(f"--plot: found {text!r}; expected X:Y, such as law.epsilon:energy")
        pairs.append((x, y))
    return pairs


def listing(folder: Path) -> str:
    """Return a folder and what is in it."""
    return f"{folder}: {', '.join(sorted(path.name for path in folder.iterdir()))}"


def say_left_out(left_out: Iterable[str]) -> None:
    """Say on stderr what could not be drawn or written, and why."""
    for text in left_out:
        complain(f"left out: {text}")


def drawn(draw: Callable[[], object]) -> int:
    """Draw what was asked for besides numbers, and return the exit status.

    The numbers are on disk by now: whatever a picture comes to, it is told, and nothing is lost.
    """
    try:
        draw()
    except Exception as error:
        known = isinstance(error, RibbonoptError)
        reason = str(error) if known else f"cannot be drawn ({type(error).__name__}: {error})"
        complain(f"pictures: {reason}; the numbers are kept")
        return NOT_CONVERGED
    return 0
