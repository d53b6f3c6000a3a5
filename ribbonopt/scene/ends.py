"""What a scene may say of the ends of a ribbon: components, frames, supports, and loops.

A `Value` is a number, or a formula of the scene's `parameters` such as "1 - shortening". Vectors
are in the lab frame unless named along directors; angles are in radians.
"""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from . import limits
from .schema.bounds import Bounds, InPython
from .supports import SUPPORTS, Support, SupportName

Value = float | str
Triple = tuple[Value, Value, Value]
Director = Literal["d1", "d2", "d3"]
HalfTwists = Annotated[int, Bounds(most=limits.HALF_TWISTS)]


@dataclass(frozen=True)
class LabVector:
    """Some components of a vector in the lab frame; those not named are left free."""

    x: Value | None = None
    y: Value | None = None
    z: Value | None = None


@dataclass(frozen=True)
class AnyVector:
    """Some components of a vector: in the lab frame (x, y, z) or along directors (d1, d2, d3)."""

    x: Value | None = None
    y: Value | None = None
    z: Value | None = None
    d1: Value | None = None
    d2: Value | None = None
    d3: Value | None = None


@dataclass(frozen=True)
class Directors:
    """A whole frame: two or three of its directors, each by its lab components."""

    d1: Triple | None = None
    d2: Triple | None = None
    d3: Triple | None = None


@dataclass(frozen=True)
class Quaternion:
    """A whole frame: the unit quaternion, scalar first, that turns the lab axes to directors."""

    quaternion: tuple[Value, Value, Value, Value]


@dataclass(frozen=True)
class RotationVector:
    """A whole frame: axis times angle of the rotation that takes the lab axes to the directors.

    More than half a turn counts as in `turns`.
    """

    rotation_vector: Triple


@dataclass(frozen=True)
class Turn:
    """One rotation by an angle about one named axis: of the lab, or a director as it then is."""

    x: Value | None = None
    y: Value | None = None
    z: Value | None = None
    d1: Value | None = None
    d2: Value | None = None
    d3: Value | None = None


@dataclass(frozen=True)
class Turns:
    """A whole frame: the lab axes after these rotations in order; more than half a turn counts.

    Where one is by more than half a turn, the automatic start winds the ribbon so, whole turns
    included, from the frame of its start. Equations and other guesses know of the frame alone.
    """

    turns: tuple[Turn, ...]


Rotation = Literal["identity"] | Directors | Quaternion | RotationVector | Turns


@dataclass(frozen=True)
class End:
    """What is prescribed at one end; without a `support`, everything not named is free.

    A support says what is held and makes the loads that go with what is free vanish, unless they
    are given (`force`, `moment`: dead loads). They are declared in `ribbonopt.scene.supports`;
    a declaration of one's own may stand in the place of a name, in Python.

    `edge` says for law wunderlich whether the edge across the ribbon is held straight, which
    supports tell by themselves (see `ribbonopt.scene.edges`).
    """

    support: SupportName | Annotated[Support, InPython()] | None = None
    position: Triple | LabVector | None = None
    directors: Rotation | None = None
    d1: Triple | LabVector | None = None
    d2: Triple | LabVector | None = None
    d3: Triple | LabVector | None = None
    axis: Director | None = None
    along: Triple | None = None
    distance: Value | None = None
    force: Triple | AnyVector | None = None
    moment: Triple | AnyVector | None = None
    edge: Literal["straight", "free"] | None = None

    @property
    def declared_support(self) -> Support | None:
        """What the support holds and leaves free; None without one."""
        return SUPPORTS[self.support] if isinstance(self.support, str) else self.support


@dataclass(frozen=True)
class Loop:
    """A closed band of `half_twists` (2 (twist + writhe) of its directors; negative: mirrored).

    The interval is the `piece` that is solved: the whole loop, a half (flip symmetry), or the
    fundamental one of length L / (2 |half_twists|) of a band with dihedral symmetry. With `auto` it
    is the whole loop, of which the smallest piece is solved that law, loads and guess allow.
    """

    half_twists: HalfTwists
    piece: Literal["whole", "half", "fundamental", "auto"] = "whole"

    @property
    def pieces(self) -> int:
        """How many pieces make the whole loop, one of which is solved."""
        fundamental = 2 * max(abs(self.half_twists), 1)
        return {"whole": 1, "auto": 1, "half": 2, "fundamental": fundamental}[self.piece]

    @property
    def fundamental(self) -> Loop:
        """The same loop, of which the fundamental piece is solved."""
        return Loop(self.half_twists, "fundamental")


@dataclass(frozen=True)
class Boundary:
    """Conditions at both ends; `also` holds further equations as formulas.

    With a `loop`, both ends follow from it, and only the place of a whole or half loop may be
    given, as position and directors of the start.
    """

    start: End = End()
    end: End = End()
    also: tuple[str, ...] = ()
    loop: Loop | None = None

    @property
    def flips(self) -> int:
        """How many ends are at an axis of two-fold symmetry, and say so."""
        return sum(end.support == "flip" for end in (self.start, self.end))

    @property
    def pieces(self) -> int:
        """How many times what is solved makes all of it, where the scene says so."""
        if self.loop is not None:
            return self.loop.pieces
        return 2 if self.flips == 1 else 1

    @property
    def repeats(self) -> bool:
        """Whether symmetry repeats what is solved."""
        return self.pieces > 1 or self.flips > 0
