"""What is wrong with gravity: there is nothing that it pulls at, or it pulls too hard."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ribbonopt.scene import limits
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.model import Scene
from ribbonopt.scene.units import units_of
from ribbonopt.scene.wording import given, written


def check_gravity(scene: Scene, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    """Yield what is wrong; `values` are those of the formulas, by path."""
    path, ribbon = ("gravity",), scene.ribbon
    if ribbon is None:
        message = (
            "needs to know the ribbon, in metres and pascals: add `ribbon` with its density; in "
            'units Dw = L = 1 write the weight per length, for example "loads: {force: {z: -5}}"'
        )
        yield Problem(path, message, written(scene.gravity))
    elif ribbon.density is None:
        message = (
            "needs the density of the ribbon, in kg/m^3; write for example "
            '"density: 1390" under ribbon (polyester)'
        )
        yield Problem(path, message, written(scene.gravity))
    else:
        yield from _weight(scene, ribbon.density * ribbon.width * ribbon.thickness, values)


def _weight(scene: Scene, mass: float, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    units = units_of(scene)
    for i, (axis, value) in enumerate(given(scene.gravity).items()):
        at: KeyPath = ("gravity", i if isinstance(scene.gravity, tuple) else axis)
        number = values.get(at) if isinstance(value, str) else float(value)
        if number is None:
            continue
        weight = abs(number) * mass / (units.force / units.length)
        if weight > limits.FORCE_PER_LENGTH:
            message = (
                f"is a weight of {weight:.3g} D w / L^3, expected at most "
                f"{limits.FORCE_PER_LENGTH:g}; look at ribbon, whose sizes and density set it"
            )
            yield Problem(at, message, f"{number:g}")
