"""Laws of a scene that are told by the sizes of the ribbon, which may take them from `ribbon`."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from .schema.bounds import Bounds

Stiffness = Annotated[float, Bounds(gt=0)]
Length = Annotated[float, Bounds(gt=0)]
Poisson = Annotated[float, Bounds(gt=-1, le=0.5)]


@dataclass(frozen=True)
class Wunderlich:
    """Inextensible ribbon of finite width, section 6.3.

    Attributes
    ----------
    width
        Width, a length; by default that of `ribbon`. Example: `0.1`
    """

    type: Literal["wunderlich"] = "wunderlich"
    width: Length | None = None

    def of_sizes(self, width: float, thickness: float, ratio: float) -> Wunderlich:
        """Return the law with the numbers of a ribbon where it has none of its own."""
        return replace(self, width=_or(self.width, width))

    def in_units(self, stiffness: float, strain: float) -> Wunderlich:
        """Return the same law, its numbers divided by these units."""
        return self if self.width is None else replace(self, width=self.width * strain)


@dataclass(frozen=True)
class Extensible:
    """Extensible ribbon (RIBEXT) of a width and a thickness, between rod and Sadowsky.

    Attributes
    ----------
    width
        Width, a length; by default that of `ribbon`. Example: `0.1`
    thickness
        Thickness, a length; by default that of `ribbon`. Example: `0.001`
    poisson_ratio
        Poisson's ratio; by default that of `ribbon`. Example: `0.3`
    """

    type: Literal["extensible"] = "extensible"
    width: Length | None = None
    thickness: Length | None = None
    poisson_ratio: Poisson | None = None

    def of_sizes(self, width: float, thickness: float, ratio: float) -> Extensible:
        """Return the law with the numbers of a ribbon where it has none of its own."""
        sizes = _or(self.width, width), _or(self.thickness, thickness)
        return Extensible(self.type, *sizes, _or(self.poisson_ratio, ratio))

    def in_units(self, stiffness: float, strain: float) -> Extensible:
        """Return the same law, its numbers divided by these units."""
        lengths = {"width": self.width, "thickness": self.thickness}
        known = {name: value * strain for name, value in lengths.items() if value is not None}
        return replace(self, **known)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Sano:
    """Sano and Wada's ribbon: W = (B2 u2^2 + B3 u3^2 + u3^4 / (1/zeta^2 + u2^2)) / 2.

    Attributes
    ----------
    B2
        Stiffness of bending in units of Dw; by default of `ribbon`: 1 - nu^2. Example: `0.91`
    B3
        Stiffness of twist in units of Dw; by default of `ribbon`: 2 (1 - nu). Example: `1.4`
    zeta
        Length of the quartic term; by default of `ribbon`: zeta^2 = (1 - nu^2) w^4 / (60 h^2).
        Example: `0.5`
    """

    type: Literal["sano"] = "sano"
    B2: Stiffness | None = None
    B3: Stiffness | None = None
    zeta: Length | None = None

    def of_sizes(self, width: float, thickness: float, ratio: float) -> Sano:
        """Return the law with the numbers of a ribbon where it has none of its own."""
        zeta = ((1 - ratio**2) / 60) ** 0.5 * width**2 / thickness
        moduli = _or(self.B2, 1 - ratio**2), _or(self.B3, 2 * (1 - ratio))
        return Sano(self.type, *moduli, _or(self.zeta, zeta))

    def in_units(self, stiffness: float, strain: float) -> Sano:
        """Return the same law, its numbers divided by these units."""
        return self if self.zeta is None else replace(self, zeta=self.zeta * strain)


#: laws that know the edges of the ribbon
OfWidth = Wunderlich

#: laws whose numbers are those of the `ribbon` of a scene where they are not said
Sized = Wunderlich | Extensible | Sano


def missing_of(law: Sized) -> list[str]:
    """Return the names of the numbers that a law does not say."""
    return [f.name for f in fields(law) if getattr(law, f.name) is None]


def _or(own: float | None, other: float) -> float:
    return other if own is None else own
