"""A scene that asks for all its equilibria, solved: that of least energy, with the others."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace

from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.sought import Sought

from .all import all_equilibria
from .found import Found
from .search import Tell, quiet


def solved(
    scene: Scene,
    prepared: Prepared | None = None,
    *,
    known: Iterable[Solution] = (),
    tell: Tell = quiet,
) -> Solution:
    """Return the equilibrium of least potential energy, all others as its `others`.

    Arguments and errors as of `all_equilibria`.
    """
    started = time.perf_counter()
    return as_one(all_equilibria(scene, prepared, known=known, tell=tell), started)


def as_one(found: Found, started: float) -> Solution:
    """Return what was found as one solution, with what it has cost since a time."""
    seconds = time.perf_counter() - started
    told: list[Solution] = []
    for kind in found.kinds:
        number = len(told) + 1
        for image in kind.images:
            said = Sought(number, kind.symmetry, kind.found_by, "" if told else found.told)
            told.append(replace(image, sought=said))
    first, *others = told
    step = {"step": f"search for all equilibria: {len(told)} in all", "seconds": seconds}
    spent = {name: first.timings.get(name, 0.0) + seconds for name in ("rest", "total")}
    return replace(
        first,
        others=tuple(others),
        steps=(*first.steps, step),
        timings={**first.timings, **spent},
    )
