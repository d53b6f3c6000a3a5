"""What a scene of the package says, as plain numbers and functions of s: nothing of it is imported.

Scenes are read by the names of their fields, those that they do not have count as not given; the
scene must be in units Dw = L = 1. Formulas are evaluated here, tables joined by scipy's spline.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from .curved import Along, Material, Natural, value
from .inplane import InPlane
from .loaded import Point, Strip, rotated
from .path import turned
from .plates import extensible, sano
from .rod import Array
from .wide import Wide

WORDS = {name: getattr(np, name) for name in ("sqrt", "sin", "cos", "tan", "exp", "log", "abs")}
WORDS |= {"pi": np.pi, "deg": np.pi / 180}
AXES, DIRECTORS = ("x", "y", "z"), ("d1", "d2", "d3")
NATURAL = ("curvature", "twist", "across")
LAWS = ("sadowsky", "single_sheet", "variational", "kirchhoff", "rod", "extensible", "sano")
LAWS += ("regularized",)
EDGES = {"clamped": "straight", "sliding": "straight"}
EDGES |= {"pinned": "free", "held": "free", "free": "free"}


def number(said: Any, parameters: Mapping[str, float], unknown: float = 0.0) -> float:
    """Return a number, or what a formula of the parameters gives; `unknown` where none is said."""
    if said is None:
        return unknown
    if isinstance(said, str):
        return float(eval(said, {"__builtins__": {}}, WORDS | dict(parameters)))
    return float(said)


def along(said: Any, parameters: Mapping[str, float]) -> Along:
    """Return a number along the ribbon: itself, a formula of s, a table, or one in other units."""
    if said is None:
        return 0.0
    if isinstance(said, str):
        names, code = WORDS | dict(parameters), compile(said, "formula", "eval")
        return lambda s: eval(code, {"__builtins__": {}}, names | {"s": s}) + 0 * s
    if hasattr(said, "unit"):
        inner, unit, length = along(said.value, parameters), said.unit, said.length
        return lambda s: value(inner, s * length) / unit
    if hasattr(said, "values"):
        s, values = np.array(said.s, float), np.array(said.values, float)
        if len(s) == 2:
            return lambda x: np.interp(x, s, values)
        spline = CubicSpline(s, values)
        return lambda x: spline(x)
    return float(said)


def knots(said: Any) -> Array:
    """Arclengths at which a number along the ribbon is not smooth."""
    if hasattr(said, "unit"):
        return knots(said.value) / said.length
    return np.array(said.s, float) if hasattr(said, "values") else np.empty(0)


def parts(said: Any, names: tuple[str, ...] = AXES) -> list[Any]:
    """What is said of components of a vector, None where nothing is."""
    if said is None:
        return [None] * len(names)
    if isinstance(said, tuple | list):
        return [*said, *[None] * (len(names) - len(said))]
    return [getattr(said, name, None) for name in names]


def strip_of(scene: Any) -> Strip | Wide:
    """Return the strip that a scene describes, without reactions; ValueError where none can."""
    theta = scene.parameters
    loads, width = getattr(scene, "loads", None), getattr(scene, "width", None)
    if getattr(loads, "own", ()):
        raise ValueError("loads declared elsewhere are not known here")
    w = 1.0 if width is None else along(width, theta)
    force = [along(v, theta) for v in parts(getattr(loads, "force", None))]
    weight = [number(v, theta) for v in parts(getattr(scene, "gravity", None))]
    if any(weight):
        force = [_sum(f, g, w) for f, g in zip(force, weight, strict=True)]
    couple = [along(v, theta) for v in parts(getattr(loads, "couple", None))]
    acting = (
        tuple(force),
        tuple(couple),
        along(getattr(loads, "pressure", None), theta),
        tuple(p for load in getattr(loads, "points", ()) for p in points_of(load, theta)),
        inplane_of(getattr(scene, "membrane", None), theta),
    )
    if scene.law.type == "wunderlich":
        if width is not None:
            raise ValueError("a wide ribbon of variable width is not known here")
        return Wide(number(scene.law.width, theta), natural_of(scene), *acting)
    return Strip(material_of(scene, w), *acting)


def _sum(force: Along, weight: float, width: Along) -> Along:
    """Force per length and weight, which grows with the width."""
    if weight == 0:
        return force
    return lambda s: value(force, s) + weight * value(width, s)


def material_of(scene: Any, width: Along) -> Material:
    """Return the law with natural strains and width."""
    law, said = scene.law, getattr(scene, "natural", None)
    if law.type not in LAWS:
        raise ValueError(f"law {law.type} is not known here")
    found = {"natural": natural_of(scene), "width": width}
    if law.type == "rod":
        if said is not None and any(getattr(said, name, 0) for name in NATURAL):
            raise ValueError("a rod with natural strains twice is not known here")
        return Material("rod", B=tuple(law.B), strains_of_rod=tuple(law.natural), **found)
    if law.type == "kirchhoff":
        return Material("kirchhoff", B=(np.inf, law.B2, law.B3), **found)
    if law.type == "variational":
        return Material("variational", law.delta, **found)
    if law.type == "regularized":
        return Material("regularized", epsilon=law.epsilon, **found)
    if law.type in ("extensible", "sano"):
        if width != 1.0:
            raise ValueError(f"a {law.type} ribbon of variable width is not known here")
        plate = (
            extensible(law.width, law.thickness, law.poisson_ratio)
            if law.type == "extensible"
            else sano(law.B2, law.B3, law.zeta)
        )
        return Material(law.type, plate=plate, **found)
    return Material("sadowsky", **found)


def natural_of(scene: Any) -> Natural:
    """Return the strains of the free ribbon."""
    said, theta = getattr(scene, "natural", None), scene.parameters
    ratio = number(getattr(said, "poisson_ratio", None), theta)
    return Natural(*(along(getattr(said, name, None), theta) for name in NATURAL), ratio)


def inplane_of(said: Any, theta: Mapping[str, float]) -> InPlane:
    """Return how the ribbon gives in its own plane."""
    names = ("bending", "stretching")
    return InPlane(*(number(getattr(said, name, None), theta, np.inf) for name in names))


def edge_of(end: Any) -> str | None:
    """Whether the edge of a wide ribbon is straight across an end or free; None: not told here.

    At a flip the ribbon goes on as its own image: eta is odd about d2, and even about d1.
    """
    said: str | None = getattr(end, "edge", None)
    if said is None and end.support == "flip":
        return "straight" if end.axis == "d2" else "free"
    if said is None and end.support is None:
        turns = [end.directors, *(getattr(end, d, None) for d in DIRECTORS)]
        if all(v is None for v in turns):
            return "free"
        held = end.position is not None and end.directors is not None
        return "straight" if held and end.force is None and end.moment is None else None
    return EDGES.get(end.support) if said is None and isinstance(end.support, str) else said


def points_of(load: Any, theta: Mapping[str, float]) -> list[Point]:
    """Dead loads at a place, and those along its directors."""
    at, found = number(load.at, theta), []
    for names, follows in ((AXES, False), (DIRECTORS, True)):
        vectors = []
        for said in (getattr(load, "force", None), getattr(load, "moment", None)):
            lab = isinstance(said, tuple | list)
            given = [None] * 3 if lab and follows else parts(said, names)
            vectors.append(tuple(number(v, theta) for v in given))
        if any(any(v) for v in vectors):
            found.append(Point(at, *vectors, follows))
    return found


def frame_of(said: Any, theta: Mapping[str, float]) -> Array | None:
    """Directors (3, 3) in rows of a rotation that a scene gives; NaN where it leaves them out."""
    if said is None:
        return None
    if isinstance(said, str):
        return np.eye(3)
    if hasattr(said, "quaternion"):
        q = np.array([number(v, theta) for v in said.quaternion])
        q = q / np.linalg.norm(q)
        angle = 2 * np.arctan2(np.linalg.norm(q[1:]), q[0])
        return rotated(q[1:] / max(np.linalg.norm(q[1:]), 1e-300) * angle)
    if hasattr(said, "rotation_vector"):
        return rotated([number(v, theta) for v in said.rotation_vector])
    if hasattr(said, "turns"):
        frame = np.eye(3)
        for turn in said.turns:
            for i in range(3):
                for axis, name in ((np.eye(3)[i], AXES[i]), (frame[i], DIRECTORS[i])):
                    angle = number(getattr(turn, name, None), theta)
                    for _ in range(8 if angle else 0):  # Cayley's formula, in eighths
                        by = 2 * np.tan(angle / 16) * axis
                        frame = turned(frame[:, :, None], by[:, None])[:, :, 0]
        return frame
    rows = [[number(v, theta, np.nan) for v in parts(getattr(said, d, None))] for d in DIRECTORS]
    return np.array(rows)


def prescribed(end: Any, theta: Mapping[str, float]) -> dict[str, Array]:
    """What an end holds, (3,) and (3, 3) with NaN for what is free: r, directors, n and m.

    `own n` and `own m` are loads along the directors.

    Of supports `clamped`, `pinned` and `free` all is known, of others what is plain.
    """
    place = np.array([number(v, theta, np.nan) for v in parts(end.position)])
    frame = frame_of(end.directors, theta)
    if frame is None:
        frame = np.full((3, 3), np.nan)
    for i, name in enumerate(DIRECTORS):
        given = [number(v, theta, np.nan) for v in parts(getattr(end, name, None))]
        frame[i] = np.where(np.isnan(given), frame[i], given)
    plain = {"free": ("force", "moment"), "pinned": ("moment",)}.get(end.support, ())
    loads = {}
    for name, of in (("force", "n"), ("moment", "m")):
        said = getattr(end, name, None)
        follows = said is not None and any(getattr(said, d, None) is not None for d in DIRECTORS)
        along = [number(getattr(said, d, None), theta, np.nan) for d in DIRECTORS]
        loads[f"own {of}"], loads[of] = np.array(along), np.full(3, np.nan)
        if name in plain and not follows:
            loads[of] = np.array([number(v, theta) for v in parts(said)])
    if end.support in ("sliding", "flip", "held"):
        place = np.full(3, np.nan)
    return {"r": place, "directors": frame} | loads
