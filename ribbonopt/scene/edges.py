"""What holds the end edge of a ribbon that has a width: straight across, or nothing does."""

from __future__ import annotations

from typing import Literal

from .ends import End

Edge = Literal["straight", "free"]

#: of supports that tell it; a hinge may be glued to the edge or to a point of it
_OF_SUPPORTS: dict[str, Edge] = {
    "clamped": "straight",
    "sliding": "straight",
    "pinned": "free",
    "held": "free",
    "free": "free",
}


def edge_of(end: End) -> Edge | None:
    """Return what an end does to its edge, by itself or by its support; None where that is open.

    A point on an axis of symmetry along d1 has generatrices that are symmetric about it, one along
    d2 is a generatrix itself.
    """
    if end.edge is not None:
        return end.edge
    if end.support == "flip":
        return "straight" if end.axis == "d2" else "free"
    if isinstance(end.support, str):
        return _OF_SUPPORTS.get(end.support)
    turned = any(v is not None for v in (end.directors, end.d1, end.d2, end.d3, end.support))
    if not turned:
        return "free"
    loaded = end.force is not None or end.moment is not None
    return (
        "straight"
        if end.directors is not None and end.position is not None and not loaded
        else None
    )
