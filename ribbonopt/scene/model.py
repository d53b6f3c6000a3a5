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
from .ends import Boundary, Loop
from .equilibria import Equilibria
from .frames import LabVector, Triple
from .guesses import Guess, Numbers3
from .in_short import in_short
from .inertia import AnyInertia
from .laws import Law
from .loads import Loads
from .maps import MapPlan
from .membrane import AnyMembrane
from .natural import Natural
from .schema.bounds import Bounds
from .solving import Algebraic, Auto, Collocation, Ipopt, Newton, Shooting
from .stations import InteriorSupport


@dataclass(frozen=True)
class Reference:
    """Loads at the start known from elsewhere: the truth for `ribbonopt compare`.

    Attributes
    ----------
    n0
        Force n at the start, lab frame. Example: `[0, 43.4964080169, 42.0522517129]`
    m0
        Moment m at the start, lab frame. Example: `[0, 2.0054509958, -8.8692039616]`
    """

    n0: Numbers3
    m0: Numbers3


@dataclass(frozen=True)
class RibbonSizes:
    """The ribbon in SI units: lengths, forces and moments of the scene are SI too.

    Attributes
    ----------
    length
        Length L of the whole ribbon, in m. Example: `0.3`
    width
        Width w, in m. Example: `0.01`
    thickness
        Thickness h, in m. Example: `1e-4`
    youngs_modulus
        Young's modulus E, in Pa. Example: `4.5e9`
    poisson_ratio
        Poisson's ratio nu. Example: `0.38`
    density
        Mass per volume, in kg/m^3; needed where there is `gravity`. Example: `1400`
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

    Attributes
    ----------
    name
        Name of the scene, and of the folder of its results; any language. Example: `moebius-half`
    law
        Constitutive law: what bending and twist the moments make. A name alone will do where no
        numbers are needed. Example: `{type: sadowsky}` or `wunderlich`
    boundary
        What is held at both ends and what acts there, or that the ribbon is a closed loop.
        Example: `{loop: {half_twists: 1}}`
    guess
        Where the solution is looked for; `auto` finds a start by itself, and takes over where
        another guess leads nowhere. Example: `{moebius: {half_twists: 1}}`
    starts
        How many starts look for different equilibria; that of least energy comes first.
        Example: `8`
    seed
        Seed of the random numbers of further starts. Example: `1`
    formulation
        Form of the equations: `inverted` is the ordinary differential equation (4.5), `algebraic`
        has u2 and u3 as unknowns (3.1), `differentiated` has them as states, `energy` minimises
        the strain energy. Example: `energy`
    states
        What describes a cross section: `reduced` is position and quaternion, `full` the 18 states
        of the paper, `planar` an angle and two coordinates (see `planar`); `auto` is `reduced`.
        Example: `full`
    interval
        Arclengths of the start and of the end; with `ribbon` by default all of its length, or the
        piece of a loop. Example: `[0, 0.5]`
    parameters
        Names for numbers, of which formulas may be made. Example: `{shortening: 0.25}`
    transcription
        How the equations are made discrete.
        Example: `{type: collocation, scheme: gauss, degree: 6, intervals: 10}`
    tolerance
        Relative error of the answer, until which the mesh is refined; without one it stays as it
        is. Example: `1e-9`
    switching
        Where the ribbon is split because m2 changes its sign: `auto` finds out, `off` never splits,
        or the arclengths themselves. Example: `[0.5]`
    solver
        What solves the discrete equations. Example: `{type: newton, max_iterations: 100}`
    reference
        Loads known from elsewhere.
    ribbon
        What ribbon it is; with it all numbers of the scene and of its results are SI.
        Example: `{length: 0.3, width: 0.01, thickness: 1e-4, youngs_modulus: 4.5e9,
        poisson_ratio: 0.38}`
    record
        Further numbers to be told, each a formula at an arclength (by default the end).
        Example: `{deflection: "dot(r, ex) at 0.5"}`
    continuation
        What `ribbonopt continue` follows: one stage, or several in their order.
        Example: `{parameter: law.epsilon, from: 0.1, to: 1e-4, scale: log}`
    loads
        What acts between the ends. Example: `{force: {z: -5}}`
    gravity
        Acceleration of gravity, lab frame, in m/s^2; needs the `density` of a `ribbon`.
        Example: `[0, 0, -9.81]`
    supports
        What holds the ribbon between its ends. Example: `[{at: 0.3, position: {x: 0}}]`
    width
        Width along s in units of the ribbon's own, to which Dw and `ribbon.width` belong.
        Example: `1 - 0.7*s`
    natural
        Curvature and twist of the free ribbon. Example: `{curvature: 2.5}`
    membrane
        How the ribbon gives in its own plane; `ribbon` takes both numbers from its sizes, without
        it neither does. Example: `ribbon`
    planar
        Whether the ribbon stays in the plane across d2 at its start: it is solved there, by an
        angle in the place of a frame, and its stability is judged in space.
    symmetric
        Whether half of a strip is solved whose clamps half a turn maps to each other; or which
        director is along its axis in the middle, where there are two. Example: `d1`
    labels
        What numbers are called beside the axes of figures, by their columns; formulas stand between
        $. Example: `{energy: $E$, middle: height}`
    inertia
        Of sections that turn, for natural frequencies: `ribbon` has that of a strip of the width of
        the `ribbon`, w^2/12 about normal and tangent; without it none. Example: `{d3: 0.01}`
    equilibria
        That `solve` and batches look for all equilibria, unstable ones too, along branches through
        their folds; `continue` and comparisons leave it aside.
        Example: `all` or `{along: [parameters.angle], below: 20}`
    map
        What `ribbonopt map` draws: loci of folds and branch points in the plane of two numbers, and
        how many shapes there are in each region.
        Example: `{parameters: {parameters.angle: [0, 60], parameters.distance: [0.05, 0.4]}}`
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
    inertia: AnyInertia | None = None
    equilibria: Literal["all"] | Equilibria | None = None
    map: MapPlan | None = None

    __repr__ = in_short  # `dump_scene` says all of it
