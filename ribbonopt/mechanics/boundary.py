"""From what a scene says of its ends to the conditions of `ribbonopt.mechanics.conditions`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Any, Literal

import casadi as ca
import numpy as np

from ribbonopt.scene import Boundary, End, Scene
from ribbonopt.scene.expressions import Number, evaluate, parts
from ribbonopt.scene.formulas import Equation as Formula
from ribbonopt.scene.formulas import evaluate_value, parse_equation

from .conditions import Component, Condition, Context, Direction, EndName, Equation, Frame

DIRECTORS = ("d1", "d2", "d3")


def conditions_of(scene: Scene) -> tuple[Condition, ...]:
    """Return all conditions of a scene, in the order of its file, numbers evaluated."""
    boundary, parameters = scene.boundary, scene.parameters
    result: list[Condition] = []
    names: tuple[EndName, EndName] = ("start", "end")
    for name in names:
        result += _at_end(name, getattr(boundary, name), parameters)
    for i, text in enumerate(boundary.also):
        result.append(_equation(i, parse_equation(text, parameters)))
    return tuple(result)


def start_position(boundary: Boundary, parameters: dict[str, float]) -> np.ndarray:
    """Prescribed position of the start (3,), zero where nothing is prescribed (lab frame)."""
    found = components(boundary.start.position, parameters)
    return np.array([found.get(axis, 0.0) for axis in "xyz"])


def start_frame(boundary: Boundary, parameters: dict[str, float]) -> np.ndarray:
    """Frame (3, 3) prescribed at the start, the lab axes if it is not wholly prescribed."""
    frame = _frame(boundary.start, parameters)
    return np.eye(3) if frame is None else frame


def gap_between_ends(scene: Scene) -> float:
    """Distance between the ends in the lab components that are prescribed at both."""
    start, end = (
        components(e.position, scene.parameters) for e in (scene.boundary.start, scene.boundary.end)
    )
    return float(np.linalg.norm([end[a] - start[a] for a in start if a in end]))


def components(vector: Any, parameters: dict[str, float]) -> dict[str, float]:
    """Return the prescribed components of a vector by axis; a triple stands for x, y, z."""
    if vector is None:
        return {}
    if is_dataclass(vector):
        pairs = [(f.name, getattr(vector, f.name)) for f in fields(vector)]
    else:
        pairs = list(zip("xyz", vector, strict=True))
    return {axis: evaluate_value(v, parameters) for axis, v in pairs if v is not None}


def _at_end(name: EndName, end: End, parameters: dict[str, float]) -> list[Condition]:
    result: list[Condition] = [
        Component(name, "position", axis, value)
        for axis, value in components(end.position, parameters).items()
    ]
    frame = _frame(end, parameters)
    if frame is not None:
        result.append(Frame(name, tuple(frame.ravel().tolist())))
    for director in DIRECTORS:
        prescribed = components(getattr(end, director), parameters)
        if len(prescribed) < 3:
            result += [Component(name, director, a, v) for a, v in prescribed.items()]
        elif frame is None:
            x, y, z = (prescribed[axis] for axis in "xyz")
            result.append(Direction(name, director, (x, y, z)))
    for quantity in ("force", "moment"):
        prescribed = components(getattr(end, quantity), parameters)
        result += [Component(name, quantity, axis, v) for axis, v in prescribed.items()]
    return result


def _frame(end: End, parameters: dict[str, float]) -> np.ndarray | None:
    """Frame (3, 3) of an end whose directors are prescribed as a whole, or None."""
    if end.directors == "identity":
        return np.eye(3)
    source = end if end.directors is None else end.directors
    given = {d: components(getattr(source, d), parameters) for d in DIRECTORS}
    whole = {d: np.array(list(v.values())) for d, v in given.items() if len(v) == 3}
    if len(whole) < 2:
        return None
    for i, j, k in (("d1", "d2", "d3"), ("d2", "d3", "d1"), ("d3", "d1", "d2")):
        if k not in whole:
            whole[k] = np.cross(whole[i], whole[j])
    matrix = np.stack([whole[d] for d in DIRECTORS], axis=1)
    # The scene was checked to be orthonormal to 1e-6; the nearest rotation removes the rest.
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)


def _equation(index: int, formula: Formula) -> Equation:
    def difference(context: Context, name: str) -> ca.SX:
        env = _SymbolicEnv(context, name)
        return ca.SX(evaluate(formula.left, env) - evaluate(formula.right, env))

    nodes = [*parts(formula.left), *parts(formula.right)]
    numbers = tuple((n.key, n.value) for n in nodes if isinstance(n, Number) and n.key is not None)
    return Equation(index, formula.text, numbers, difference)


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
