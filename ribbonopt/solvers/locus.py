"""A locus: solutions that meet k conditions of which only the values are known, by k positions.

    F(w, p(l1 .. lk)) = 0,    g(w, l1 .. lk) = 0 with g in R^k; the last says which point is meant.

A test function, such as that of a fold, depends on all unknowns, so that its derivatives are no
rows of the condensed system. Block elimination needs none: with the matrix B of the equations,
bordered by a row along the branch of l1 and by the positions l2 .. lk themselves, the step is

    a + T m,    B a = (-F, 0),    B T = (0, I),    g(w + a) + (dg T) m = 0,

and the k derivatives of g along T are differences. At a fold B is regular, as on any branch.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .extended import ExtendedSystem, Line
from .local import local

if TYPE_CHECKING:
    from .protocols import Condensed

STEP = 1e-5  # half the largest change of an unknown that derivatives of conditions are taken over


@dataclass(frozen=True, eq=False)
class Fixed:
    """The condition that a position stays what it is."""

    line: Line
    index: int

    def value(self, extended: Array) -> float:
        """No residual, wherever that is."""
        return 0.0

    def row(self, extended: Array) -> Array:
        """Return its derivatives by y."""
        row = np.zeros(len(self.line.reduced(extended)))
        row[len(row) - self.line.count + self.index] = 1.0
        return row


def fixed(line: Line) -> tuple[Fixed, ...]:
    """Conditions that leave l1 as the only position that moves."""
    return tuple(Fixed(line, i) for i in range(1, line.count))


def fold_test(line: Line, row: Array, extended: Array) -> float:
    """Rate of l1 along its branch, relative to `row . y`, at [w, l1 .. lk]: zero at a fold."""
    w, positions = line.split(extended)
    return float(local(line, row, w, positions, fixed(line)).direction[len(w)])


@dataclass(frozen=True, eq=False)
class At:
    """Residuals or derivatives of the equations, and where they are those."""

    extended: Array
    own: Residuals | Derivatives


@dataclass(frozen=True, eq=False)
class LocusSystem:
    """Equations and conditions of a locus; unknowns [w, l], a system for Newton.

    Attributes
    ----------
    line : Line
        The problem by k positions.
    row : (ny,) array
        A row along the branch of l1, its entries for l2 .. lk zero.
    conditions : function of [w, l]
        Values (k,); the last says which point is meant.
    """

    line: Line
    row: Array
    conditions: Callable[[Array], Array]

    @cached_property
    def branch(self) -> ExtendedSystem:
        """The equations, bordered by the row and the fixed positions."""
        return ExtendedSystem(self.line, self.row, 0.0, fixed(self.line))

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        self.branch.build()

    def residuals(self, w: Array, p: Array) -> At:
        """Residuals at [w, l], those of the border zero; p is not used."""
        return At(w, self._unbordered(self.branch.residuals(w, p)))

    def linearize(self, w: Array, p: Array) -> tuple[At, At]:
        """Residuals and derivatives at [w, l]."""
        residuals, derivatives = self.branch.linearize(w, p)
        return At(w, self._unbordered(residuals)), At(w, derivatives)

    def factor(self, derivatives: At, p: Array) -> LocusFactors:
        """Factors of the Jacobian; LinAlgError where it is singular."""
        assert isinstance(derivatives.own, Derivatives)
        factors = self.branch.factor(derivatives.own, p)
        like = self.branch.residuals(derivatives.extended, p)
        return LocusFactors.at(self, factors, like, derivatives.extended)

    def vector(self, w: Array, p: Array) -> Array:
        """Residuals in the order of the program's constraints, the conditions last."""
        own = self.branch.residuals(w, p).vector()
        return np.concatenate([own[: -self.line.count], self.conditions(w)])

    def _unbordered(self, residuals: Residuals) -> Residuals:
        conditions = residuals.conditions.copy()
        conditions[-self.line.count :] = 0.0
        return replace(residuals, conditions=conditions)


@dataclass(frozen=True, eq=False)
class LocusFactors:
    """Factors of the equations, and the small matrix of the conditions.

    Attributes
    ----------
    system : LocusSystem
        What is factored.
    factors : Condensed
        Of B.
    tangents : (nw + k, k) array
        T: how unknowns answer to the rows of the border.
    small : (k, k) array
        Derivatives of the conditions along T.
    """

    system: LocusSystem
    factors: Condensed
    tangents: Array
    small: Array

    @classmethod
    def at(
        cls, system: LocusSystem, factors: Condensed, like: Residuals, extended: Array
    ) -> LocusFactors:
        """Solve for the tangents and differentiate the conditions; `like` has the sizes."""
        k, count = system.line.count, len(like.conditions)
        none = np.zeros_like(like.stages), np.zeros_like(like.nodes)
        sides = np.eye(count)[count - k :]
        tangents = np.stack([factors.solve(Residuals(*none, -side)) for side in sides], axis=-1)
        columns = []
        for tangent in tangents.T:
            h = STEP / max(1.0, float(np.abs(tangent).max()))
            ahead, behind = (system.conditions(extended + s * h * tangent) for s in (1, -1))
            columns.append((ahead - behind) / (2 * h))
        small = np.stack(columns, axis=-1)
        if not np.isfinite(small).all():
            raise np.linalg.LinAlgError("conditions have no derivatives here")
        return cls(system, factors, tangents, small)

    def solve(self, residuals: At) -> Array:
        """Newton step (nw + k,)."""
        assert isinstance(residuals.own, Residuals)
        a = self.factors.solve(residuals.own)
        off = self.system.conditions(residuals.extended + a)
        return np.asarray(a - self.tangents @ np.linalg.solve(self.small, off))

    @property
    def direction(self) -> Array:
        """Tangent (nw + k,) of the locus; the last condition changes by one along it."""
        return np.asarray(self.tangents @ np.linalg.solve(self.small, np.eye(len(self.small))[-1]))

    def kernel(self) -> Array:
        """Solve for a share of every condition but the last."""
        shares = np.append(np.ones(len(self.small) - 1), 0.0)
        return np.asarray(self.tangents @ np.linalg.solve(self.small, shares))

    @property
    def sign(self) -> float:
        """Sign of the determinant, up to a factor of the layout's."""
        return self.factors.determinant[0] * float(np.linalg.slogdet(self.small)[0])

    @property
    def log(self) -> float:
        """Logarithm of the determinant."""
        return self.factors.determinant[1] + float(np.linalg.slogdet(self.small)[1])
