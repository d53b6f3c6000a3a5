"""What can be followed: any equations with one unknown more than there are of them.

    F(w, l1 .. lk) = 0,    g2 = ... = gk = 0,    and a row that says which point is meant:

the position, which is the last parameter lk (natural continuation), or the arclength along a
direction (pseudo-arclength continuation, after Keller), regular at folds too. A branch of
equilibria has one parameter, k = 1; the locus of its fold has k = 2 and a test function g2 that
vanishes at folds. The walk sees the vector [w, l1 .. lk] and asks for what is below.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, Protocol

from ribbonopt.arrays import Array

from .departure import Departure
from .linearised import Heading, Linearised
from .metric import Metric
from .points import Point, S, Special


@dataclass(frozen=True, eq=False)
class Trial(Generic[S]):
    """What a correction came to.

    Attributes
    ----------
    solution : S
        As far as it came.
    unknowns : (n + k,) array
        Its unknowns [w, l1 .. lk].
    converged : bool
        Whether it can be a point of the curve.
    message : str
        How it went, in words.
    note : str
        What is to be told of it as a point of the curve, "" for nothing.
    blurred : bool
        Whether what is near on another branch magnifies rounding beyond the accuracy asked for.
    """

    solution: S
    unknowns: Array
    converged: bool
    message: str
    note: str = ""
    blurred: bool = False


@dataclass(frozen=True, eq=False)
class Passage(Generic[S]):
    """Where a step leaves the layout that it was made in, because that is right no further.

    Attributes
    ----------
    begin : Point
        The point that the step began with, in the layout that is left.
    event : Point
        The last point in that layout; a KINK where other branches cross, a FOLD where it turns.
    stretch : pair of Points or None
        The same in the next layout, and the point `after` before it was finished; None where that
        is singular.
    after : Point
        The first point in the next layout, finished.
    located : Point or None
        The event as exact as asked, in a layout of its own; None where the event itself does.
    """

    begin: Point[S]
    event: Point[S]
    stretch: tuple[Point[S], Point[S]] | None
    after: Point[S]
    located: Point[S] | None = None


class Equations(Protocol[S]):
    """The equations of one curve. A layout is what the numbers of a solution's vector stand for."""

    @property
    def metric(self) -> Metric:
        """The arclength; its last size is the change of the position that counts as one."""

    def measured(self, solution: S) -> Equations[S]:
        """Return the same equations with the metric that fits a solution."""

    def reduced(self, solution: S, vector: Array) -> Array:
        """Coordinates (m,) of a vector (n + k,): the same in any layout, the position last."""

    def linearise(self, solution: S, unknowns: Array, ahead: Array) -> Linearised:
        """Linearise with the row `metric.dual(ahead)`; LinAlgError where that is singular.

        `ahead` (m,) are coordinates of any direction along the curve.
        """

    def heading(self, solution: S, unknowns: Array, ahead: Array) -> Heading:
        """Return the same as `linearise` tells of where the curve goes, at what may be a point.

        It need be no better than the solution is exact. LinAlgError as there.
        """

    def correct_at(self, origin: S, guess: Array) -> Trial[S]:
        """Correct at the position of a guess (n + k,) in the layout of a solution.

        What is found need not be verified yet, nor exact: `finish` does that.
        """

    def correct_along(
        self, origin: Point[S], direction: Array, arc: float, guess: Array, enough: float = 0.0
    ) -> Trial[S]:
        """Correct where the projection on a direction is `arc`.

        Parameters
        ----------
        origin
            Origin of the arclength.
        direction
            Unit vector (n + k,) in the layout of the point.
        arc
            Arclength along it.
        guess
            Unknowns (n + k,) to start from.
        enough
            Last relative step of Newton's method that will do.
        """

    def special(self, a: Point[S], b: Point[S]) -> Special[S]:
        """Return what is special between two points of one layout, as test functions tell."""

    def crossings(self, a: Point[S], b: Point[S]) -> list[Point[S]]:
        """Return where other branches cross between two points, if no determinant can tell it."""

    def uncounted(self, a: S, b: S, changes: int) -> str:
        """Say what so many changes of test functions between two points do not explain."""

    def passed(self, point: Point[S], trial: Trial[S], expected: Array) -> Passage[S] | None:
        """Return where the layout must change before a trial; None if it is right up to there.

        `expected` (n + k,) was predicted of it, which tells where the trial has not converged.
        LinAlgError if no other layout leads on.
        """

    def leaving(self, point: Point[S]) -> list[Point[S]]:
        """Return the first points on the branches that leave a KINK, the main branch's first."""

    def departure(self, point: Point[S]) -> Departure[S] | None:
        """How a branch that crosses leaves a point, None where the null direction tells it."""

    def finer(self, origin: S, unknowns: Array) -> tuple[S, Array] | None:
        """Return a solution and its unknowns in a layout twice as fine, not corrected there.

        None where there is none, or none is asked for.
        """

    def enough(self, error: float, position: float) -> bool:
        """Whether the position of a special point is known well enough."""

    def restored(self, origin: S, unknowns: Array) -> S:
        """Return a solution of known unknowns in the layout of another."""

    def verified(self, trial: Trial[S]) -> Trial[S]:
        """Return a trial that converged, after all checks of what is admissible."""

    def finished(self, origin: Point[S], trial: Trial[S]) -> Trial[S]:
        """Bring a trial that converged to the layout and accuracy that a point needs; verify it.

        Where only the verdict is new, the unknowns are the same object.
        """

    def elsewhere(self, origin: Point[S], position: float) -> Trial[S] | None:
        """Solve at a position in another layout, as none of the point's led to it; None for none.

        What comes back is finished.
        """
