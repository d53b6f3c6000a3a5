"""Supports: what each holds of an end, and which loads vanish (or are given) there.

A support is composed of parts. A part says which keys of an end it needs and takes; what it means
in the equations is in `ribbonopt.mechanics.ends.supports`, which knows parts and no support. A
support is energetically complete: the loads it prescribes do work on exactly the motions that it
leaves free, so that they are the natural conditions of the strain energy.

A new support is one entry here, with its name at the foot; in Python an instance may as well stand
in the place of a name: `End(support=Support("roller", "...", (Position("z"), ...)), ...)`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from ribbonopt.classes import dataclass

Axes = Literal["x", "y", "z", "xy", "xz", "yz", "xyz"]
Load = Literal["force", "moment"]

#: keys of an end that supports use, in the order in which messages name them, each by an example
EXAMPLES: Mapping[str, str] = {
    "position": "position: [0, 0, 0]",
    "directors": "directors: identity",
    "axis": "axis: d2",
    "along": "along: [0, 1, 0]",
    "distance": "distance: 0.5",
    "force": "force: [0, 0, 0]",
    "moment": "moment: [0, 0, 0]",
}


@dataclass(frozen=True)
class Position:
    """The point is held: all of `position`, or some of its lab components."""

    axes: Axes = "xyz"

    needs = ("position",)
    takes = ()


class PositionOnLine:
    """The point is on the line through `position` `along` a direction."""

    needs = ("position", "along")
    takes = ()


class PositionAtDistance:
    """The point is at a `distance` from the start."""

    needs = ("distance",)
    takes = ()


class WholeFrame:
    """The directors are held: `directors`, or two or three of d1, d2, d3."""

    needs = ("directors",)
    takes = ()


class AxisAlong:
    """The director `axis` points `along` a direction."""

    needs = ("axis", "along")
    takes = ()


class TautString:
    """The force is along the chord from the start."""

    needs = ()
    takes = ()


@dataclass(frozen=True)
class LoadVector:
    """A load vanishes or is given: all of it, or some of its lab components."""

    load: Load
    axes: Axes = "xyz"

    needs = ()

    @property
    def takes(self) -> tuple[str, ...]:
        """The key of the load."""
        return (self.load,)


class ForceAlongLine:
    """The force along the direction `along` vanishes, or is that of a given dead load."""

    needs = ("along",)
    takes = ("force",)


@dataclass(frozen=True)
class LoadAlongAxis:
    """A load along the director `axis` vanishes, or is given where that is said."""

    load: Load
    given: bool = False

    needs = ("axis",)

    @property
    def takes(self) -> tuple[str, ...]:
        """The key of the load, where it may be given."""
        return (self.load,) if self.given else ()


Part = (
    Position
    | PositionOnLine
    | PositionAtDistance
    | WholeFrame
    | AxisAlong
    | TautString
    | LoadVector
    | ForceAlongLine
    | LoadAlongAxis
)


@dataclass(frozen=True)
class Support:
    """One kind of support.

    Attributes
    ----------
    name
        As a scene writes it.
    says
        What it holds and what vanishes there, in a line.
    parts
        What it is composed of; conditions come in this order, six of them in all.
    """

    name: str
    says: str
    parts: tuple[Part, ...]

    @property
    def needs(self) -> tuple[str, ...]:
        """Keys that must be given."""
        found = {key for part in self.parts for key in part.needs}
        return tuple(key for key in EXAMPLES if key in found)

    @property
    def keys(self) -> tuple[str, ...]:
        """All keys it knows, those that must be given first."""
        taken = {key for part in self.parts for key in part.takes}
        return (*self.needs, *(key for key in EXAMPLES if key in taken))

    @property
    def of_chord(self) -> bool:
        """Whether it speaks of the chord from the start, so that only the end can have it."""
        return any(isinstance(part, PositionAtDistance | TautString) for part in self.parts)

    @property
    def holds(self) -> str:
        """The lab components of the point that are held: "xyz" for a fixed point."""
        return "".join(part.axes for part in self.parts if isinstance(part, Position))

    @property
    def whole_position(self) -> bool:
        """Whether `position` needs all its components."""
        return self.holds == "xyz" or any(isinstance(part, PositionOnLine) for part in self.parts)


CLAMPED = Support("clamped", "position and directors are held", (Position(), WholeFrame()))
PINNED = Support("pinned", "the position is held; no moment", (Position(), LoadVector("moment")))
HINGED = Support(
    "hinged",
    "the position is held, the director `axis` points `along`; no moment about it",
    (Position(), AxisAlong(), LoadAlongAxis("moment", given=True)),
)
SLIDING = Support(
    "sliding",
    "directors are held, the point is on the line through `position` `along` a direction; no force "
    "along it",
    (PositionOnLine(), WholeFrame(), ForceAlongLine()),
)
FREE = Support("free", "no force and no moment", (LoadVector("force"), LoadVector("moment")))
HELD = Support(
    "held",
    "(end only) at a `distance` from the start, by a string: force along it, no moment",
    (PositionAtDistance(), TautString(), LoadVector("moment")),
)
FLIP = Support(
    "flip",
    "on an axis of two-fold symmetry, the line through `position` `along` a direction, with the "
    "director `axis` along it; no force and no moment along it",
    (PositionOnLine(), AxisAlong(), LoadAlongAxis("force"), LoadAlongAxis("moment")),
)

SupportName = Literal["clamped", "pinned", "hinged", "sliding", "free", "held", "flip"]
SUPPORTS: Mapping[str, Support] = {
    support.name: support for support in (CLAMPED, PINNED, HINGED, SLIDING, FREE, HELD, FLIP)
}
