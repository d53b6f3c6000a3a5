"""Formulas evaluated on CasADi expressions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal, NoReturn

import casadi as ca

from ribbonopt.classes import dataclass

if TYPE_CHECKING:
    from ribbonopt.scene.formulas.expressions import EndName


def no_quantity(name: str, end: EndName) -> NoReturn:
    """Refuse a quantity of the ribbon where its formula may have none."""
    raise KeyError(f"{name}({end})")


@dataclass(frozen=True, eq=False)
class SymbolicEnv:
    """What the leaves of a formula are, by three functions, and its functions those of CasADi."""

    number: Callable[[float, str | None], ca.SX]
    name: Callable[[str], ca.SX]
    quantity: Callable[[str, EndName], ca.SX] = no_quantity

    def vector(self, components: Sequence[ca.SX]) -> ca.SX:
        """Return a vector (3,)."""
        return ca.vertcat(*components)

    def component(self, vector: ca.SX, axis: Literal["x", "y", "z"]) -> ca.SX:
        """Return one component."""
        value: ca.SX = vector["xyz".index(axis)]
        return value

    def call(self, function: str, arguments: Sequence[ca.SX]) -> ca.SX:
        """Return the value of a function of the grammar."""
        name = {"abs": "fabs", "norm": "norm_2"}.get(function, function)
        value: ca.SX = getattr(ca, name)(*arguments)
        return value
