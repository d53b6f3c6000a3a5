"""Formulas of named outputs evaluated on arrays, such as "m2 / m3" or "dot(d1, ex)"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.scene.formulas.expressions import evaluate
from ribbonopt.scene.formulas.parsing import parse_expression
from ribbonopt.scene.quantities import Shape


def evaluate_formula(text: str, values: Mapping[str, Array]) -> Array:
    """Return the value of a formula: (k,) for scalars, (k, 3) for vectors.

    Parameters
    ----------
    text
        The formula.
    values
        Arrays (k,) or (k, 3) by the names that the formula may use.

    Raises
    ------
    FormulaError
        If it does not parse; a ValueError.
    """
    shapes: dict[str, Shape] = {
        name: "scalar" if value.ndim == 1 else "vector" for name, value in values.items()
    }
    node = parse_expression(text, shapes)
    result = np.asarray(evaluate(node, _ArrayEnv(values)))
    count = len(next(iter(values.values())))
    result = np.broadcast_to(result, (count, result.shape[1]))
    return result[:, 0] if node.shape == "scalar" else result


@dataclass(frozen=True, eq=False)
class _ArrayEnv:
    """Evaluates formulas on arrays: scalars as columns (k, 1), vectors (k, 3)."""

    values: Mapping[str, Array]

    def number(self, value: float, key: str | None) -> Array:
        return np.array([[value]])

    def name(self, name: str) -> Array:
        value = self.values[name]
        return value[:, None] if value.ndim == 1 else value

    def quantity(self, name: str, end: str) -> Array:
        raise KeyError(f"{name}({end})")

    def vector(self, components: Sequence[Array]) -> Array:
        return np.concatenate(np.broadcast_arrays(*components), axis=1)

    def component(self, vector: Array, axis: str) -> Array:
        i = "xyz".index(axis)
        return np.asarray(vector[:, i : i + 1])

    def call(self, function: str, arguments: Sequence[Array]) -> Array:
        if function == "dot":
            return np.asarray(np.sum(arguments[0] * arguments[1], axis=1, keepdims=True))
        if function == "norm":
            return np.asarray(np.linalg.norm(arguments[0], axis=1, keepdims=True))
        return np.asarray(getattr(np, function)(*arguments))
