"""The conditions of a problem, evaluated on the nodes where its phases meet.

`parts` are the unknowns as the layout unpacks them, p the parameters as the layout packs them.
"""

from __future__ import annotations

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .functions import ConditionFunctions
from .layout import Layout

Parts = tuple[Array, Array, Array]  # nodes, stages, constants


@dataclass(frozen=True, eq=False)
class Conditions:
    """Conditions b as numbers."""

    layout: Layout
    functions: ConditionFunctions

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        _ = self.functions.buffered_values, self.functions.buffered_dense

    def values(self, parts: Parts, p: Array) -> Array:
        """Conditions (nb,)."""
        values: Array = self.functions.buffered_values(*self._at_points(parts, p))[0]
        return values

    def linearize(self, parts: Parts, p: Array) -> tuple[Array, Array]:
        """Conditions (nb,) and their derivatives (nb, (P + 1) nx + nc)."""
        b, jacobian = self.functions.buffered_dense(*self._at_points(parts, p))
        # CasADi stores columns first.
        return b, jacobian.reshape(-1, self.layout.conditions).T.copy()

    def _at_points(self, parts: Parts, p: Array) -> Parts:
        nodes, _, c = parts
        return nodes.take(self.layout.points, axis=0), c, self.layout.at_points(p)
