"""Points of a curve: a solution, its unknowns, and which way the curve goes on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from ribbonopt.arrays import Array

POINT, FOLD, BRANCH_POINT, BUCKLING = "point", "fold", "branch point", "buckling point"
KINK = "kink"  # branches meet at an angle where the equations change, as phases begin or end
# Where other branches cross; at the last two without a derivative.
CROSSINGS = (BRANCH_POINT, BUCKLING, KINK)
SPECIAL = (FOLD, *CROSSINGS)
# On loci: where the fold's curve in the plane of the parameters has a point; where folds at one l2
# meet, and the branches there are a single point, or cross; where two loci meet; where one turns.
CUSP, ISOLA, CROSSING, DOUBLE, TURN = "cusp", "isola centre", "crossing", "double point", "turn"
OF_LOCI = (CUSP, ISOLA, CROSSING, DOUBLE, TURN)
TURNING = (FOLD, CUSP, ISOLA, CROSSING, TURN)  # the position turns there

S = TypeVar("S")  # what a solution is, is the business of the equations


@dataclass(frozen=True, eq=False)
class Point(Generic[S]):
    """One accepted point.

    Attributes
    ----------
    solution : S
        Verified; what it is, only the equations know.
    unknowns : (n + k,) array
        Unknowns and parameters [w, l1 .. lk], in the layout of the solution.
    tangent : (n + k,) array
        Their derivatives by the arclength, see `Metric`.
    sign : float
        Sign of the bordered determinant, comparable between layouts.
    step : float
        Arclength to try next.
    number, stage, branch : int
        Place in the whole continuation; branch 0 is the first.
    kind : str
        POINT, FOLD, BRANCH_POINT, BUCKLING or KINK.
    row : mapping
        What is recorded, by name.
    note : str
        What is to be told of it: how it is other than the continuation of the point before.
    origin : int or None
        Number of the point where its branch leaves another; None on the first branch.
    error : float or None
        Of the position of a special point, a bound; None where it is not known.
    """

    solution: S
    unknowns: Array
    tangent: Array
    sign: float
    step: float
    number: int = 0
    stage: int = 0
    branch: int = 0
    kind: str = POINT
    row: Mapping[str, Any] = field(default_factory=dict)
    note: str = ""
    origin: int | None = None
    error: float | None = None

    @property
    def position(self) -> float:
        """The last parameter, lk."""
        return float(self.unknowns[-1])

    def __repr__(self) -> str:
        """Say which point it is in one line, without its numbers."""
        moved = self.row.get("parameter")
        where = f"{moved} = {self.row[moved]:.10g}" if moved else f"position {self.position:.10g}"
        place = f"{self.number} of stage {self.stage}, branch {self.branch}"
        return f"<Point {place}: {self.kind}, {where}>"


@dataclass(frozen=True, eq=False)
class Special(Generic[S]):
    """What was found between two points.

    Special points by arclength, what was not resolved, and how many test functions have changed
    their sign: two at a pitchfork that is met from its side.
    """

    points: list[Point[S]]
    unresolved: tuple[str, ...] = ()
    changes: int = 0
