"""Where the branches of a stage have been, so that none is followed twice.

Places are kept in the coordinates that any layout has (`Equations.reduced`), which determine a
point. A place belongs to a branch where it is near a piece of it, and the branch through the place
passes the ends of that piece to rounding.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .course import COSINE
from .metric import Metric
from .points import CROSSINGS, KINK, POINT, Point, S
from .protocol import Equations
from .tangents import near, renewed

SAME = 1e-4  # arclength between a place and where a branch passes it, if it does
MET = 1e-4  # arclength between two estimates of one point where branches cross
ASIDE = 0.35  # of a piece between two points: most that a branch is off the straight line
BEYOND = 0.01  # of a piece: most that a place is beyond its ends
REACH = 1.0  # arclength of a last piece, to where branches cross


@dataclass(eq=False)
class Trace:
    """One branch.

    Attributes
    ----------
    branch : int
        Its number.
    origin : (m,) array or None
        Where it leaves another.
    places : list of (m,) arrays
        Its points, in order.
    headings : list of (m,) arrays
        Directions of the first point, and of the last.
    """

    branch: int
    origin: Array | None = None
    places: list[Array] = field(default_factory=list)
    headings: list[Array] = field(default_factory=list)


@dataclass(eq=False)
class Atlas(Generic[S]):
    """All branches of one stage, and the points where they cross.

    Distances are measured by the metric of the point that is looked at.
    """

    equations: Equations[S]
    traces: list[Trace] = field(default_factory=list)
    crossings: list[tuple[Point[S], Array]] = field(default_factory=list)

    def begun(self, branch: int, origin: Point[S] | None) -> Trace:
        """Return the trace of a branch that begins."""
        trace = Trace(branch, None if origin is None else self.place(origin))
        self.traces.append(trace)
        return trace

    def note(self, trace: Trace, point: Point[S]) -> None:
        """Keep a point of a branch."""
        if point.kind in CROSSINGS:
            self.crossings.append((point, self.place(point)))
        elif point.kind == POINT:
            heading = self.equations.reduced(point.solution, point.tangent)
            trace.headings = [*trace.headings[:1], heading]
            trace.places.append(self.place(point))

    def place(self, point: Point[S]) -> Array:
        """Coordinates (m,) of a point."""
        return self.equations.reduced(point.solution, point.unknowns)

    def metric(self, point: Point[S]) -> Metric:
        """Return the metric at a point."""
        return self.equations.measured(point.solution).metric

    def crossing_at(self, point: Point[S]) -> Point[S] | None:
        """Return the known point where branches cross that one is; None for none."""
        place, metric = self.place(point), self.metric(point)
        return next((c for c, there in self.crossings if metric.length(place - there) < MET), None)

    def known(self, point: Point[S], trace: Trace) -> int | None:
        """Return the number of the branch that a point is on already, apart from its own trace."""
        others = (other for other in self.traces if other is not trace)
        return next((other.branch for other in others if self.leads_to(other, point)), None)

    def leads_to(self, trace: Trace, point: Point[S]) -> bool:
        """Whether a branch has been at a point."""
        place, metric = self.place(point), self.metric(point)
        return any(
            _beside(metric, place, *ends)
            and any(self.passes(point, end) for end in ends if not self._corner(end))
            for ends in self._pieces(trace, metric)
        )

    def _corner(self, place: Array) -> bool:
        """Whether a place is a kink: whatever leaves there passes it, at one angle or another."""
        return any(c.kind == KINK and np.array_equal(place, at) for c, at in self.crossings)

    def passes(self, point: Point[S], place: Array) -> bool:
        """Whether the branch through a point passes a place, which is near."""
        equations = self.equations.measured(point.solution)
        point, metric = renewed(equations, point), equations.metric
        along = equations.reduced(point.solution, point.tangent)
        arc = metric.product(place - self.place(point), along)
        guess = point.unknowns + arc * point.tangent
        try:
            trial = equations.correct_along(point, point.tangent, arc, guess)
            if not trial.converged:
                return False
            _, tangent = near(equations, trial.solution, trial.unknowns, along)
        except np.linalg.LinAlgError:
            return False
        found = equations.reduced(trial.solution, trial.unknowns)
        # Where branches cross, the other one may be found: it goes another way.
        ahead = metric.product(equations.reduced(trial.solution, tangent), along)
        return ahead > COSINE and metric.length(found - place) < SAME

    def _pieces(self, trace: Trace, metric: Metric) -> Iterator[tuple[Array, Array]]:
        """Yield the ends of the pieces of a branch; the last may lead to where branches cross."""
        yield from pairwise([*([] if trace.origin is None else [trace.origin]), *trace.places])
        for _, there in self.crossings if trace.places else ():
            ahead = there - trace.places[-1]
            if metric.length(ahead) < REACH and metric.product(ahead, trace.headings[-1]) > 0:
                yield trace.places[-1], there


def _beside(metric: Metric, place: Array, a: Array, b: Array) -> bool:
    """Whether a place is near the straight piece between two others."""
    piece = b - a
    length = metric.length(piece)
    if length == 0:
        return False
    share = metric.product(place - a, piece) / length**2
    aside = metric.length(place - a - share * piece)
    return -BEYOND < share < 1 + BEYOND and aside < ASIDE * length
