"""What Newton's method asks of a system; for the type checker, nothing imports it at run time."""

from __future__ import annotations

from typing import Any, Protocol

from ribbonopt.arrays import Array


class Factors(Protocol):
    """A factored Newton matrix."""

    def solve(self, residuals: Any) -> Array:
        """Return the Newton step (nw,)."""


class Condensed(Factors, Protocol):
    """Factors of a chain of elements."""

    @property
    def determinant(self) -> tuple[float, float]:
        """Sign and logarithm of the determinant, see `ribbonopt.solvers.condense`."""


class System(Protocol):
    """A square system: what it calls residuals and derivatives is its own business."""

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""

    def residuals(self, w: Array, p: Array) -> Any:
        """Return the residuals at w."""

    def linearize(self, w: Array, p: Array) -> tuple[Any, Any]:
        """Return residuals and derivatives at w."""

    def factor(self, derivatives: Any, p: Array) -> Factors:
        """Return the factors of the Jacobian; LinAlgError where it is singular."""

    def vector(self, w: Array, p: Array) -> Array:
        """Return the residuals in the order of the NLP's constraints."""
