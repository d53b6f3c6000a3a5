"""The words of formulas: functions, directions, constants, operators."""

from __future__ import annotations

import ast
import math

from ribbonopt.scene.quantities import AT_ENDS, Shape

#: each function: the number of its arguments, their shape and the shape of its value.
FUNCTIONS: dict[str, tuple[int, Shape, Shape]] = {
    "sqrt": (1, "scalar", "scalar"),
    "sin": (1, "scalar", "scalar"),
    "cos": (1, "scalar", "scalar"),
    "tan": (1, "scalar", "scalar"),
    "exp": (1, "scalar", "scalar"),
    "log": (1, "scalar", "scalar"),
    "abs": (1, "scalar", "scalar"),
    "dot": (2, "vector", "scalar"),
    "cross": (2, "vector", "vector"),
    "norm": (1, "vector", "scalar"),
}
#: directions of the lab
AXES = ("ex", "ey", "ez")
CONSTANTS = {"pi": math.pi, "deg": math.pi / 180}
#: operators, as Python reads them
SIGNS: dict[type[ast.operator], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
}
#: the name of s in formulas along the ribbon, and in them alone
ARCLENGTH = "s"

#: words of the grammar, which no parameter may shadow
RESERVED = frozenset((*FUNCTIONS, *AT_ENDS, *AXES, *CONSTANTS, "start", "end"))
