"""What a scene may say of the ends of a ribbon: what is held, what acts there, and loops."""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from . import limits
from .frames import AnyVector, Director, LabVector, Rotation, Triple, Value
from .schema.bounds import Bounds, InPython
from .supports import SUPPORTS, Support, SupportName

HalfTwists = Annotated[int, Bounds(most=limits.HALF_TWISTS)]


@dataclass(frozen=True)
class End:
    """What is prescribed at one end; without a `support`, everything not named is free.

    A support says what is held and makes the loads that go with what is free vanish, unless they
    are given (`force`, `moment`: dead loads). They are declared in `ribbonopt.scene.supports`;
    a declaration of one's own may stand in the place of a name, in Python. Vectors are in the lab
    frame unless named along directors; numbers may be formulas of `parameters`.

    Attributes
    ----------
    support
        What holds the end. Example: `clamped`
    position
        Place of the centre line's end r: all three lab components, or some. Example: `[0, 0, 0.7]`
        or `{y: 0}`
    directors
        The whole frame at the end: `identity` (d1, d2, d3 along x, y, z), some directors, a
        quaternion, a rotation vector, or turns. Example: `identity` or `{turns: [{z: pi/2}]}`
    d1, d2, d3
        Lab components of this director that are held, all or some, where not the whole frame is.
        Example: `{x: 0}`
    axis
        The director that a hinge, or an axis of two-fold symmetry, holds. Example: `d2`
    along
        The direction of this axis, or of the line on which the end slides; lab components, of any
        length. Example: `[0, 1, 0]`
    distance
        How far the end is held from the start (support `held`). Example: `0.5`
    force
        Force n that is given at the end: at the end of the ribbon what acts on it there, at its
        start what the ribbon carries away, so minus what acts. Example: `{d1: 0}` or `[0, 0, -3]`
    moment
        Moment m that is given at the end, with signs as for `force`. Example: `[0, 2.5, 0]`
    edge
        For law wunderlich: whether the edge across the ribbon is held straight, or is free;
        supports tell by themselves. Example: `free`
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

    Attributes
    ----------
    half_twists
        How many half twists the band has; 1 is a Moebius band, 0 a ring. Negative: mirrored.
        Example: `3`
    piece
        What the interval is, which is solved: the whole loop, a half (flip symmetry), or the
        fundamental piece of length L / (2 ``|half_twists|``) of a band with dihedral symmetry. With
        `auto` the interval is the whole loop, of which the smallest piece is solved that law, loads
        and guess allow. Example: `auto`
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
    """Conditions at both ends.

    Attributes
    ----------
    start, end
        What holds this end, and what acts there; with a `loop` both follow from it, and only the
        place of a whole or half loop may be given, as position and directors of the start.
        Example: `{support: clamped, position: [0, 0, 0], directors: identity}`
    also
        Further equations, as formulas of r, d1, d2, d3, n, m (vectors, lab frame) and n1 ... m3,
        u1, u2, u3 (along directors) at (start) or (end). Example: `["dot(n, d1(start)) = 0"]`
    loop
        Closes the ribbon to a band; in the place of conditions at its ends.
        Example: `{half_twists: 1}`
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
