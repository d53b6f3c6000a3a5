"""Loci of folds and branch points as equations to be followed by the walk.

    F(w, l1, l2) = 0,    g(w, l1, l2) = 0,    and a row that says which point is meant.

A point of a locus is the special point on one slice of the surface F = 0 (`slices`). Its tangent is
the direction of the surface in which g does not change, by central differences of g.
"""

from __future__ import annotations

from dataclasses import field, replace
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt, verified
from ribbonopt.classes import dataclass
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

from ..coordinates import reduced, row_of
from ..trials import checked
from ..walk.course import COSINE
from ..walk.metric import Metric
from ..walk.points import Point, Special
from ..walk.protocol import Trial
from .alone import Alone
from .bars import barred
from .chart import Chart
from .laid import Laid
from .slices import LostError, found_on
from .special import special_of
from .surface import Surface
from .tangents import Ahead, laid_of

ELSEWHERE = "the locus does not go on: what was found next to it goes another way"
RECENT = 8  # solutions whose metric is remembered


@dataclass(frozen=True, eq=False)
class LocusEquations(Alone):
    """Equations of the special points of one kind along a surface.

    Attributes
    ----------
    prepared : Prepared
        The structure.
    surface : Surface
        The scenes by both positions, and their equations.
    kind : str
        FOLD or BRANCH_POINT.
    metric : Metric
        Arclength.
    """

    prepared: Prepared
    surface: Surface
    kind: str
    metric: Metric
    _kept: dict[Any, LocusEquations] = field(default_factory=dict)

    def measured(self, solution: Solution) -> LocusEquations:
        """Return the same with the metric that fits a solution."""
        known, key = self._kept, solution.trajectory
        if key not in known:
            if len(known) >= RECENT:
                known.pop(next(iter(known)))
            unknowns = np.append(solution.dense.w, self.positions(solution))
            known[key] = replace(self, metric=self.surface.metric_at(solution, unknowns))
        return known[key]

    def positions(self, solution: Solution) -> Array:
        """Positions (2,) of a solution."""
        return self.surface.positions_of(solution.scene)

    def reduced(self, solution: Solution, vector: Array) -> Array:
        """States at both ends, constants of the rod and positions, of a vector [w, l1, l2]."""
        return reduced(solution, vector, self.surface.count)

    def linearise(self, solution: Solution, unknowns: Array, ahead: Array) -> Ahead:
        """Return where the locus goes."""
        return Ahead(self.laid(solution).tangent)

    heading = linearise

    def laid(self, solution: Solution) -> Laid:
        """Return how the locus lies at a point; LinAlgError where that is not known."""
        known = solution.trajectory.found.get(Laid)
        if not isinstance(known, Laid):
            raise np.linalg.LinAlgError("not a point of the locus")
        return known

    def correct_at(self, origin: Solution, guess: Array) -> Trial[Solution]:
        """Find the special point at an l2."""
        ahead = np.zeros_like(self.metric.sizes)
        ahead[-1] = self.metric.sizes[-1]
        return self.located(origin, ahead, guess, guess, 0.0, exact=True)

    def correct_along(
        self,
        origin: Point[Solution],
        direction: Array,
        arc: float,
        guess: Array,
        enough: float = 0.0,
    ) -> Trial[Solution]:
        """Find the special point where the projection on a direction is `arc`."""
        along = self.reduced(origin.solution, direction)
        return self.located(origin.solution, along, origin.unknowns, guess, arc)

    def located(
        self,
        origin: Solution,
        along: Array,
        start: Array,
        guess: Array,
        arc: float,
        *,
        exact: bool = False,
    ) -> Trial[Solution]:
        """Find the special point on a slice, `along` (m,) of which is `arc` from a start.

        `exact` says that the slice is the l2 of the guess.
        """
        try:
            laid = self.laid(origin)
            chart = self.chart(origin, start, along, self.reduced(origin, laid.across))
            found = found_on(chart, arc, guess, laid.across)
            if exact:
                found.y[-1] = guess[-1]  # to the last digit
            solution = self.restored(origin, found.y)
            solution.trajectory.found[Laid] = laid_of(self.surface, solution, chart, found)
        except (LostError, np.linalg.LinAlgError) as failure:
            return Trial(origin, guess, False, str(failure))
        return Trial(solution, found.y, True, Status.CONVERGED.value)

    def chart(self, solution: Solution, origin: Array, along: Array, across: Array) -> Chart:
        """Return the chart of rows that are dual to directions (m,), in a solution's layout."""
        row, other = (
            row_of(solution, self.metric.dual(part), self.surface.count) for part in (along, across)
        )
        nlp = self._beside(solution, origin[-2:]).nlp
        line = self.surface.line(solution)
        return Chart(nlp, line, self.kind, self.surface.spans, origin, row, other)

    def special(self, a: Point[Solution], b: Point[Solution]) -> Special[Solution]:
        """Return what is special between two points of one layout."""
        return special_of(self, a, b)

    def restored(self, origin: Solution, unknowns: Array) -> Solution:
        """Return a solution of known unknowns on the mesh and in the phases of another."""
        return self._beside(origin, unknowns[-2:]).restored(unknowns[:-2])

    def verified(self, trial: Trial[Solution]) -> Trial[Solution]:
        """Return a trial that converged, after the checks of a solution."""
        return checked(trial, verified(trial.solution, self.prepared.ribbon))

    def finished(self, origin: Point[Solution], trial: Trial[Solution]) -> Trial[Solution]:
        """Return a point on a mesh on which the error of l1 is as small as asked; verified."""
        if not self._goes_on(origin, trial):
            return replace(trial, converged=False, message=ELSEWHERE)
        try:
            trial = barred(self, trial)
        except (LostError, np.linalg.LinAlgError) as failure:
            return replace(trial, converged=False, message=str(failure))
        return self.verified(trial)

    def _goes_on(self, origin: Point[Solution], trial: Trial[Solution]) -> bool:
        """Whether a point lies where the locus goes from another, and goes the same way there."""
        here = self.reduced(origin.solution, origin.tangent)
        there = self.reduced(trial.solution, self.laid(trial.solution).tangent)
        gap = self.reduced(trial.solution, trial.unknowns)
        gap = gap - self.reduced(origin.solution, origin.unknowns)
        return all(
            abs(self.metric.product(here, part))
            >= COSINE * self.metric.length(here) * self.metric.length(part)
            for part in (there, gap)
        )

    def _beside(self, solution: Solution, positions: Array) -> Attempt:
        """Return the means to solve at two positions, on the mesh and in phases of a solution."""
        search = self.prepared.search(self.surface.posed_at(*map(float, positions)))
        return search.on_mesh(solution.sheets, solution.mesh, solution.trajectory.ends[1:-1])
