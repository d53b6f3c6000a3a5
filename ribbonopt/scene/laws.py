"""What a scene says of the constitutive law: its name and its numbers, no mechanics.

The relations themselves are in `ribbonopt.mechanics.laws`, a file for each kind. A law of one's own
stands in a scene built in Python: a frozen dataclass as those here, that says itself what it stands
for (`OwnLaw`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, ClassVar, Literal, Protocol, runtime_checkable

from ribbonopt.classes import dataclass

from .faults import KeyPath
from .schema.bounds import Bounds, InPython
from .sized import Extensible, Sano, Wunderlich


@dataclass(frozen=True)
class Kirchhoff:
    """Linear rod, section 2: m2 = B2 u2, m3 = B3 u3 and u1 = 0.

    Attributes
    ----------
    B2
        Stiffness of bending about d2, in units of Dw. Example: `0.91`
    B3
        Stiffness of twist, in units of Dw. Example: `1.4`
    """

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

    Numbers have paths such as law.B.d1 and law.natural.d3.

    Attributes
    ----------
    B
        Stiffnesses in units of Dw: of bending about d1 and d2, and of twist.
        Example: `[100, 1, 2]`
    natural
        Strains k1, k2, k3 without stress (1 / length). Example: `[0, 2, 0]`
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
    """One sheet of Sadowsky's relation, eq. (B 1) with its sign mended.

    Attributes
    ----------
    chi
        Which sheet: the sign of u2. Example: `-1`
    """

    type: Literal["single_sheet"] = "single_sheet"
    chi: Literal[1, -1] = 1


@dataclass(frozen=True)
class Regularized:
    """Sadowsky's law smoothed, eq. (6.1); no energy.

    Attributes
    ----------
    epsilon
        How much it is smoothed; 0 is Sadowsky's law. Example: `1e-3`
    """

    type: Literal["regularized"] = "regularized"
    epsilon: Annotated[float, Bounds(ge=0)] = 0.01


@dataclass(frozen=True)
class Homotopy:
    """From rod to ribbon, eq. (C 1); no energy.

    Attributes
    ----------
    rho
        How far it is on the way: 0 is the rod, 1 the ribbon. Example: `0.5`
    epsilon
        How much the ribbon's part is smoothed, as in `regularized`. Example: `1e-3`
    """

    type: Literal["homotopy"] = "homotopy"
    rho: Annotated[float, Bounds(ge=0, le=1)] = 1.0
    epsilon: Annotated[float, Bounds(ge=0)] = 0.0


@dataclass(frozen=True)
class Variational:
    """Smooth law that keeps an energy: W_Leg = (sqrt(m2^2 + delta^2 m3^2) + ``|m|``)^2 / 8.

    Attributes
    ----------
    delta
        How much it is smoothed; towards 0 it becomes Sadowsky's law, 1 is a rod.
        Example: `0.01`
    """

    type: Literal["variational"] = "variational"
    delta: Annotated[float, Bounds(gt=0, le=1)] = 0.01


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
