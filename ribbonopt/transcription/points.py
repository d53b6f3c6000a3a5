"""The conditions of a problem, evaluated on the nodes where its phases meet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from ribbonopt.arrays import Array

from .buffered import Buffered
from .functions import ConditionFunctions
from .layout import Layout


@dataclass(frozen=True, eq=False)
class Conditions:
    """Conditions b as numbers, from the unknowns w and p = [theta, relative widths]."""

    layout: Layout
    functions: ConditionFunctions

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        _ = self._values, self._dense

    def values(self, w: Array, p: Array) -> Array:
        """Conditions (nb,)."""
        values: Array = self._values(*self._at_points(w, p))[0].copy()
        return values

    def linearize(self, w: Array, p: Array) -> tuple[Array, Array]:
        """Conditions (nb,) and their derivatives (nb, (P + 1) nx + nc)."""
        b, jacobian = self._dense(*self._at_points(w, p))
        # CasADi stores columns first.
        return b.copy(), jacobian.reshape(-1, self.layout.conditions).T.copy()

    def _at_points(self, w: Array, p: Array) -> tuple[Array, Array, Array]:
        nodes, _, c = self.layout.unpack(w)
        return nodes[list(self.layout.point_elements)], c, self.layout.theta(p)

    @cached_property
    def _values(self) -> Buffered:
        return Buffered(self.functions.values)

    @cached_property
    def _dense(self) -> Buffered:
        return Buffered(self.functions.dense)
