"""Whether the ends of a ribbon that has a width say what they do to its edges."""

from __future__ import annotations

from collections.abc import Iterator

from ribbonopt.scene.edges import edge_of
from ribbonopt.scene.faults import Problem
from ribbonopt.scene.model import Scene
from ribbonopt.scene.sized import OfWidth


def check_edges(scene: Scene) -> Iterator[Problem]:
    """Yield ends whose edges are said of a law without any, and ends that leave theirs open."""
    boundary = scene.boundary
    for name in ("start", "end"):
        end, path = getattr(boundary, name), ("boundary", name, "edge")
        if not isinstance(scene.law, OfWidth):
            if end.edge is not None:
                law = f"law {scene.law.type}"
                message = f"{law} knows no edges, only law wunderlich does; remove it"
                yield Problem(path, message, repr(end.edge))
        elif boundary.loop is not None:
            if end.edge is not None:
                message = "a loop tells what its ends do to their edges; remove it"
                yield Problem(path, message, repr(end.edge))
        elif end.edge is not None and end.support == "flip":
            message = "an axis of symmetry tells what is done to the edge there; remove it"
            yield Problem(path, message, repr(end.edge))
        elif edge_of(end) is None:
            yield Problem(
                path,
                "missing; law wunderlich needs to know whether the end holds its edge straight "
                "across the ribbon: write straight (a clamp, or an axis of symmetry along d2: "
                "eta = 0), or free (all else, and an axis along d1: the conjugate p = 0)",
            )
