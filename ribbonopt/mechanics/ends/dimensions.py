"""Dimensions of formulas: what an equation in SI must be divided by to have size 1 inside.

Numbers and parameters have units of their own that nobody wrote down. A sum or an equation has the
dimension of the part that is known without them (`sure`), a product with them that of the rest
(not sure): in `n(end) = stiffness * r(end)` both sides are forces.
"""

from __future__ import annotations

from typing import NamedTuple

from ribbonopt.scene.formulas.expressions import (
    Binary,
    Call,
    Name,
    Node,
    Number,
    Quantity,
    Unary,
    Vector,
    VectorComponent,
    evaluate,
    parts,
)
from ribbonopt.scene.formulas.numeric import NumericEnv
from ribbonopt.scene.quantities import dimension


class Dimension(NamedTuple):
    """Exponents of length and force; whether no unknown factor is in it, and whether any is."""

    length: float = 0.0
    force: float = 0.0
    sure: bool = True
    known: bool = True


UNKNOWN = Dimension(sure=False, known=False)
NONE = Dimension()


def dimension_of_equation(left: Node, right: Node) -> Dimension:
    """Return the dimension of both sides of an equation; none where neither is known."""
    return _best(dimension_of(left), dimension_of(right))


def dimension_of(node: Node) -> Dimension:
    """Return the dimension of a formula."""
    match node:
        case Number() | Name():
            return UNKNOWN
        case Quantity():
            return Dimension(*dimension(node.name))
        case Vector():
            return _best(*(dimension_of(component) for component in node.components))
        case VectorComponent():
            return dimension_of(node.vector)
        case Unary():
            return dimension_of(node.operand)
        case Call():
            return _of_call(node.function, [dimension_of(item) for item in node.arguments])
        case Binary():
            return _of_binary(node)


def _of_call(function: str, arguments: list[Dimension]) -> Dimension:
    if function in ("dot", "cross"):
        return _product(*arguments)
    if function in ("norm", "abs"):
        return arguments[0]
    return _power(arguments[0], 0.5) if function == "sqrt" else NONE


def _of_binary(node: Binary) -> Dimension:
    left = dimension_of(node.left)
    if node.sign == "**":
        free = any(isinstance(part, Name | Quantity) for part in parts(node.right))
        return NONE if free else _power(left, float(evaluate(node.right, NumericEnv({}))))
    right = dimension_of(node.right)
    if node.sign in "+-":
        return _best(left, right)
    return _product(left, _power(right, -1.0) if node.sign == "/" else right)


def _product(left: Dimension, right: Dimension) -> Dimension:
    return Dimension(
        left.length + right.length,
        left.force + right.force,
        left.sure and right.sure,
        left.known or right.known,
    )


def _power(base: Dimension, exponent: float) -> Dimension:
    return base._replace(length=base.length * exponent, force=base.force * exponent)


def _best(*found: Dimension) -> Dimension:
    """Return the first that is sure, or else known."""
    return max(found, key=lambda dimension: (dimension.sure, dimension.known))
