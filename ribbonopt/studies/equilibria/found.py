"""What a search for all equilibria has found: each with its images, its count, its energy."""

from __future__ import annotations

from functools import cached_property

from ribbonopt.checks.stability import SecondVariation, negative_within_plane, second_variation
from ribbonopt.classes import dataclass
from ribbonopt.plain import Row
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import error_of


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """One equilibrium, with those that a symmetry carries it into.

    Attributes
    ----------
    images : tuple of Solution
        Itself, then its images, each verified.
    symmetry : str
        What leaves it as it is, in words; "" for nothing.
    found_by : str
        What led to it first.
    """

    images: tuple[Solution, ...]
    symmetry: str
    found_by: str

    @property
    def solution(self) -> Solution:
        """The first of its images."""
        return self.images[0]

    @cached_property
    def variation(self) -> SecondVariation | str:
        """Second variation of the energy or, in words, why there is none."""
        return second_variation(self.solution)

    @property
    def negative(self) -> int | None:
        """Number of negative directions, in space; None where it is not known.

        In the plane where only that was looked at, see `SecondVariation.planar`.
        """
        return None if isinstance(self.variation, str) else self.variation.negative

    @property
    def in_plane(self) -> int | None:
        """The same among disturbances in the plane, of a ribbon that is held in one; else None."""
        return negative_within_plane(self.solution)

    @property
    def stable(self) -> bool | None:
        """Whether it is stable: in its plane, where it is held in one; None where not known."""
        count = self.in_plane if self.solution.scene.states == "planar" else self.negative
        return None if count is None else count == 0

    @property
    def row(self) -> Row:
        """Its numbers, energies in the units of the scene, the error relative and a bound."""
        return {
            "energy": self.solution.energy,
            "potential": potential(self.solution),
            "images": len(self.images),
            "negative": self.negative,
            "in_plane": self.in_plane,
            "stable": self.stable,
            "symmetry": self.symmetry,
            "error": error_of(self.solution),
            "found_by": self.found_by,
        }


@dataclass(frozen=True, eq=False)
class Found:
    """All that a search has found.

    Attributes
    ----------
    kinds : tuple of Equilibrium
        By increasing potential energy, or energy where no load has a potential.
    told : str
        What was searched, and how far.
    below : float
        Strain energy up to which was looked, in the units of the scene.
    points : int
        Points on the branches that were followed.
    """

    kinds: tuple[Equilibrium, ...]
    told: str
    below: float
    points: int

    @property
    def solutions(self) -> tuple[Solution, ...]:
        """Every equilibrium, each image of it too; all of one kind in a row."""
        return tuple(image for kind in self.kinds for image in kind.images)

    @property
    def rows(self) -> list[Row]:
        """Numbers of each kind, see `Equilibrium.row`."""
        return [kind.row for kind in self.kinds]

    @property
    def count(self) -> int:
        """Number of equilibria, each image counted."""
        return len(self.solutions)

    @property
    def stable(self) -> int:
        """Number of those that are known to be stable, each image counted."""
        return sum(len(kind.images) for kind in self.kinds if kind.stable)

    def __repr__(self) -> str:
        """Say how many there are, in one line."""
        return f"<Found {self.count} equilibria, {self.stable} of them stable>"
