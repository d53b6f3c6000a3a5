"""What a scene may say of how it is solved: the form of its equations, their mesh, the solver."""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from . import limits
from .schema.bounds import Bounds

Intervals = Annotated[int, Bounds(ge=1, most=limits.INTERVALS)]
Iterations = Annotated[int, Bounds(ge=1, most=limits.ITERATIONS)]
SolverTolerance = Annotated[float, Bounds(gt=0, le=1)]


@dataclass(frozen=True)
class Collocation:
    """Collocation: polynomials of a degree on a number of intervals.

    Attributes
    ----------
    scheme
        Where the equations hold in each interval. Gauss of degree K has order 2 K and keeps the
        length of the quaternion and n . m to rounding; Radau has order 2 K - 1, Lobatto 2 K - 2.
    degree
        Degree K of the polynomials. Example: `8`
    intervals
        Number of intervals (elements) of the mesh, which a `tolerance` refines. Example: `20`
    """

    type: Literal["collocation"] = "collocation"
    scheme: Literal["gauss", "radau", "lobatto"] = "gauss"
    degree: Annotated[int, Bounds(ge=1, le=10)] = 6
    intervals: Intervals = 10


@dataclass(frozen=True)
class Shooting:
    """Multiple shooting: every interval integrated by a number of Runge-Kutta steps.

    Attributes
    ----------
    scheme
        The Runge-Kutta method: `rk4` and `rk8` are explicit, `gauss` is implicit.
    steps
        Steps in each interval. Example: `4`
    degree
        Degree of `gauss`, whose order is twice that; the others do not read it. Example: `3`
    intervals
        Number of intervals; one is single shooting. Example: `1`
    """

    type: Literal["shooting"] = "shooting"
    scheme: Literal["rk4", "rk8", "gauss"] = "rk8"
    steps: Annotated[int, Bounds(ge=1, most=limits.STEPS)] = 1
    degree: Annotated[int, Bounds(ge=1, le=10)] = 3
    intervals: Intervals = 20


@dataclass(frozen=True)
class Algebraic:
    """The differential-algebraic form (3.1).

    Attributes
    ----------
    bounds
        Whether the bounds ``|eta| <= 1`` of (4.1) are kept, which takes IPOPT. Example: `false`
    """

    type: Literal["algebraic"] = "algebraic"
    bounds: bool = True


@dataclass(frozen=True)
class Auto:
    """Newton where it is enough (square equations), IPOPT where it is not."""

    type: Literal["auto"] = "auto"


@dataclass(frozen=True)
class Ipopt:
    """IPOPT: globalised, bounded, able to minimise.

    Attributes
    ----------
    tolerance
        Tolerance of the nonlinear solver, not of the answer. Example: `1e-10`
    max_iterations
        Most iterations. Example: `500`
    """

    type: Literal["ipopt"] = "ipopt"
    tolerance: SolverTolerance = 1e-12
    max_iterations: Iterations = 200


@dataclass(frozen=True)
class Newton:
    """Newton's method with kept factors.

    Attributes
    ----------
    tolerance
        Size of the last step, relative to the size of the unknowns. Example: `1e-12`
    max_iterations
        Most iterations. Example: `100`
    """

    type: Literal["newton"] = "newton"
    tolerance: SolverTolerance = 1e-13
    max_iterations: Iterations = 50
