"""The grammar of formulas: text to a tree, node by node against a whitelist.

Python's own parser reads the text, nothing ever runs it; whatever is not on the list is refused
with its column. Scalars and vectors are told apart on the way.
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Mapping
from typing import NoReturn

from ribbonopt.errors import SceneError
from ribbonopt.scene.faults import suggestion
from ribbonopt.scene.limits import LARGEST
from ribbonopt.scene.quantities import AT_ENDS, Shape

from .expressions import (
    Binary,
    Call,
    Name,
    Node,
    Number,
    Quantity,
    Unary,
    Vector,
    VectorComponent,
)
from .words import ARCLENGTH, AXES, CONSTANTS, FUNCTIONS, SIGNS

_LONGEST = 500
_DEEPEST = 50

_FOREIGN = re.compile(r"[^A-Za-z0-9_ \t\n.+*/()\[\],=-]")
_WORD = re.compile(r"[A-Za-z0-9_.]+")
_NUMBER_OR_NAME = re.compile(
    r"(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][0-9]*)?|\.?[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*)\Z"
)
_REMEDIES = {
    "^": "; a power is written **",
    "'": "; names stand without quotes",
    '"': "; names stand without quotes",
}


class FormulaError(SceneError):
    """A formula outside the grammar: quotes it, with the column, what was found and the remedy."""

    def __init__(self, text: str, column: int | None, message: str) -> None:
        place = f", column {column + 1}" if column is not None else ""
        quoted = text if len(text) <= _LONGEST else f"{text[:40]} ..."
        super().__init__(f"formula {quoted!r}{place}: {message}")


class Parser:
    """Turns the text of one formula, or its two sides in turn, into trees; counts its numbers.

    Parameters
    ----------
    text
        The whole formula, quoted in errors.
    names
        Plain names that may be used: parameters, or what can be sampled.
    quantities
        Whether quantities at the ends, such as `d1(start)`, may be used.
    """

    def __init__(self, text: str, names: Mapping[str, Shape], *, quantities: bool) -> None:
        self.text, self.names, self.quantities = text, names, quantities
        self.numbers = 0
        self.offset = 0
        if len(text) > _LONGEST:
            raise FormulaError(text, None, f"is longer than {_LONGEST} characters")
        if foreign := _FOREIGN.search(text):
            sign = foreign[0]
            allowed = "numbers, names, + - * / **, parentheses, [a, b, c]"
            raise FormulaError(
                text,
                foreign.start(),
                f"found {sign!r}; allowed are {allowed}{_REMEDIES.get(sign, '')}",
            )

        for word in _WORD.finditer(text):
            # Python would read 2in as 2 in, with a warning, and 0x1F or 1_0 as numbers.
            if not _NUMBER_OR_NAME.match(word[0]):
                message = f"found {word[0]!r}, which is neither a number nor a name"
                raise FormulaError(text, word.start(), message)

    def parse(self, side: str, offset: int) -> Node:
        """Return the tree of the whole text or of the side that begins at `offset`."""
        source = side.replace("\n", " ").rstrip()
        self.offset = offset + len(source) - len(source.lstrip())
        if not source.strip():
            raise FormulaError(self.text, offset, "found nothing, expected a formula")
        try:
            tree = ast.parse(source.strip(), mode="eval")
        except SyntaxError as error:
            column = self.offset + (error.offset or 1) - 1
            raise FormulaError(self.text, column, f"cannot be read ({error.msg})") from None
        except (ValueError, RecursionError, MemoryError):
            raise FormulaError(self.text, offset, "cannot be read") from None
        return self._node(tree.body, 0, exponent=False)

    def _node(self, node: ast.expr, depth: int, *, exponent: bool) -> Node:
        if depth > _DEEPEST:
            self._refuse(node, f"nests deeper than {_DEEPEST} levels")
        match node:
            case ast.Constant():
                return self._number(node, exponent)
            case ast.Name():
                return self._name(node)
            case ast.List():
                items = [self._node(item, depth + 1, exponent=exponent) for item in node.elts]
                if [item.shape for item in items] != ["scalar"] * 3:
                    self._refuse(node, "a vector is written with three scalars, [a, b, c]")
                return Vector((items[0], items[1], items[2]))
            case ast.Attribute() if (path := self._source(node)) in self.names:
                return Name(path, self.names[path])
            case ast.Attribute(attr="x" | "y" | "z" as axis):
                vector = self._node(node.value, depth + 1, exponent=exponent)
                if vector.shape != "vector":
                    self._refuse(node, f"only a vector has a component .{axis}")
                return VectorComponent(vector, axis)
            case ast.Call(func=ast.Name() as function, keywords=[]):
                return self._call(node, function.id, depth, exponent)
            case ast.UnaryOp(op=ast.UAdd() | ast.USub()):
                operand = self._node(node.operand, depth + 1, exponent=exponent)
                return Unary("-" if isinstance(node.op, ast.USub) else "+", operand, operand.shape)
            case ast.BinOp():
                return self._binary(node, depth, exponent)
        self._refuse(node, f"found {self._source(node)!r}, which no formula may hold")

    def _number(self, node: ast.Constant, exponent: bool) -> Node:
        value = node.value
        if isinstance(value, bool) or not isinstance(value, int | float):
            self._refuse(node, f"found {self._source(node)!r}, expected a number or a name")
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if number > LARGEST:
            self._refuse(node, f"found a number too large, expected at most {LARGEST:g}")
        if exponent:
            return Number(number)
        self.numbers += 1
        return Number(number, f"c{self.numbers - 1}")

    def _name(self, node: ast.Name) -> Node:
        name = node.id
        if name in self.names:
            return Name(name, self.names[name])
        if name in CONSTANTS:
            return Number(CONSTANTS[name])
        if name in AXES:
            x, y, z = (Number(float(axis == name)) for axis in AXES)
            return Vector((x, y, z))
        if name == "n" and self.quantities:
            # The force is constant along an unloaded ribbon.
            return Quantity("n", "start", "vector")
        if name in AT_ENDS and self.quantities:
            self._refuse(node, f"{name!r} needs an end: {name}(start) or {name}(end)")
        if name in AT_ENDS and not self.names.keys() & AT_ENDS:
            along = ", and s along the ribbon" if ARCLENGTH in self.names else ""
            message = f"{name!r} is not known here; a value is numbers and parameters{along}"
            self._refuse(node, message)
        if name in FUNCTIONS:
            self._refuse(node, f"{name!r} is a function; write {name}(...)")
        if name == ARCLENGTH:
            known = "is the arclength, which is known in loads, natural and width only"
            self._refuse(node, f"{name!r} {known}: expected one number here")
        self._unknown(node, "name", name, [*self.names, *AXES, *CONSTANTS])

    def _call(self, node: ast.Call, function: str, depth: int, exponent: bool) -> Node:
        if function in AT_ENDS and self.quantities:
            match node.args:
                case [ast.Name(id="start" | "end" as end)]:
                    return Quantity(function, end, AT_ENDS[function])
            self._refuse(node, f"{function!r} is taken at (start) or (end)")
        if function in (*self.names, *AXES, *CONSTANTS):
            self._refuse(node, f"{function!r} is no function; write it without (...)")
        if function not in FUNCTIONS:
            self._unknown(node, "function", function, list(FUNCTIONS))
        arguments = [self._node(item, depth + 1, exponent=exponent) for item in node.args]
        count, taken, given = FUNCTIONS[function]
        found = [argument.shape for argument in arguments]
        if found != [taken] * count:
            wanted = f"{count} {taken}{'s' if count > 1 else ''}"
            self._refuse(node, f"{function} takes {wanted}; found {', '.join(found) or 'nothing'}")
        return Call(function, tuple(arguments), given)

    def _binary(self, node: ast.BinOp, depth: int, exponent: bool) -> Node:
        if type(node.op) not in SIGNS:
            self._refuse(node, f"found {self._source(node)!r}; the operators are + - * / **")
        sign = SIGNS[type(node.op)]
        left = self._node(node.left, depth + 1, exponent=exponent)
        right = self._node(node.right, depth + 1, exponent=exponent or sign == "**")
        shapes = left.shape, right.shape
        if shapes == ("scalar", "scalar"):
            return Binary(sign, left, right, "scalar")
        one_vector = left.shape != right.shape
        if sign in "+-" and one_vector:
            self._refuse(node, f"found {shapes[0]} {sign} {shapes[1]}; both must be of one kind")
        if sign == "*" and not one_vector:
            self._refuse(node, "found vector * vector; write dot(a, b) or cross(a, b)")
        if sign == "**" or (sign == "/" and right.shape == "vector"):
            self._refuse(
                node, f"found {shapes[0]} {sign} {shapes[1]}; vectors know no such operator"
            )
        return Binary(sign, left, right, "vector")

    def _unknown(self, node: ast.expr, kind: str, word: str, known: list[str]) -> NoReturn:
        ends = list(AT_ENDS) if self.quantities else []
        listed = ", ".join(known) + (f", and {', '.join(ends)} at (start) or (end)" if ends else "")
        near = suggestion(word, [*known, *ends])
        self._refuse(node, f"unknown {kind} {word!r}{near}; known are {listed}")

    def _source(self, node: ast.expr) -> str:
        end = None if node.end_col_offset is None else self.offset + node.end_col_offset
        return self.text[self.offset + node.col_offset : end]

    def _refuse(self, node: ast.expr, message: str) -> NoReturn:
        raise FormulaError(self.text, self.offset + node.col_offset, message)
