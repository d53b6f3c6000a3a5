"""Independent answers near an answer: solved again from it by other schemes on other meshes.

The equations are the inverted ones whatever the scene's formulation was, the error much less than
the bar that is tested. What comes out must be as near as the bar says; if nothing does, the answer
was none. An answer of which a first witness says otherwise is heard before a second.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ribbonopt.errors import RibbonoptError
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Auto, Collocation, Scene, Shooting
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

LEAST, MOST = 24, 300  # intervals of a witness
TIGHT, SHARPER = 1e-12, 1e-3  # its tolerance: the least, and that over the one that is tested
USUAL = 1e-9  # tolerance of what has none
SHOTS = 2  # steps of shooting in each interval
SOLVED = (Status.CONVERGED, Status.TOLERANCE_MISSED, Status.ROUNDED)


def witnesses(solution: Solution) -> Iterator[Solution]:
    """Yield what other schemes make of an answer, those that solve it; bars are their own."""
    for scene in _asked(solution):
        try:
            found = prepare(scene).polish(solution)
        except (RibbonoptError, np.linalg.LinAlgError):  # this scheme does not suit the law
            continue
        if found.status in SOLVED:
            yield found


def _asked(solution: Solution) -> Iterator[Scene]:
    """Yield the scene as others solve it."""
    scene = solution.scene
    given = scene.transcription
    degree = getattr(given, "degree", 0)
    count = int(np.clip(2 * len(solution.nodes), LEAST, MOST))
    tolerance = max(TIGHT, SHARPER * (scene.tolerance or USUAL))
    asked = replace(
        scene,
        formulation="inverted",
        states="planar" if scene.states == "planar" else "reduced",
        solver=Auto(),
        guess="auto",
        starts=1,
        switching="auto",
        tolerance=tolerance,
        continuation=None,
        record={},
    )
    other = 7 if degree == 6 else 6
    radau = "gauss" if getattr(given, "scheme", "") == "radau" else "radau"
    meshes: tuple[Collocation | Shooting, ...] = (
        Collocation(scheme=radau, degree=other, intervals=count),  # type: ignore[arg-type]
        Shooting(scheme="rk8", steps=SHOTS, intervals=count),
        Collocation(scheme="gauss", degree=8 if degree == 10 else 10, intervals=count),
    )
    for mesh in meshes:
        yield replace(asked, transcription=mesh)
