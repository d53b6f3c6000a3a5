"""From a solution to one of a scene near by: on the same mesh and in the same phases first."""

from __future__ import annotations

from ribbonopt.pipeline import Prepared
from ribbonopt.scene import Scene
from ribbonopt.solution import Solution

SPARE = 0.05  # of the error that a new mesh may leave: it shall serve the neighbours to come


def solved_beside(prepared: Prepared, scene: Scene, before: Solution) -> Solution | None:
    """Return a verified solution of a scene, from that of another of its structure; None for none.

    Where the neighbour's mesh or phases do not do, its shape is the guess for all that a single
    scene may need.
    """
    search = prepared.search(scene)
    attempts = search.on_mesh(before.sheets, before.mesh, before.joined.ends[1:-1])
    if attempts.run(before, quick=True) and attempts.best is not None:
        found = attempts.best
        if found.sheets or not (search.phases_help and search.changes_sign(found)):
            found = prepared.refined(found, SPARE)
            if found.verified:
                return found
    found = prepared.solve(scene, guess=before, fallback=False)
    return found if found.verified else None
