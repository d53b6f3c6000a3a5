"""Equations of a scene (`also:`) as conditions: formulas evaluated on CasADi expressions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import casadi as ca

from ribbonopt.scene.expressions import Number, Quantity, evaluate, parts
from ribbonopt.scene.formulas import parse_equation

from .conditions import Context, EndName, Equation


def equation(index: int, text: str, parameters: dict[str, float]) -> Equation:
    """Return the condition of one entry of `also:`; raises FormulaError if it does not parse."""
    formula = parse_equation(text, parameters)

    def difference(context: Context, name: str) -> ca.SX:
        env = _SymbolicEnv(context, name)
        return ca.SX(evaluate(formula.left, env) - evaluate(formula.right, env))

    nodes = [*parts(formula.left), *parts(formula.right)]
    numbers = tuple((n.key, n.value) for n in nodes if isinstance(n, Number) and n.key is not None)
    quantities = {n.name for n in nodes if isinstance(n, Quantity)}
    of_loads = not quantities <= {"r", "d1", "d2", "d3"}
    return Equation(index, formula.text, of_loads, numbers, difference)


class _SymbolicEnv:
    """Evaluates a formula on CasADi expressions of both ends."""

    def __init__(self, context: Context, prefix: str) -> None:
        self._context, self._prefix = context, prefix

    def number(self, value: float, key: str | None) -> ca.SX:
        return ca.SX(value) if key is None else self._context.theta(f"{self._prefix}.{key}")

    def name(self, name: str) -> ca.SX:
        return self._context.theta(f"parameters.{name}")

    def quantity(self, name: str, end: EndName) -> ca.SX:
        section = self._context.ends[end]
        value: ca.SX
        if name in ("u2", "u3"):
            value = getattr(section, name)
        elif name[0] in "nm" and name[1:]:
            value = section.rod.along(getattr(section.rod, name[0]))[int(name[1]) - 1]
        else:
            value = getattr(section.rod, name)
        return value

    def vector(self, components: Sequence[ca.SX]) -> ca.SX:
        return ca.vertcat(*components)

    def component(self, vector: ca.SX, axis: Literal["x", "y", "z"]) -> ca.SX:
        value: ca.SX = vector["xyz".index(axis)]
        return value

    def call(self, function: str, arguments: Sequence[ca.SX]) -> ca.SX:
        name = {"abs": "fabs", "norm": "norm_2"}.get(function, function)
        value: ca.SX = getattr(ca, name)(*arguments)
        return value
