"""What a scene may say of where its solution is looked for: shapes, loads, an earlier result."""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from .ends import HalfTwists
from .frames import Value
from .schema.bounds import Bounds

Numbers3 = tuple[float, float, float]


@dataclass(frozen=True)
class LoadGuess:
    """Guess by the loads at the start, integrated along the ribbon.

    Attributes
    ----------
    force
        Force n at the start, lab frame. Example: `[0, 40, 50]`
    moment
        Moment m at the start, lab frame. Example: `[0, 3, -7]`
    """

    force: Numbers3
    moment: Numbers3


@dataclass(frozen=True)
class StrainGuess:
    """Guess by constant strains: an arc or helix from the start, no loads to be known.

    Attributes
    ----------
    strains
        Bending u2 and twist u3, both 1 / length. Example: `[6.28, 0]`
    """

    strains: tuple[float, float]


@dataclass(frozen=True)
class SolutionGuess:
    """Guess by a saved solution.

    Attributes
    ----------
    solution
        A result folder or its `solution.npz`. Example: `results/moebius-half`
    """

    solution: str


@dataclass(frozen=True)
class ArcGuess:
    """Guess by a circular arc bent about d2.

    Attributes
    ----------
    arc
        Angle by which it turns in all, in radians. Example: `pi`
    """

    arc: Value


@dataclass(frozen=True)
class Helix:
    """Helix of some turns.

    Attributes
    ----------
    turns
        How many turns it makes. Example: `2`
    rise
        Height over length: 0 makes circles, 1 a straight line; negative: the other way.
        Example: `0.5`
    """

    turns: Value
    rise: Annotated[float, Bounds(ge=-1, le=1)]


@dataclass(frozen=True)
class HelixGuess:
    """Guess by a helix from the start.

    Attributes
    ----------
    helix
        The helix. Example: `{turns: 2, rise: 0.5}`
    """

    helix: Helix


@dataclass(frozen=True)
class Band:
    """Circle whose directors turn about the tangent by half twists.

    Attributes
    ----------
    half_twists
        How many half twists the circle has; negative: mirrored. Example: `1`
    piece
        Which piece of the circle the interval is; by default that of the scene's loop, or the
        whole. Example: `half`
    """

    half_twists: HalfTwists
    piece: Literal["whole", "half", "fundamental"] | None = None


@dataclass(frozen=True)
class MoebiusGuess:
    """Guess by a twisted circle.

    Attributes
    ----------
    moebius
        The twisted circle. Example: `{half_twists: 1}`
    """

    moebius: Band


Guess = (
    Literal["auto", "circle"]
    | LoadGuess
    | StrainGuess
    | ArcGuess
    | HelixGuess
    | MoebiusGuess
    | SolutionGuess
)
