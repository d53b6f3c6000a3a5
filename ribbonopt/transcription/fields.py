"""Data over arclengths, fractions of the length or in tables, read as known fields of phases.

They need phases of known lengths: a stage that moves with an unknown length wants the derivative
of k by it. A formulation can give that: with the known fields k, dk/ds and the s where they were
read, it writes k + dk/ds (position - s); the fields are read at the lengths of some constants, and
read again at those that were found, which is Newton's method once more.

Jumps belong where phases meet, with a field of each phase on either side; inside an element a jump
costs every scheme its order.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import TranscriptionError
from ribbonopt.problem.contract import BoundaryValueProblem

from .known import Known

Field = Callable[[Array], Array]  # (k,) to (k, nk)


@dataclass(frozen=True, eq=False)
class AlongPhases:
    """A field over positions, where phase i reaches from `ends[i]` to `ends[i + 1]`."""

    field: Field
    ends: Array

    def __call__(self, phase: int, sigma: Array, /) -> Array:
        """Return the fields (k, nk) at the relative positions sigma (k,) of a phase."""
        a, b = self.ends[phase : phase + 2]
        # Neither end is missed by rounding.
        return self.field(np.clip(a + (b - a) * sigma, a, b))


def of_arclength(
    problem: BoundaryValueProblem, theta: Array, field: Field, constants: Array | None = None
) -> Known:
    """Read a field of the arclength s; TranscriptionError where the lengths are unknown.

    Unless `constants` (nc,) say which lengths are meant.
    """
    return AlongPhases(field, _ends(problem, theta, constants))


def of_fraction(problem: BoundaryValueProblem, theta: Array, field: Field) -> Known:
    """Read a field of the fraction of the whole length, from 0 to 1.

    One phase may be of unknown length; TranscriptionError where the lengths of several are.
    """
    if len(problem.phases) == 1:
        return AlongPhases(field, np.array([0.0, 1.0]))
    ends = _ends(problem, theta, None)
    fractions = (ends - ends[0]) / (ends[-1] - ends[0])
    fractions[-1] = 1.0
    return AlongPhases(field, fractions)


def _ends(problem: BoundaryValueProblem, theta: Array, constants: Array | None) -> Array:
    """Arclengths (P + 1,) where phases begin and end."""
    lengths = ca.vertcat(problem.start, *(phase.length for phase in problem.phases))
    if constants is None and ca.depends_on(lengths, problem.constants):
        raise TranscriptionError(
            "a known field of s or of the whole length needs phases of known lengths, found "
            "lengths that contain unknown constants; give the field by relative positions of each "
            "phase, or leave the phases out"
        )
    c = np.zeros(problem.constants.numel()) if constants is None else constants
    return np.cumsum(np.array(problem.extent_function(c, theta)).ravel())


@dataclass(frozen=True, eq=False)
class Table:
    """A field through the rows of a table, by splines of an odd degree (3: twice smooth).

    Attributes
    ----------
    positions : (n,) array
        Where the rows belong, increasing.
    rows : (n, nk) array
        Values.
    """

    positions: Array
    rows: Array
    degree: int = 3

    def __post_init__(self) -> None:
        """Refuse tables through which there is no such spline."""
        count, shape = len(self.positions), self.rows.shape
        if self.rows.ndim != 2 or shape[0] != count or count <= self.degree or self.degree % 2 == 0:
            raise TranscriptionError(
                f"table of a known field: {count} positions and a spline of degree {self.degree}, "
                f"expected rows of shape ({count}, nk), more of them than the degree, and an odd "
                f"degree, found shape {shape}"
            )
        finite = np.isfinite(self.positions).all() and np.isfinite(self.rows).all()
        if not finite or not (np.diff(self.positions) > 0).all():
            raise TranscriptionError(
                "table of a known field: expected finite rows at increasing positions"
            )

    def __call__(self, positions: Array) -> Array:
        """Return the fields (k, nk) at positions (k,) inside the table."""
        first, last = self.positions[0], self.positions[-1]
        off = 1e-9 * (last - first)
        outside = (positions < first - off) | (positions > last + off)
        if outside.any():
            raise TranscriptionError(
                f"table of a known field reaches from {first:.6g} to {last:.6g}, expected to "
                f"cover {positions[outside][0]:.6g}"
            )
        inside = np.clip(positions, first, last)
        return np.asarray(np.array(self._spline(inside[None])).T)

    @cached_property
    def _spline(self) -> ca.Function:
        options = {"degree": [self.degree]}
        return ca.interpolant("table", "bspline", [self.positions], self.rows.ravel(), options)
