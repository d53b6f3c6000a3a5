"""What a scene says of the constitutive law: its name and its numbers, no mechanics.

The relations themselves are in `ribbonopt.mechanics.laws`, a file for each kind. A law of one's own
stands in a scene built in Python: a frozen dataclass as those here, that says itself what it stands
for (`OwnLaw`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from typing import Annotated, Any, ClassVar, Literal, Protocol, runtime_checkable

from ribbonopt.classes import dataclass

from .faults import KeyPath
from .schema.bounds import Bounds, InPython


@dataclass(frozen=True)
class Kirchhoff:
    """Linear rod, section 2: m2 = B2 u2, m3 = B3 u3 and u1 = 0 (units of Dw)."""

    type: Literal["kirchhoff"] = "kirchhoff"
    B2: Annotated[float, Bounds(gt=0)] = 1.0
    B3: Annotated[float, Bounds(gt=0)] = 2.0

    @property
    def stiffnesses(self) -> dict[KeyPath, float]:
        """Stiffnesses by path: first that about d2, the unit of all where it is far from 1."""
        return {("B2",): self.B2, ("B3",): self.B3}

    def in_units(self, stiffness: float, strain: float) -> Kirchhoff:
        """Return the same law, its numbers divided by these units."""
        return replace(self, B2=self.B2 / stiffness, B3=self.B3 / stiffness)


Three = tuple[float, float, float]
Stiffness = Annotated[float, Bounds(gt=0)]


@dataclass(frozen=True)
class Rod:
    """Linear rod that bends about d1 too: m_i = B_i (u_i - k_i), along d1, d2, d3.

    `B` are stiffnesses (units of Dw): bending about d1 and d2, twist. `natural` are the strains
    k_i without stress (1 / L). Their paths are law.B.d1, law.natural.d3 and so on.
    """

    type: Literal["rod"] = "rod"
    B: tuple[Stiffness, Stiffness, Stiffness] = (1.0, 1.0, 1.0)
    natural: Three = (0.0, 0.0, 0.0)

    @property
    def stiffnesses(self) -> dict[KeyPath, float]:
        """Stiffnesses by path: first that about d2, the unit of all where it is far from 1."""
        return {("B", i): self.B[i] for i in (1, 2, 0)}

    def in_units(self, stiffness: float, strain: float) -> Rod:
        """Return the same law, its numbers divided by these units."""
        (B1, B2, B3), (k1, k2, k3) = self.B, self.natural
        B = B1 / stiffness, B2 / stiffness, B3 / stiffness
        return replace(self, B=B, natural=(k1 / strain, k2 / strain, k3 / strain))


#: laws that have stiffnesses of their own; those of all others are Dw
Stiff = Kirchhoff | Rod


@dataclass(frozen=True)
class Sadowsky:
    """Inverted Sadowsky law, eqs. (4.3)-(4.4)."""

    type: Literal["sadowsky"] = "sadowsky"


@dataclass(frozen=True)
class SingleSheet:
    """One sheet chi = sign(u2) of Sadowsky's relation, eq. (B 1) with its sign mended."""

    type: Literal["single_sheet"] = "single_sheet"
    chi: Literal[1, -1] = 1


@dataclass(frozen=True)
class Regularized:
    """Sadowsky's law smoothed by epsilon, eq. (6.1)."""

    type: Literal["regularized"] = "regularized"
    epsilon: Annotated[float, Bounds(ge=0)] = 0.01


@dataclass(frozen=True)
class Homotopy:
    """From rod (rho = 0) to ribbon (rho = 1), eq. (C 1)."""

    type: Literal["homotopy"] = "homotopy"
    rho: Annotated[float, Bounds(ge=0, le=1)] = 1.0
    epsilon: Annotated[float, Bounds(ge=0)] = 0.0


@dataclass(frozen=True)
class Variational:
    """Smooth law that keeps an energy: W_Leg = (sqrt(m2^2 + delta^2 m3^2) + |m|)^2 / 8."""

    type: Literal["variational"] = "variational"
    delta: Annotated[float, Bounds(gt=0, le=1)] = 0.01


Length = Annotated[float, Bounds(gt=0)]
Poisson = Annotated[float, Bounds(gt=-1, le=0.5)]


@dataclass(frozen=True)
class Wunderlich:
    """Inextensible ribbon of finite width (1 in units of L), section 6.3; by default `ribbon`'s."""

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
    """Extensible ribbon (RIBEXT) of a width and a thickness (units of L); by default `ribbon`'s."""

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

    B2 and B3 in units of Dw, zeta a length; by default of `ribbon`: 1 - nu^2, 2 (1 - nu) and
    zeta^2 = (1 - nu^2) w^4 / (60 h^2).
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


@runtime_checkable
class OwnLaw(Protocol):
    """A law declared in Python: a frozen dataclass whose fields, but `type`, are its numbers.

    They are in units Dw = L = 1, in scenes in SI too.
    """

    __dataclass_fields__: ClassVar[dict[str, Any]]

    @property
    def type(self) -> str:
        """A word for it, for reports and messages."""

    def constitutive(self, numbers: Mapping[str, Any], position: Any) -> Any:
        """Return the relation, a `ConstitutiveLaw`, from its numbers and the arclength s.

        Both are CasADi symbols: numbers that change need no new equations.
        """


Law = (
    Kirchhoff
    | Rod
    | Sadowsky
    | SingleSheet
    | Regularized
    | Homotopy
    | Variational
    | Wunderlich
    | Extensible
    | Sano
    | Annotated[OwnLaw, InPython()]
)
