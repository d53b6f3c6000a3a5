"""What ends do to the edges of a ribbon of finite width: the own states eta and p of its law.

An edge that is held straight across the ribbon has eta = 0; where nothing holds it p = 0. Where the
ends of a closed band meet both continue, with their signs changed as those of d1 and d2 are.
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.scene import Scene
from ribbonopt.scene.edges import Edge, edge_of

from .conditions import Condition, Context, EndName, Named
from .loops import axis_at_end


@dataclass(frozen=True, eq=False)
class EdgeHeld(Condition):
    """The edge of an end is held straight, or free; nothing under a law that has no edges."""

    end: EndName
    edge: Edge

    @property
    def kinematic(self) -> bool:
        return self.edge == "straight"

    def theta(self) -> dict[str, float]:
        return {}

    def residuals(self, context: Context) -> Named:
        own, which = context.ends[self.end].rod.own, 0 if self.edge == "straight" else 1
        if own.numel() <= which:  # another law, or p where it is a costate
            return {}
        meaning = "eta = 0" if self.edge == "straight" else "p = 0"
        return {f"boundary.{self.end}.edge ({meaning})": own[which]}


@dataclass(frozen=True, eq=False)
class EdgesMeet(Condition):
    """The edges of both ends are one, `sign` being that of d1 and d2 at the end.

    `state` is 0 for eta, 1 for p.
    """

    sign: float
    state: int

    @property
    def kinematic(self) -> bool:
        return self.state == 0

    def theta(self) -> dict[str, float]:
        return {}

    def residuals(self, context: Context) -> Named:
        start, end = (context.ends[name].rod.own for name in ("start", "end"))
        if end.numel() <= self.state:
            return {}
        difference = end[self.state] - self.sign * start[self.state]
        return {f"boundary.loop ({('eta', 'p')[self.state]} returns)": difference}


def edge_conditions(scene: Scene) -> list[Condition]:
    """Return the conditions on the edges of both ends of a scene."""
    loop = scene.boundary.loop
    if loop is None:
        ends: tuple[EndName, EndName] = ("start", "end")
        edges = [(name, edge_of(getattr(scene.boundary, name))) for name in ends]
        return [EdgeHeld(name, edge) for name, edge in edges if edge is not None]
    if loop.piece == "whole":
        sign = -1.0 if loop.half_twists % 2 else 1.0
        return [EdgesMeet(sign, 0), EdgesMeet(sign, 1)]
    director, _ = axis_at_end(loop.half_twists, 2 * ca.pi / loop.pieces)
    return [EdgeHeld("start", "free"), EdgeHeld("end", "straight" if director == "d2" else "free")]
