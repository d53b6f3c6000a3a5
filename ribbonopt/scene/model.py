"""The scene: everything a user may say about one ribbon, as frozen data.

Python users build these classes directly, YAML users through `load_scene`; both are validated by
the same schema (`ribbonopt.scene.validation`). Units: Dw = L = 1 (section 2 of the paper).
A `Value` is a number, or a formula of the scene's `parameters` such as "1 - shortening".
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, Literal

from .bounds import Bounds
from .laws import Law

Value = float | str
Triple = tuple[Value, Value, Value]
Numbers3 = tuple[float, float, float]


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
class End:
    """What is prescribed at one end; everything not named is free."""

    position: Triple | LabVector | None = None
    directors: Literal["identity"] | Directors | None = None
    d1: Triple | LabVector | None = None
    d2: Triple | LabVector | None = None
    d3: Triple | LabVector | None = None
    force: Triple | AnyVector | None = None
    moment: Triple | AnyVector | None = None


@dataclass(frozen=True)
class Boundary:
    """Conditions at both ends; `also` holds further equations as formulas."""

    start: End = End()
    end: End = End()
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class LoadGuess:
    """Guess by the force and moment at the start (lab frame), integrated along the ribbon."""

    force: Numbers3
    moment: Numbers3


@dataclass(frozen=True)
class StrainGuess:
    """Guess by constant strains (u2, u3): an arc or helix from the start, no loads to be known."""

    strains: tuple[float, float]


@dataclass(frozen=True)
class SolutionGuess:
    """Guess by a saved solution: a result folder or its `solution.npz`."""

    solution: str


@dataclass(frozen=True)
class Collocation:
    """Collocation: polynomials of a degree on a number of intervals."""

    type: Literal["collocation"] = "collocation"
    scheme: Literal["gauss", "radau", "lobatto"] = "gauss"
    degree: Annotated[int, Bounds(ge=1, le=10)] = 6
    intervals: Annotated[int, Bounds(ge=1)] = 10


@dataclass(frozen=True)
class Shooting:
    """Multiple shooting: every interval integrated by a number of Runge-Kutta steps.

    `rk4` and `rk8` are explicit, `gauss` is implicit, of the given degree; one interval is single
    shooting.
    """

    type: Literal["shooting"] = "shooting"
    scheme: Literal["rk4", "rk8", "gauss"] = "rk8"
    steps: Annotated[int, Bounds(ge=1)] = 1
    degree: Annotated[int, Bounds(ge=1, le=10)] = 3
    intervals: Annotated[int, Bounds(ge=1)] = 20


@dataclass(frozen=True)
class Algebraic:
    """The differential-algebraic form (3.1), with or without the bounds |eta| <= 1 of (4.1)."""

    type: Literal["algebraic"] = "algebraic"
    bounds: bool = True


@dataclass(frozen=True)
class Auto:
    """Newton where it is enough (square equations), IPOPT where it is not."""

    type: Literal["auto"] = "auto"


@dataclass(frozen=True)
class Ipopt:
    """IPOPT: globalised, bounded, able to minimise; `tolerance` is that of the nonlinear solver."""

    type: Literal["ipopt"] = "ipopt"
    tolerance: Annotated[float, Bounds(gt=0)] = 1e-12
    max_iterations: Annotated[int, Bounds(ge=1)] = 200


@dataclass(frozen=True)
class Newton:
    """Newton's method with kept factors; `tolerance` is relative to the size of the unknowns."""

    type: Literal["newton"] = "newton"
    tolerance: Annotated[float, Bounds(gt=0)] = 1e-13
    max_iterations: Annotated[int, Bounds(ge=1)] = 50


@dataclass(frozen=True)
class Reference:
    """Loads at the start (lab frame) known from elsewhere: the truth for `ribbonopt compare`."""

    n0: Numbers3
    m0: Numbers3


@dataclass(frozen=True)
class Scene:
    """One ribbon: its law, its interval, its boundary conditions and how to solve it."""

    name: str
    law: Law
    boundary: Boundary
    guess: LoadGuess | StrainGuess | SolutionGuess
    formulation: Literal["inverted", "algebraic", "differentiated", "energy"] | Algebraic = (
        "inverted"
    )
    states: Literal["reduced", "full"] = "reduced"
    interval: tuple[float, float] = (0.0, 1.0)
    parameters: dict[str, float] = field(default_factory=dict)
    transcription: Collocation | Shooting = Collocation()
    solver: Auto | Ipopt | Newton = Auto()
    reference: Reference | None = None
