"""Numbers along the ribbon as CasADi expressions of the arclength s, for laws and loads.

A plain number is a parameter theta of the problem, and so are the parameters in a formula: another
value needs no new equations. The text of a formula and the rows of a table are structure.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from functools import cached_property
from math import factorial
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.scene.along import Along, Scaled, Table
from ribbonopt.scene.formulas.expressions import (
    Binary,
    Name,
    Node,
    Number,
    Unary,
    evaluate,
    parts,
)
from ribbonopt.scene.formulas.parsing import parse_along
from ribbonopt.scene.formulas.words import ARCLENGTH, RESERVED

from .formulas import SymbolicEnv

if TYPE_CHECKING:
    from ribbonopt.scene.cubics import Cubics

Theta = Callable[[str], ca.SX]

HIGHEST = 12  # degree of a polynomial that is integrated term by term
_WORD = re.compile(r"(?<![\w.])[A-Za-z_]\w*")


@dataclass(frozen=True, eq=False)
class Field:
    """A number along the ribbon.

    Attributes
    ----------
    name : str
        Its path in the scene, by which theta knows it, such as "loads.force.z".
    value : float, str, Table or Scaled
        What stands there, in a scene in units Dw = L = 1.
    """

    name: str
    value: Along

    def numbers(self) -> dict[str, float]:
        """Numbers of this field by parameter name; the scene's own parameters not among them."""
        if isinstance(self.value, Scaled):
            return {f"{self.name}.unit": self.value.unit, f"{self.name}.length": self.value.length}
        return {} if self._varied else {self.name: float(self.value)}  # type: ignore[arg-type]

    @property
    def structure(self) -> tuple[object, ...]:
        """What equations depend on beside theta: the text of a formula, the rows of a table."""
        return self.name, self._varied

    @cached_property
    def uniform(self) -> bool:
        """Whether it is the same all along the ribbon."""
        if isinstance(self._varied, Table):
            return False
        return self._tree is None or not _of_arclength(self._tree)

    def at(self, s: ca.SX, theta: Theta) -> ca.SX:
        """Return the value at an arclength."""
        unit, s = self._units(s, theta)
        if isinstance(self._varied, Table):
            return _picked(self._cubics.knots, self._cubics.coefficients, s) / unit
        return theta(self.name) if self._tree is None else self._formula(s, theta) / unit

    def total(self, s: ca.SX, theta: Theta) -> ca.SX | None:
        """Return the integral from the start of the ribbon; None where it has no closed form.

        There is one of what is uniform, of polynomials in s and of tables.
        """
        start = theta("interval.start")
        if isinstance(self._varied, Table):
            knots, totals = self._cubics.knots, self._cubics.totals
            (unit, end), (_, begin) = self._units(s, theta), self._units(start, theta)
            length = theta(f"{self.name}.length") if isinstance(self.value, Scaled) else 1
            total = _picked(knots, totals, end) - _picked(knots, totals, begin)
            return total / (unit * length)
        if self.uniform:
            return self.at(s, theta) * (s - start)
        degree = 0 if self._tree is None else _degree(self._tree)
        if degree is None or degree > HIGHEST:
            return None
        # Taylor's series from the start, which is the polynomial itself.
        place, total = ca.SX.sym("s"), ca.SX(0)
        value = self.at(place, theta)
        for k in range(degree + 1):
            rate = ca.substitute(value, place, start)
            total += rate * (s - start) ** (k + 1) / factorial(k + 1)
            value = ca.jacobian(value, place)
        return total

    def sampled(self, s: Array, theta: Mapping[str, float]) -> Array:
        """Return the values (k,) at arclengths (k,), for numbers theta by name."""
        names, function = self._function
        found = function(s[None, :], np.array([theta[name] for name in names]).reshape(-1, 1))
        return np.asarray(ca.DM(found), dtype=float).ravel()

    @cached_property
    def _function(self) -> tuple[tuple[str, ...], ca.Function]:
        """Names of the numbers it depends on, and function (s, numbers) of the value."""
        symbols: dict[str, ca.SX] = {}
        s = ca.SX.sym("s")
        value = self.at(s, lambda name: symbols.setdefault(name, ca.SX.sym(name)))
        inputs = [s, ca.vertcat(ca.SX(0, 1), *symbols.values())]
        return tuple(symbols), ca.Function("along", inputs, [ca.densify(value)])

    @property
    def _varied(self) -> str | Table | None:
        """The formula or table, None for a plain number."""
        value = self.value.value if isinstance(self.value, Scaled) else self.value
        return value if isinstance(value, str | Table) else None

    @cached_property
    def _tree(self) -> Node | None:
        text = self._varied
        if not isinstance(text, str):
            return None
        # The scene was checked: what is no word of formulas is one of its parameters.
        return parse_along(text, [word for word in _WORD.findall(text) if word not in RESERVED])

    @cached_property
    def _cubics(self) -> Cubics:
        from ribbonopt.scene.cubics import Cubics

        assert isinstance(self._varied, Table)
        return Cubics.through(self._varied)

    def _formula(self, s: ca.SX, theta: Theta) -> ca.SX:
        def name(word: str) -> ca.SX:
            return s if word == ARCLENGTH else theta(f"parameters.{word}")

        assert self._tree is not None
        return ca.SX(evaluate(self._tree, SymbolicEnv(lambda value, key: ca.SX(value), name)))

    def _units(self, s: ca.SX, theta: Theta) -> tuple[ca.SX | float, ca.SX]:
        """Return what to divide by, and the arclength in the units of the formula or table."""
        if not isinstance(self.value, Scaled):
            return 1.0, s
        return theta(f"{self.name}.unit"), s * theta(f"{self.name}.length")


def _of_arclength(tree: Node) -> bool:
    return any(isinstance(part, Name) and part.name == ARCLENGTH for part in parts(tree))


def _degree(tree: Node) -> int | None:
    """Return the degree in s of a formula that is written as a polynomial; None of another."""
    if not _of_arclength(tree):
        return 0
    match tree:
        case Name():
            return 1
        case Unary():
            return _degree(tree.operand)
        case Binary():
            left, right = _degree(tree.left), _degree(tree.right)
            if left is None or right is None:
                return None
            if tree.sign in "+-":
                return max(left, right)
            if tree.sign == "*":
                return left + right
            if tree.sign == "/":
                return left if right == 0 else None
            power = tree.right.value if isinstance(tree.right, Number) else 0.5
            return left * int(power) if power >= 0 and power == int(power) else None
    return None


def _picked(knots: Array, rows: Array, s: ca.SX) -> ca.SX:
    """Return polynomials in s - (left knot) joined at knots, of coefficients (k, p).

    Coefficients are picked by steps, whose derivatives are zero: those of the whole are exact, at
    the knots as well.
    """
    rows = np.column_stack([knots[:-1], rows])
    steps = ca.vertcat(ca.SX(0, 1), *(s >= knot for knot in knots[1:-1]))
    first, *rest = ca.vertsplit(rows[0] + ca.mtimes(ca.DM(np.diff(rows, axis=0).T), steps))
    x, value = s - first, ca.SX(0)
    for coefficient in reversed(rest):
        value = coefficient + x * value
    return value
