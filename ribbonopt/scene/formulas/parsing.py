"""Formulas of a scene, such as "dot(n, d1(start)) = 0": what they say and what they are worth.

They hold numbers, + - * / **, parentheses, pi, deg (pi/180), the lab axes ex, ey, ez, vectors
[a, b, c], `.x .y .z`, sqrt sin cos tan exp log abs dot cross norm, parameters by name, and in
equations the vectors r d1 d2 d3 n m and scalars n1 n2 n3 m1 m2 m3 u1 u2 u3 at
`(start)` or `(end)`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ribbonopt.scene.quantities import Shape

from .expressions import Node, Number, Quantity, evaluate, parts
from .grammar import FormulaError, Parser
from .numeric import NumericEnv
from .words import ARCLENGTH

__all__ = [
    "EquationFormula",
    "FormulaError",
    "evaluate_value",
    "parse_along",
    "parse_equation",
    "parse_expression",
    "parse_value",
]

_NOT_EQUATION = "an equation is 'left = right' with one '='"


class EquationFormula(NamedTuple):
    """Two sides of one shape; a vector equation stands for three scalar equations."""

    left: Node
    right: Node
    text: str
    shape: Shape


def parse_value(text: str, parameters: Iterable[str] = ()) -> Node:
    """Parse the formula of a scalar in numbers and parameters, such as "1 - shortening".

    Parameters
    ----------
    text
        The formula.
    parameters
        Names it may use.

    Raises
    ------
    FormulaError
        If the text is outside the grammar, uses quantities of the ribbon, or is a vector.
    """
    names: dict[str, Shape] = {name: "scalar" for name in parameters}
    node = Parser(text, names, quantities=False).parse(text, 0)
    if node.shape == "vector":
        raise FormulaError(text, None, "found a vector, expected a scalar")
    return node


def parse_along(text: str, parameters: Iterable[str] = ()) -> Node:
    """Parse the formula of a number along the ribbon, such as "1 - 0.7*s"; see `parse_value`."""
    return parse_value(text, [*parameters, ARCLENGTH])


def parse_equation(text: str, parameters: Iterable[str] = ()) -> EquationFormula:
    """Parse a condition in quantities at the ends, such as "dot(n, d1(start)) = 0".

    A bare `n` means `n(start)`. Numbers have keys counted from left to right over both sides.

    Raises
    ------
    FormulaError
        If the text is outside the grammar, has not exactly one "=", joins a scalar to a vector or
        prescribes nothing of the ribbon.
    """
    if "==" in text:
        raise FormulaError(text, text.index("=="), f"found '==', expected '='; {_NOT_EQUATION}")
    if text.count("=") != 1:
        found = f"found {text.count('=')} signs '='" if "=" in text else "found no '='"
        raise FormulaError(text, None, f"{found}; {_NOT_EQUATION}")
    names: dict[str, Shape] = {name: "scalar" for name in parameters}
    parser = Parser(text, names, quantities=True)
    middle = text.index("=")
    left = parser.parse(text[:middle], 0)
    right = parser.parse(text[middle + 1 :], middle + 1)
    if left.shape != right.shape:
        message = f"a {left.shape} cannot equal a {right.shape}"
        remedy = "; write the zero vector as [0, 0, 0]" if right == Number(0.0, "c0") else ""
        raise FormulaError(text, middle, message + remedy)
    if not any(isinstance(part, Quantity) for side in (left, right) for part in parts(side)):
        raise FormulaError(text, None, "prescribes nothing; use quantities such as d1(end)")
    return EquationFormula(left, right, text, left.shape)


def parse_expression(text: str, names: Mapping[str, Shape]) -> Node:
    """Parse an expression in plain names, such as "m2 / m3"; its `shape` tells what it is.

    Parameters
    ----------
    text
        The expression.
    names
        The names it may use, each a scalar or a vector.

    Raises
    ------
    FormulaError
        If the text is outside the grammar.
    """
    return Parser(text, names, quantities=False).parse(text, 0)


def evaluate_value(value: float | str, parameters: Mapping[str, float]) -> float:
    """Return a number of a scene, evaluating it if it is a formula.

    Raises
    ------
    FormulaError
        If the formula does not parse or has no finite real value.
    """
    if not isinstance(value, str):
        return float(value)
    node = parse_value(value, parameters)
    try:
        result = evaluate(node, NumericEnv(parameters))
        finite = isinstance(result, float) and math.isfinite(result)
    except (ArithmeticError, ValueError, TypeError):
        # Division by zero, overflow, a root or logarithm outside its range, or complex numbers.
        finite = False
    if not finite:
        raise FormulaError(value, None, "has no finite real value for these parameters")
    return float(result)
