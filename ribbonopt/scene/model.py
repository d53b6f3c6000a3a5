"""The scene: everything a user may say about one ribbon, as frozen data.

Python users build these classes directly, YAML users through `load_scene`; both are validated by
the same schema (`scene.schema.validation`). Units: Dw = L = 1 (section 2 of the paper), or SI where
the scene says what the ribbon is made of (`ribbon`).
"""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from . import limits
from .along import Along
from .continuation import ContinuationStage
from .ends import Boundary, HalfTwists, LabVector, Loop, Triple, Value
from .in_short import in_short
from .laws import Law
from .loads import Loads
from .membrane import AnyMembrane
from .natural import Natural
from .schema.bounds import Bounds
from .stations import InteriorSupport

Numbers3 = tuple[float, float, float]
Intervals = Annotated[int, Bounds(ge=1, most=limits.INTERVALS)]
Iterations = Annotated[int, Bounds(ge=1, most=limits.ITERATIONS)]
SolverTolerance = Annotated[float, Bounds(gt=0, le=1)]


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
class ArcGuess:
    """Guess by a circular arc bent about d2 that turns by an angle (radians) in all."""

    arc: Value


@dataclass(frozen=True)
class Helix:
    """Helix of some turns that rises by a share of its length (0: circles, 1: straight)."""

    turns: Value
    rise: Annotated[float, Bounds(ge=-1, le=1)]


@dataclass(frozen=True)
class HelixGuess:
    """Guess by a helix from the start."""

    helix: Helix


@dataclass(frozen=True)
class Band:
    """Circle whose directors turn about the tangent by half twists; or the `piece` solved of it.

    Without a piece: that of the scene's loop, or the whole.
    """

    half_twists: HalfTwists
    piece: Literal["whole", "half", "fundamental"] | None = None


@dataclass(frozen=True)
class MoebiusGuess:
    """Guess by a twisted circle."""

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


@dataclass(frozen=True)
class Collocation:
    """Collocation: polynomials of a degree on a number of intervals."""

    type: Literal["collocation"] = "collocation"
    scheme: Literal["gauss", "radau", "lobatto"] = "gauss"
    degree: Annotated[int, Bounds(ge=1, le=10)] = 6
    intervals: Intervals = 10


@dataclass(frozen=True)
class Shooting:
    """Multiple shooting: every interval integrated by a number of Runge-Kutta steps.

    `rk4` and `rk8` are explicit, `gauss` is implicit, of the given degree; one interval is single
    shooting.
    """

    type: Literal["shooting"] = "shooting"
    scheme: Literal["rk4", "rk8", "gauss"] = "rk8"
    steps: Annotated[int, Bounds(ge=1, most=limits.STEPS)] = 1
    degree: Annotated[int, Bounds(ge=1, le=10)] = 3
    intervals: Intervals = 20


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
    tolerance: SolverTolerance = 1e-12
    max_iterations: Iterations = 200


@dataclass(frozen=True)
class Newton:
    """Newton's method with kept factors; `tolerance` is relative to the size of the unknowns."""

    type: Literal["newton"] = "newton"
    tolerance: SolverTolerance = 1e-13
    max_iterations: Iterations = 50


@dataclass(frozen=True)
class Reference:
    """Loads at the start (lab frame) known from elsewhere: the truth for `ribbonopt compare`."""

    n0: Numbers3
    m0: Numbers3


@dataclass(frozen=True)
class RibbonSizes:
    """The ribbon in SI units (m, Pa): lengths, forces and moments of the scene are SI too.

    `density` (kg/m^3) is needed where there is `gravity`.
    """

    length: Annotated[float, Bounds(gt=0)]
    width: Annotated[float, Bounds(gt=0)]
    thickness: Annotated[float, Bounds(gt=0)]
    youngs_modulus: Annotated[float, Bounds(gt=0)]
    poisson_ratio: Annotated[float, Bounds(gt=-1, le=0.5)]
    density: Annotated[float, Bounds(gt=0)] | None = None

    def interval(self, loop: Loop | None, start: float = 0.0) -> tuple[float, float]:
        """Return the longest interval from a start: all of the ribbon, or the piece of a loop."""
        return start, start + self.length / (1 if loop is None else loop.pieces)


@dataclass(frozen=True)
class Scene:
    """One ribbon: its law, its interval, its boundary conditions and how to solve it.

    In a file with `ribbon` the interval is by default all of its length, or the piece of a loop.
    `width` is that along s in units of the ribbon's own, to which Dw and `ribbon.width` belong.
    `planar` says that the ribbon stays in the plane across d2 at its start: it is solved there, by
    an angle in the place of a frame, and its stability is judged in space.
    `symmetric` solves half of a strip whose clamps half a turn maps to each other; which director
    is along its axis in the middle, where there are two.
    `labels` are what numbers are called beside the axes of figures, by their columns, with formulas
    between $.
    """

    name: str
    law: Law
    boundary: Boundary
    guess: Guess = "auto"
    starts: Annotated[int, Bounds(ge=1, most=limits.STARTS)] = 1
    seed: Annotated[int, Bounds(ge=0, most=limits.SEED)] = 0
    formulation: Literal["inverted", "algebraic", "differentiated", "energy"] | Algebraic = (
        "inverted"
    )
    states: Literal["auto", "reduced", "planar", "full"] = "reduced"
    interval: tuple[float, float] = (0.0, 1.0)
    parameters: dict[str, float] = field(default_factory=dict)
    transcription: Collocation | Shooting = Collocation()
    tolerance: Annotated[float, Bounds(ge=1e-13, le=0.1)] | None = None
    switching: Literal["auto", "off"] | tuple[float, ...] = "auto"
    solver: Auto | Ipopt | Newton = Auto()
    reference: Reference | None = None
    ribbon: RibbonSizes | None = None
    record: dict[str, str] = field(default_factory=dict)
    continuation: ContinuationStage | tuple[ContinuationStage, ...] | None = None
    loads: Loads = field(default_factory=Loads)
    gravity: Triple | LabVector | None = None
    supports: tuple[InteriorSupport, ...] = ()
    width: Along | None = None
    natural: Natural | None = None
    membrane: AnyMembrane | None = None
    planar: bool = False
    symmetric: bool | Literal["d1", "d2", "-d1", "-d2"] = False
    labels: dict[str, str] = field(default_factory=dict)

    __repr__ = in_short  # `dump_scene` says all of it
