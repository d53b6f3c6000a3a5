"""Numbers along a ribbon: named outputs at an arclength, and what a scene records."""

from __future__ import annotations

from re import Match

import numpy as np

from ribbonopt.accuracy.estimate import SAFETY
from ribbonopt.accuracy.gaps import ROUNDING
from ribbonopt.accuracy.recorded import error_at
from ribbonopt.arrays import Array
from ribbonopt.scene import Scene
from ribbonopt.scene.faults import suggestion
from ribbonopt.scene.quantities import OUTPUTS
from ribbonopt.scene.stages import parse_record
from ribbonopt.solution.solution import Solution

from .number import Number, UnknownNumberError

AXES = "xyz"
END = "end"  # of the interval, as an arclength


def along(found: Match[str], scene: Scene) -> Number:
    """Return a named output at an arclength: a scalar, or a component of a vector."""
    name, place, axis = found["name"], found["place"].strip(), found["axis"]
    if name not in OUTPUTS:
        near = suggestion(name, OUTPUTS)
        raise UnknownNumberError(f"found {name!r}, expected a named output{near}")
    formula = name
    if OUTPUTS[name] == "vector":
        if axis is None or (axis in AXES) == (name == "u"):
            example = f"{name}({place}).{'2' if name == 'u' else 'x'}"
            raise UnknownNumberError(f"found a vector; name its component, such as {example}")
        formula = f"u{axis}" if name == "u" else f"dot({name}, e{axis})"
    elif axis is not None:
        raise UnknownNumberError(f"{name} is a scalar, which has no component {axis!r}")
    text = formula if place == END else f"{formula} at {place}"
    return _formula(text, scene, name if formula != name else None)


def record(found: Match[str], scene: Scene) -> Number:
    """Return what a scene records under a name."""
    name = found["name"]
    if name not in scene.record:
        near = suggestion(name, scene.record)
        raise UnknownNumberError(f"the scene records no {name!r}{near}")
    return _formula(scene.record[name], scene, None)


def _formula(text: str, scene: Scene, vector: str | None) -> Number:
    try:
        formula, s = parse_record(text, scene)
    except ValueError as error:
        raise UnknownNumberError(str(error)) from None

    def bar(solution: Solution) -> float:
        # A component may be nothing to rounding: that of the vector counts.
        least = 0.0 if vector is None else ROUNDING * norm(solution.sample(s, vector))
        return float(np.maximum(error_at(solution, formula, s), SAFETY * least))

    size = None if vector is None else lambda solution: norm(solution.sample(s, vector))
    return Number(lambda solution: float(solution.sample(s, formula)), bar, size)


def norm(vector: Array) -> float:
    """Return the length of a vector (3,)."""
    return float(np.linalg.norm(vector))
