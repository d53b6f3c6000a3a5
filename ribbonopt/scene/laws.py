"""What a scene says of the constitutive law: its name and its numbers, no mechanics.

The relations themselves are in `ribbonopt.mechanics.laws`, a file for each kind. A law of one's own
stands in a scene built in Python: a frozen dataclass as those here, that says itself what it stands
for (`OwnLaw`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal, Protocol, runtime_checkable

from .schema.bounds import Bounds, InPython


@dataclass(frozen=True)
class Kirchhoff:
    """Linear rod, section 2: m2 = B2 u2, m3 = B3 u3 and u1 = 0 (units of Dw)."""

    type: Literal["kirchhoff"] = "kirchhoff"
    B2: Annotated[float, Bounds(gt=0)] = 1.0
    B3: Annotated[float, Bounds(gt=0)] = 2.0


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
    | Sadowsky
    | SingleSheet
    | Regularized
    | Homotopy
    | Variational
    | Annotated[OwnLaw, InPython()]
)
