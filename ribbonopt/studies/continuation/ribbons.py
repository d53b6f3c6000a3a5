"""From a prediction back onto the branch: at a given position, or at a given arclength."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempts
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport
from ribbonopt.solvers.extended import ExtendedSystem
from ribbonopt.solvers.newton import Newton

from .curve import Curve
from .points import Metric, Point, reduced, row_of


@dataclass(frozen=True, eq=False)
class Corrector:
    """Newton's method along one curve, on the mesh and in the phases of the point before."""

    prepared: Prepared
    curve: Curve
    metric: Metric

    def at(self, point: Point, unknowns: Array, position: float) -> Attempts:
        """Correct at a position (natural continuation), from predicted unknowns (nw,).

        What is found is not verified yet: `Attempts.check` does that.
        """
        attempts = self.beside(point.solution, position)
        attempts.run_from(unknowns, quick=True, check=False)
        return attempts

    def along(
        self, point: Point, direction: Array, arc: float, guess: Array, enough: float = 0.0
    ) -> tuple[Attempts, float]:
        """Correct where the projection on a direction is `arc` (pseudo-arclength continuation).

        Parameters
        ----------
        point
            Origin of the arclength.
        direction
            Unit vector [dw, dl] in the layout of the point.
        arc
            Arclength along it.
        guess
            Unknowns and position [w, l] to start from.
        enough
            Last relative step of Newton's method that will do.

        Returns
        -------
        Attempts, float
            With the solution found, not verified yet, and its position.
        """
        solution = point.solution
        line = self.curve.line(solution)
        row = row_of(solution, self.metric.dual(reduced(solution, direction)))
        y = np.append(line.at_points(point.unknowns[:-1]), point.position)
        system = ExtendedSystem(line, row, float(row @ y) + arc)
        nlp = self.beside(solution, point.position).nlp
        report = Newton(nlp).solve(guess, line.parameters(guess[-1]), None, enough, system)
        position = float(report.w[-1])
        attempts = self.beside(solution, position)
        attempts.take(_without_last(report), check=False)
        return attempts, position

    def beside(self, solution: Solution, position: float) -> Attempts:
        """Return the means to solve at a position, on the mesh and in the phases of a solution."""
        search = self.prepared.search(self.curve.scene_at(position))
        return search.on_mesh(solution.sheets, solution.mesh, solution.trajectory.ends[1:-1])

    def anew(self, solution: Solution, position: float) -> Solution | None:
        """Solve at a position with all that a single scene may need, from a solution near by."""
        found = self.prepared.solve(self.curve.scene_at(position), guess=solution, fallback=False)
        return found if found.verified else None


def _without_last(report: SolveReport) -> SolveReport:
    """Return the report without the position and its equation."""
    return replace(
        report,
        w=report.w[:-1],
        residuals=report.residuals[:-1],
        multipliers=report.multipliers[:-1],
    )
