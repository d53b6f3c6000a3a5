"""A band of several half twists from its fundamental piece, solved in the scene's own law.

Least energy untwists a band, and where a law changes sheets a guess must know where: the piece has
one sign change of m2 at most, and its images have the others.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ribbonopt.guess.flat import Flattened, nearly_flat
from ribbonopt.scene import Scene
from ribbonopt.starts.loops import fundamental_scene
from ribbonopt.starts.unfold import Unfolded

from .search import Search

LEAST = 4  # intervals on every piece of a guess that is nearly the solution

if TYPE_CHECKING:
    from .prepared import Prepared


def piece_of(scene: Scene) -> Prepared | None:
    """Return the fundamental piece of a band, prepared; None where a scene is no more than that."""
    from .prepared import prepare

    scene = fundamental_scene(scene)
    return None if scene is None else prepare(replace(scene, tolerance=None))


def run_unfolded(search: Search, piece: Prepared) -> bool:
    """Try what unfolds from the solution of a piece; whether that succeeds."""
    posed = search.posed
    scene, loop = fundamental_scene(posed.scene), posed.scene.boundary.loop
    assert scene is not None and loop is not None
    found = piece.solve(replace(scene, tolerance=None))
    search.ledger.steps.extend(found.steps)
    if not found.verified:
        return False
    count = loop.fundamental.pieces // loop.pieces
    unfolded = Unfolded(found, loop.half_twists, count, *posed.start)
    if nearly_flat(found) and search.run(Flattened(unfolded), quick=True):
        return True
    arcs = unfolded.arcs
    if arcs is None:
        return search.run(unfolded, quick=True)
    return search.run_in(arcs, unfolded, LEAST * count)
