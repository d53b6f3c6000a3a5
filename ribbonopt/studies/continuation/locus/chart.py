"""A chart of the surface of equilibria about one of its points: two rows tell its points apart.

    F(w, l1, l2) = 0,    along . (y - y0) = s,    across . (y - y0) = t

is regular at folds of either parameter, and at cusps. Of the bordered matrix come both tangents
K1, K2 = dy/ds, dy/dt and the determinant. The tangent plane's area in the plane of the parameters,

    K1_l1 K2_l2 - K1_l2 K2_l1,

vanishes at folds, whichever parameter moves; the determinant vanishes at branch points.
"""

from __future__ import annotations

from dataclasses import field
from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solvers.extended import ExtendedSystem, Line
from ribbonopt.solvers.local import Local, local, local_near
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.transcription import NLP

from ..walk.points import FOLD

MOST = 12  # iterations of Newton's method for one point of the surface
ENOUGH = 1e-11  # last relative step of it: rounding may leave no smaller ones


@dataclass(frozen=True, eq=False)
class Row:
    """The condition that a row of y has a value."""

    line: Line
    entries: Array
    wanted: float

    def value(self, extended: Array) -> float:
        """Return how far it is off."""
        return float(self.entries @ self.line.reduced(extended)) - self.wanted

    def row(self, extended: Array) -> Array:
        """Return its derivatives by y."""
        return self.entries


@dataclass(frozen=True, eq=False)
class Sample:
    """The surface at one place.

    Attributes
    ----------
    t : float
        Its place across.
    y : (n + 2,) array
        Unknowns there.
    first, second : (n + 2,) arrays
        Tangents K1, K2.
    test : float
        The test function.
    """

    t: float
    y: Array
    first: Array
    second: Array
    test: float


@dataclass(frozen=True, eq=False)
class Chart:
    """One chart.

    Attributes
    ----------
    nlp, line : NLP, Line
        The layout, and its equations by both positions.
    kind : str
        Of the special points whose test function is read: FOLD, or what the determinant tells.
    spans : pair of floats
        Changes of l1 and l2 that count as one.
    origin : (n + 2,) array
        Where s = t = 0; it need not be a point of the surface.
    along, across : (ny,) arrays
        The rows.
    """

    nlp: NLP
    line: Line
    kind: str
    spans: tuple[float, float]
    origin: Array
    along: Array
    across: Array
    _scale: list[float] = field(default_factory=list)

    @cached_property
    def _start(self) -> tuple[float, float]:
        y = self.line.reduced(self.origin)
        return float(self.along @ y), float(self.across @ y)

    def place(self, unknowns: Array) -> tuple[float, float]:
        """Return s and t of unknowns (n + 2,)."""
        y, (s, t) = self.line.reduced(unknowns), self._start
        return float(self.along @ y) - s, float(self.across @ y) - t

    def corrected(self, guess: Array, s: float, t: float) -> Array:
        """Return the unknowns (n + 2,) at a place; LinAlgError if they are not found."""
        own = self._start
        further = (Row(self.line, self.along, own[0] + s),)
        system = ExtendedSystem(self.line, self.across, own[1] + t, further)
        p = self.line.parameters(*guess[-2:])
        report = NewtonSolver(self.nlp).solve(guess, p, None, ENOUGH, system, most=MOST)
        if not report.status.converged:
            raise np.linalg.LinAlgError(report.status.value)
        found: Array = report.w
        return found

    def sample(self, guess: Array, s: float, t: float) -> Sample:
        """Return the surface at a place; LinAlgError if it is not found, or singular there."""
        y = self.corrected(guess, s, t)
        w, positions = self.line.split(y)
        found, _ = local_near(self.line, self.across, w, positions, self._further)
        # Factors were kept until the last step was small enough; these are of this very place.
        return self._sample(found, y + found.step, t)

    def read(self, unknowns: Array, t: float = 0.0) -> Sample:
        """Return tangents and test function of what may be next to the surface."""
        w, positions = self.line.split(unknowns)
        found = local(self.line, self.across, w, positions, self._further)
        return self._sample(found, unknowns, t)

    @property
    def _further(self) -> tuple[Row, ...]:
        return (Row(self.line, self.along, 0.0),)

    def _sample(self, found: Local, unknowns: Array, t: float) -> Sample:
        rows = np.zeros(len(found.residuals.conditions))
        rows[-2] = 1.0
        first, second = found.solve(rows), found.direction
        return Sample(t, unknowns, first, second, self._test(found, first, second))

    @property
    def scale(self) -> float:
        """Logarithm of the determinant that counts as one, of which one was read."""
        return self._scale[0]

    def _test(self, found: Local, first: Array, second: Array) -> float:
        if self.kind == FOLD:
            area = first[-2] * second[-1] - first[-1] * second[-2]
            return float(area) / (self.spans[0] * self.spans[1])
        if not self._scale:
            self._scale.append(found.log)
        return found.sign * float(np.exp(found.log - self._scale[0]))
