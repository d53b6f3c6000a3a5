"""One ribbon on its way to a file, and what all formats say of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property

from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution
from ribbonopt.text import one_line
from ribbonopt.version import VERSION
from ribbonopt.views.shape import Shape

from .colours import Colours
from .mesh import ACROSS, Mesh, mesh_of

CLOSING = {0: "open", 1: "closed", -1: "closed, one-sided"}


@dataclass(frozen=True, eq=False)
class Carried:
    """A ribbon to be written.

    Attributes
    ----------
    shape : Shape
        Sampled.
    solution : Solution
        What it was sampled from.
    title : str
        Name of the scene, and which of several ribbons of it.
    colours : Colours
        Of its surface, the same for all ribbons of a branch or a batch.
    across : int
        Strips from edge to edge.
    numbers : mapping of str to float
        What tells it from the others: of a point of a branch its number and parameter, of a ribbon
        of a batch its number and inputs.
    """

    shape: Shape
    solution: Solution
    title: str
    colours: Colours
    across: int = ACROSS
    numbers: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def mesh(self) -> Mesh:
        """Its surface as faces, for all formats."""
        return mesh_of(self.shape, self.across)

    @property
    def remarks(self) -> dict[str, str]:
        """What a reader of a file wants to know first."""
        shape = self.shape
        own = "of the ribbon" if shape.own else "drawn, no width is known"
        return {
            "ribbon": self.title,
            "units": shape.units.name,
            "half_width": f"{shape.half_width:.9g} ({own})",
            "closing": CLOSING[shape.closing],
            "verified": "yes" if self.solution.verified else "no",
            "generator": f"ribbonopt {VERSION}",
        }

    @property
    def comments(self) -> list[str]:
        """The same as lines of text, with the numbers; what they say may be anything."""
        numbers = {name: f"{value:.12g}" for name, value in self.numbers.items()}
        return [one_line(f"{name}: {text}") for name, text in (self.remarks | numbers).items()]
