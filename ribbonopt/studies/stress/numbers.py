"""Numbers of a scene under stress: what smooths the law, stiffnesses, loads, the unit of length."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

from ribbonopt.scene import End, Kirchhoff, Membrane, PointLoad, Rod, Sano, Scene
from ribbonopt.scene.along import Scaled, Table, scaled
from ribbonopt.scene.formulas.parsing import evaluate_value
from ribbonopt.scene.units import Units, in_special_units

from .trial import Trial, Trials, one_of

T = TypeVar("T", End, PointLoad)

SMOOTHING = ("epsilon", "delta")
ARCLENGTH = re.compile(r"\bs\b")
#: what a formula of `also` may not name, where it is to hold in another unit of length
WITH_UNITS = re.compile(r"\b(r|n|m|u|[nmu][123]|H|energy|eta)\b")


def smoothing(scene: Scene, quick: bool) -> Trials:
    """By how much the law is smoothed, to next to nothing."""
    names = [name for name in SMOOTHING if hasattr(scene.law, name)]
    if not names:
        return f"law {scene.law.type} is not smoothed by a number"
    values = one_of(quick, (1.0, 1e-3, 1e-8, 1e-14), [10.0**-k for k in range(15)])
    return [
        Trial(f"{name} {v:.0e}", replace(scene, law=replace(scene.law, **{name: v})), f"{v:.0e}")
        for name in names
        for v in values
    ]


def stiffnesses(scene: Scene, quick: bool) -> Trials:
    """One stiffness a million times another, and the reverse."""
    law, values = scene.law, one_of(quick, (1e-6, 1e-2, 1e2, 1e6), _decades(6))
    kinds: dict[str, Any] = {}
    if isinstance(law, Kirchhoff | Sano) and law.B2 is not None:
        B2 = law.B2
        kinds["B3/B2"] = lambda v: replace(scene, law=replace(law, B3=v * B2))
    if isinstance(law, Rod):
        B1, B2, B3 = law.B
        kinds["B3/B2"] = lambda v: replace(scene, law=replace(law, B=(B1, B2, v * B2)))
        kinds["B1/B2"] = lambda v: replace(scene, law=replace(law, B=(v * B2, B2, B3)))
    if isinstance(scene.membrane, Membrane):
        given = scene.membrane
        for name in ("bending", "stretching"):
            if getattr(given, name) is not None:
                kinds[f"membrane.{name}"] = lambda v, name=name: replace(
                    scene, membrane=replace(given, **{name: v})
                )
    if not kinds:
        return f"law {law.type} has no stiffnesses of its own"
    return [
        Trial(f"{name} {value:.0e}", made(value), f"{value:.0e}")
        for name, made in kinds.items()
        for value in values
    ]


def loads(scene: Scene, quick: bool) -> Trials:
    """Everything that acts, times a factor; without any at 0."""
    if _times(scene, 2.0) == _times(scene, 1.0):
        return "nothing acts on it but its ends"
    values = one_of(quick, (0.0, 1e-6, 10.0, 1e6), (0.0, *_decades(6)))
    return [Trial(f"times {v:.0e}", _times(scene, v), f"{v:.0e}") for v in values]


def lengths(scene: Scene, quick: bool) -> Trials:
    """Put the scene in another unit of length: the same ribbon."""
    if scene.loads.own or not _without_units(scene):
        return "what it declares itself has units that cannot be changed from outside"
    values = one_of(quick, (1e-9, 1e9), [10.0**k for k in range(-9, 10, 3) if k])
    found = []
    for value in values:
        # Without `ribbon` stiffnesses keep their numbers; with it they grow with the sizes.
        unit = Units(value, value**2 if scene.ribbon else value**-2)
        found.append(
            Trial(f"times {value:.0e}", longer(scene, value), f"{value:.0e}", True, None, unit)
        )
    return found


def longer(scene: Scene, by: float) -> Scene:
    """Return the scene in a unit of length that is 1 / `by` of its own; of another size in SI."""
    ribbon = scene.ribbon
    unit = Units(1 / by, by**-2 if ribbon else by**2)
    weight = _multiplied(scene.gravity, 1 / by if ribbon else by**-3, scene)
    divided = in_special_units(replace(scene, ribbon=None), unit)
    # What `also` says has no unit here.
    other: Scene = _written(replace(divided, gravity=weight, parameters=scene.parameters))
    if ribbon is None:
        return other
    length, width, thickness = (by * v for v in (ribbon.length, ribbon.width, ribbon.thickness))
    ribbon = replace(ribbon, length=length, width=width, thickness=thickness)
    return replace(other, ribbon=ribbon, membrane=scene.membrane)


def _written(value: Any) -> Any:
    """Return a scene, or a part of one, in which numbers along the ribbon are as a user has them.

    Not in other units, which only Python can say.
    """
    if isinstance(value, Scaled):
        given, unit, length = value.value, value.unit, value.length
        if isinstance(given, str):
            return f"({ARCLENGTH.sub(f'(s*{length!r})', given)})/{unit!r}"
        return Table(tuple(s / length for s in given.s), tuple(v / unit for v in given.values))
    if isinstance(value, tuple):
        return tuple(map(_written, value))
    if not is_dataclass(value) or isinstance(value, type):
        return value
    parts = {f.name: getattr(value, f.name) for f in fields(value)}
    changed = {name: new for name, old in parts.items() if (new := _written(old)) is not old}
    return replace(value, **changed) if changed else value


def _without_units(scene: Scene) -> bool:
    return not any(WITH_UNITS.search(text) for text in scene.boundary.also)


def _decades(most: int) -> list[float]:
    return [10.0**k for k in range(-most, most + 1, 2) if k]


def _times(scene: Scene, factor: float) -> Scene:
    """Return a scene with everything that acts on it times a factor."""
    along, boundary = scene.loads, scene.boundary
    force, couple, pressure = (
        _along(v, factor) for v in (along.force, along.couple, along.pressure)
    )
    points = tuple(_acting(point, factor, scene) for point in along.points)
    start, end = (_acting(end, factor, scene) for end in (boundary.start, boundary.end))
    changed = replace(
        scene,
        boundary=replace(boundary, start=start, end=end),
        loads=replace(along, points=points, force=force, couple=couple, pressure=pressure),
        gravity=_multiplied(scene.gravity, factor, scene),
    )
    found: Scene = _written(changed)
    return found


def _acting(place: T, factor: float, scene: Scene) -> T:
    """Return an end or a point load with its force and moment times a factor."""
    force, moment = (_multiplied(value, factor, scene) for value in (place.force, place.moment))
    return replace(place, force=force, moment=moment)


def _along(value: Any, factor: float) -> Any:
    """Return numbers along the ribbon times a factor."""
    if value is None:
        return None
    if isinstance(value, tuple):
        return tuple(_along(item, factor) for item in value)
    if is_dataclass(value) and {f.name for f in fields(value)} == {"x", "y", "z"}:
        parts = {f.name: _along(getattr(value, f.name), factor) for f in fields(value)}
        return replace(value, **parts)  # type: ignore[type-var]
    return 0.0 if factor == 0 else scaled(value, 1 / factor, 1.0)


def _multiplied(value: Any, factor: float, scene: Scene) -> Any:
    """Return a value of a scene, or all that it holds, times a factor."""
    if value is None:
        return None
    if isinstance(value, tuple):
        return tuple(_multiplied(item, factor, scene) for item in value)
    if is_dataclass(value):
        held = {f.name: _multiplied(getattr(value, f.name), factor, scene) for f in fields(value)}
        return replace(value, **held)  # type: ignore[type-var]
    number = evaluate_value(value, scene.parameters) if isinstance(value, str) else value
    return factor * float(number)
