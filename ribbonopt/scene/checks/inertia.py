"""An inertia of sections that turn which says nothing, too much, or takes a width that none has."""

from __future__ import annotations

from collections.abc import Iterator

from ribbonopt.scene.faults import Problem, shown
from ribbonopt.scene.inertia import AnyInertia, Inertia
from ribbonopt.scene.model import Scene
from ribbonopt.scene.sized import Sized


def check_inertia(scene: Scene, inertia: AnyInertia) -> Iterator[Problem]:
    """Yield what is wrong with the inertia of a scene."""
    start, end = scene.interval
    if not isinstance(inertia, Inertia):
        own = getattr(scene.law, "width", None) if isinstance(scene.law, Sized) else None
        if scene.ribbon is None and own is None:
            message = "takes its numbers from the width of `ribbon`, which this scene has not; "
            message += 'write `ribbon` with its sizes, or numbers, such as "inertia: {d3: 0.001}"'
            yield Problem(("inertia",), message, shown(inertia))
        return
    if inertia == Inertia():
        message = "says nothing; expected d1, d3 or both, such as "
        yield Problem(("inertia",), f'{message}"inertia: {{d3: 0.001}}"; or remove it', "{}")
    for name, value in vars(inertia).items():
        if value > (end - start) ** 2:
            message = "is the square of a radius of gyration, w^2/12 of a strip of width w; "
            message += f"expected at most the squared length, {(end - start) ** 2:g}"
            yield Problem(("inertia", name), message, f"{value:g}")
