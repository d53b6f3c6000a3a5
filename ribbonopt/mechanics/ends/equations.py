"""Equations of a scene (`also:`) as conditions: formulas evaluated on CasADi expressions.

In a scene that was written in SI the quantities are multiplied by their units, and both sides
divided by that of the equation.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from ribbonopt.mechanics.formulas import SymbolicEnv
from ribbonopt.scene.formulas.expressions import Number, Quantity, evaluate, parts
from ribbonopt.scene.formulas.parsing import parse_equation
from ribbonopt.scene.quantities import dimension
from ribbonopt.scene.units import UNIT_FORCE, UNIT_LENGTH

from .conditions import Context, EndName, Equation
from .dimensions import dimension_of_equation

Unit = Callable[[float, float], ca.SX]


def equation(index: int, text: str, parameters: dict[str, float]) -> Equation:
    """Return the condition of one entry of `also:`; raises FormulaError if it does not parse."""
    formula = parse_equation(text, parameters)
    dimension = dimension_of_equation(formula.left, formula.right)

    def difference(context: Context, name: str) -> ca.SX:
        unit = _unit(context) if UNIT_LENGTH in parameters else None
        env = _env(context, name, unit)
        result = ca.SX(evaluate(formula.left, env) - evaluate(formula.right, env))
        return result if unit is None else result / unit(dimension.length, dimension.force)

    nodes = [*parts(formula.left), *parts(formula.right)]
    numbers = tuple((n.key, n.value) for n in nodes if isinstance(n, Number) and n.key is not None)
    quantities = {n.name for n in nodes if isinstance(n, Quantity)}
    of_loads = not quantities <= {"r", "d1", "d2", "d3"}
    return Equation(index, formula.text, of_loads, numbers, difference)


def _unit(context: Context) -> Unit:
    """Return the unit of a quantity by its exponents of length and force."""
    length, force = (context.theta(f"parameters.{name}") for name in (UNIT_LENGTH, UNIT_FORCE))
    return lambda a, b: length**a * force**b


def _env(context: Context, prefix: str, unit: Unit | None) -> SymbolicEnv:
    """Return what formulas at both ends are made of; `unit` as above, or None for 1."""

    def number(value: float, key: str | None) -> ca.SX:
        return ca.SX(value) if key is None else context.theta(f"{prefix}.{key}")

    def quantity(name: str, end: EndName) -> ca.SX:
        section = context.ends[end]
        value: ca.SX
        if name[0] == "u" and name[1:]:
            value = section.u[int(name[1]) - 1]
        elif name[0] in "nm" and name[1:]:
            value = section.rod.along(getattr(section.rod, name[0]))[int(name[1]) - 1]
        else:
            value = getattr(section.rod, name)
        return value if unit is None else value * unit(*dimension(name))

    return SymbolicEnv(number, lambda name: context.theta(f"parameters.{name}"), quantity)
