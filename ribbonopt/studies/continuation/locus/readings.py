"""What tells the special points of a locus apart, read at its points in one chart.

Of the chart (s, t) come the tangents K1, K2 of the surface with their parts P1, P2 in the plane of
the parameters, in units of their spans. On a locus of folds P1 and P2 are parallel, of a direction
e: the curve in the plane has that direction, at cusps too. Its speed there,

    e . (P1 g_t - P2 g_s),    g = P1 x P2, the area that vanishes all along the locus,

changes sign at a cusp; e_l2 where the curve turns in l2; the determinant where another surface of
equilibria crosses, which is a double point. On a locus of branch points l2 itself may turn; the
area vanishes at a double point where the branch folds too, and the slope of the determinant across
the locus where two of these loci cross.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory

from ..walk.beside import Probe
from ..walk.points import BRANCH_POINT, FOLD, Point
from .chart import Chart

if TYPE_CHECKING:
    from .equations import LocusEquations

STEP = 1e-4  # half the arclength that derivatives of test functions are taken over
NONE = 1e-6  # area, over the side along the locus, that is none: it may vanish all along
ASIDE = 6e-3  # the same across a locus of branch points, on which the chart is singular


@dataclass(frozen=True, eq=False)
class Reading:
    """Test functions at one point of a locus, by what changes its sign; `way` is e."""

    way: Array
    values: dict[str, float]


SPEED, TURN, DETERMINANT, AREA, SLOPE = "speed", "turn", "determinant", "area", "slope"


class Readings:
    """Readings in the chart of one point of a locus, along its tangent and across."""

    def __init__(self, equations: LocusEquations, origin: Point[Solution]) -> None:
        """Lay the chart."""
        self.equations, self.laid = equations, equations.laid(origin.solution)
        self.spans = np.array(equations.surface.spans)
        parts = origin.tangent, self.laid.across
        self.sides = tuple(equations.reduced(origin.solution, part) for part in parts)
        self.chart: Chart = equations.chart(origin.solution, origin.unknowns, *self.sides)
        self.determinants = replace(self.chart, kind=BRANCH_POINT, _scale=[])
        self.way: Array | None = None
        self.scale: float | None = None
        self.known: dict[Trajectory, Reading] = {}

    def signs(self, point: Point[Solution]) -> Reading:
        """Return what has the same signs at a point, from what is known of it already."""
        laid = self.equations.laid(point.solution)
        along, across = self._facing(point.solution, point.tangent, laid.across)
        p1, p2 = along[-2:] / self.spans, across[-2:] / self.spans
        if self.equations.kind != FOLD:
            return self.at(point.solution, point.unknowns)
        left, _, _ = np.linalg.svd(np.stack([p1, p2], axis=1))
        e = self._oriented(left[:, 0])
        determinant = self.determinants.read(point.unknowns).test
        return Reading(e, {SPEED: float(e @ p1), TURN: float(e[1]), DETERMINANT: determinant})

    def at(self, solution: Solution, unknowns: Array) -> Reading:
        """Return the readings at a point of the locus (n + 2,); LinAlgError where singular."""
        key = solution.trajectory
        if key not in self.known:
            fold = self.equations.kind == FOLD
            read = self._of_folds(unknowns) if fold else self._of_crossings(solution, unknowns)
            self.known[key] = read
        return self.known[key]

    def slope(self, probe: Probe[Solution]) -> float:
        """Return the slope of the determinant at a point that was found from this chart's."""
        laid = self.equations.laid(probe.solution)
        if self.scale is None:
            self.scale = laid.scale
        return laid.slope * float(np.exp(laid.scale - self.scale))

    def _of_folds(self, y: Array) -> Reading:
        here = self.chart.read(y)
        first, second = here.first, here.second
        g = [
            (self.chart.read(y + STEP * k).test - self.chart.read(y - STEP * k).test) / (2 * STEP)
            for k in (first, second)
        ]
        p1, p2 = first[-2:] / self.spans, second[-2:] / self.spans
        left, _, _ = np.linalg.svd(np.stack([p1, p2], axis=1))
        e = self._oriented(left[:, 0])
        values = {
            SPEED: float(e @ (p1 * g[1] - p2 * g[0])),
            TURN: float(e[1]),
            DETERMINANT: self.determinants.read(y).test,
        }
        return Reading(e, values)

    def _of_crossings(self, solution: Solution, y: Array) -> Reading:
        laid = self.equations.laid(solution)
        along, across = self._facing(solution, laid.tangent, laid.across)
        ahead, behind = (self.determinants.read(y + s * ASIDE * across).test for s in (1, -1))
        p1, p2 = along[-2:] / self.spans, across[-2:] / self.spans
        e = p1 / np.linalg.norm(p1)
        # Across goes a unit of arclength: what of it is in the plane may be rounding alone.
        size = float(np.linalg.norm(p1))
        area = float(p1[0] * p2[1] - p1[1] * p2[0])
        values = {
            TURN: float(p1[1]),
            AREA: area if abs(area) > NONE * size else 0.0,
            SLOPE: (ahead - behind) / (2 * ASIDE),
        }
        return Reading(e, values)

    def _facing(self, solution: Solution, *parts: Array) -> list[Array]:
        """Return tangent and across (n + 2,) of a point with the signs that they have here."""
        reduced, metric = self.equations.reduced, self.equations.metric
        return [
            part if metric.product(reduced(solution, part), side) >= 0 else -part
            for part, side in zip(parts, self.sides, strict=True)
        ]

    def _oriented(self, way: Array) -> Array:
        """Return e with the sign that it has at the first point that was read."""
        if self.way is None:
            self.way = way
        return way if way @ self.way >= 0 else -way
