"""Rows of a file of numbers with sources: what comes out of a scene, as somebody says."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene
from ribbonopt.scene.faults import shown, suggestion

from .quantities import Quantity


@dataclass(frozen=True, eq=False)
class Claim:
    """One row: what comes out of a scene, says a source.

    Attributes
    ----------
    number : int
        Of the row in its file, from 1.
    scene : str
        Name of the scene.
    given : tuple of str
        Overrides of it.
    quantity, value, digits : str, float, int or None
        What comes out, its value, and how many significant digits of that stand; None for all.
    source, about : str
        Who says so, and what it is.
    case : Scene
        The scene with its overrides; the same object for all rows of a case.
    asked : callable
        What computes the quantity.
    """

    number: int
    scene: str
    given: tuple[str, ...]
    quantity: str
    value: float
    digits: int | None
    source: str
    about: str
    case: Scene
    asked: Quantity

    @property
    def label(self) -> str:
        """Scene, overrides and quantity in words."""
        return " ".join((self.scene, *self.given, self.quantity))

    def named(self, patterns: Sequence[str]) -> bool:
        """Whether one of some patterns is for this row; all are where there are none."""
        names = self.scene, self.quantity, f"{self.scene}/{self.quantity}"
        return not patterns or any(fnmatchcase(name, p) for name in names for p in patterns)


def chosen(claims: Sequence[Claim], patterns: Sequence[str]) -> tuple[Claim, ...]:
    """Return the rows that patterns are for; SceneError where one is for none."""
    for pattern in patterns:
        if not any(claim.named((pattern,)) for claim in claims):
            scenes = dict.fromkeys(claim.scene for claim in claims)
            near = suggestion(pattern, [*scenes, *(claim.quantity for claim in claims)])
            wanted = "expected scenes or quantities, such as half or 'fold.*'"
            raise SceneError(f"found {shown(pattern)}, which no row is named{near}; {wanted}")
    return tuple(claim for claim in claims if claim.named(patterns))
