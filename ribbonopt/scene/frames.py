"""What a scene may say of vectors, of some of their components, and of whole frames.

A `Value` is a number, or a formula of the scene's `parameters` such as "1 - shortening". Vectors
are in the lab frame unless named along directors; angles are in radians.
"""

from __future__ import annotations

from typing import Literal

from ribbonopt.classes import dataclass

Value = float | str
Triple = tuple[Value, Value, Value]
Director = Literal["d1", "d2", "d3"]


@dataclass(frozen=True)
class LabVector:
    """Some components of a vector in the lab frame; those not named are left free.

    Attributes
    ----------
    x, y, z
        Component along this axis of the lab. Example: `0.7`
    """

    x: Value | None = None
    y: Value | None = None
    z: Value | None = None


@dataclass(frozen=True)
class AnyVector:
    """Some components of a vector: in the lab frame (x, y, z) or along directors (d1, d2, d3).

    Attributes
    ----------
    x, y, z
        Component along this axis of the lab. Example: `-2`
    d1, d2, d3
        Component along this director, which turns with the ribbon. Example: `0`
    """

    x: Value | None = None
    y: Value | None = None
    z: Value | None = None
    d1: Value | None = None
    d2: Value | None = None
    d3: Value | None = None


@dataclass(frozen=True)
class Directors:
    """A whole frame: two or three of its directors, each by its lab components.

    Attributes
    ----------
    d1, d2, d3
        Lab components of this director, a unit vector: d1 is the normal, d2 is across the width,
        d3 is the tangent. One of the three may be left out. Example: `[0, 0, 1]`
    """

    d1: Triple | None = None
    d2: Triple | None = None
    d3: Triple | None = None


@dataclass(frozen=True)
class Quaternion:
    """A whole frame: the unit quaternion that turns the lab axes to directors.

    Attributes
    ----------
    quaternion
        Its four components, scalar first. Example: `[cos(pi/4), 0, 0, sin(pi/4)]`
    """

    quaternion: tuple[Value, Value, Value, Value]


@dataclass(frozen=True)
class RotationVector:
    """A whole frame: the rotation that takes the lab axes to the directors, as a vector.

    Attributes
    ----------
    rotation_vector
        Axis times angle (radians), lab components. More than half a turn counts as in `turns`.
        Example: `[0, 0, pi/2]`
    """

    rotation_vector: Triple


@dataclass(frozen=True)
class Turn:
    """One rotation by an angle about one named axis: of the lab, or a director as it then is.

    Attributes
    ----------
    x, y, z
        Angle in radians about this axis of the lab. Example: `pi/2`
    d1, d2, d3
        Angle in radians about this director, where the turns before have left it.
        Example: `20*deg`
    """

    x: Value | None = None
    y: Value | None = None
    z: Value | None = None
    d1: Value | None = None
    d2: Value | None = None
    d3: Value | None = None


@dataclass(frozen=True)
class Turns:
    """A whole frame: the lab axes after some rotations, one after the other.

    Attributes
    ----------
    turns
        The rotations in their order. Where one is by more than half a turn, the automatic start
        winds the ribbon so, whole turns included, from the frame of its start; equations and other
        guesses know of the frame alone. Example: `[{x: pi/2}, {d3: 20*deg}]`
    """

    turns: tuple[Turn, ...]


Rotation = Literal["identity"] | Directors | Quaternion | RotationVector | Turns
