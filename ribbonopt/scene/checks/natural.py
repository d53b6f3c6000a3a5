"""Natural strains that a law cannot have: no scene is solved with other ones than it says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

from ribbonopt.scene.faults import Problem
from ribbonopt.scene.laws import Sadowsky, SingleSheet, Variational
from ribbonopt.scene.model import Scene
from ribbonopt.scene.sized import Wunderlich

#: laws whose energy is that of a plate, which couples curvatures along and across
PLATES = (Sadowsky, SingleSheet, Variational, Wunderlich)


def check_natural(scene: Scene) -> Iterator[Problem]:
    """Yield what a law that is no plate cannot have: curvature across, and Poisson's ratio.

    Nor does one that has natural strains of its own take others.
    """
    natural, ribbon = scene.natural, scene.ribbon
    if natural is None or isinstance(scene.law, PLATES):
        return
    if any(member.name == "natural" for member in fields(scene.law)):
        message = f"stands beside law.natural, which law {scene.law.type} has of its own"
        yield Problem(("natural",), f"{message}; say it there, and remove this")
        return
    which = f"which law {scene.law.type} cannot have: it knows natural curvature and twist only"
    others = "or use law sadowsky, variational, single_sheet or wunderlich"
    if natural.across != 0:
        message = f"{which}; remove it, {others}"
        yield Problem(("natural", "across"), message, f"{natural.across}")
    if natural.poisson_ratio:
        message = f'{which}; write "poisson_ratio: 0", {others}'
        yield Problem(("natural", "poisson_ratio"), message, f"{natural.poisson_ratio:g}")
    elif natural.poisson_ratio is None and ribbon is not None and ribbon.poisson_ratio:
        message = f"is by default ribbon.poisson_ratio, {ribbon.poisson_ratio:g}, {which}; "
        message += f'write "poisson_ratio: 0", {others}'
        yield Problem(("natural", "poisson_ratio"), message)
