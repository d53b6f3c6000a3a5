"""What a page shows: ribbons with what is said of them, how they are looked at, and a diagram.

`contents` turns it into plain data; the head of `page/data.js` says what they are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.scene.units import Units
from ribbonopt.text import printable
from ribbonopt.views.camera import Camera, place_camera
from ribbonopt.views.shape import Shape, shape_from
from ribbonopt.views.subject import Subject
from ribbonopt.views.surface import sweep

from .acting import arrows_of, longest
from .motion import Motion, plain_motion
from .packing import packed
from .ranges import ranges_of
from .still import still

SI = {"length": "m", "strain": "1/m", "force": "N", "moment": "N m", "energy": "J/m"}
PLACED = 1000  # points of centre lines from which the view is chosen
ROOM = 1.02  # of the half extents
LEAST = 1e-300


@dataclass(frozen=True, eq=False)
class Ribbon:
    """A ribbon to be seen.

    Attributes
    ----------
    subject : Subject
        Its rows.
    caption, note : str
        What tells it from the others, and what is to be told besides.
    verified : bool
        Whether its numbers are.
    numbers : sequence of pairs of str
        Names of numbers, and numbers as they are read.
    warnings : sequence of str
        Why it may be doubted.
    row : int or None
        Of a branch or a batch, the number of its row.
    """

    subject: Subject
    caption: str
    note: str = ""
    verified: bool = True
    numbers: Sequence[tuple[str, str]] = ()
    warnings: Sequence[str] = ()
    row: int | None = None


@dataclass(frozen=True, eq=False)
class View:
    """What a page shows.

    Attributes
    ----------
    kind : str
        "result", "branch" or "batch".
    name, about : str
        The scene's or the study's, and a line on all of it.
    ribbons : tuple of Ribbon
        In the order in which they are gone through.
    half_width : float or None
        To which all are drawn where their relative width is 1; each to one of its own if None.
    diagram, table : mapping or None
        Plain data of a branch's diagram, and of a batch's scatter and table.
    units : Units
        Of all of it.
    left_out : tuple of str
        What the page does not hold, and why.
    motion : Motion or None
        Small vibrations of one of the ribbons.
    """

    kind: str
    name: str
    about: str
    ribbons: tuple[Ribbon, ...]
    half_width: float | None = None
    diagram: Mapping[str, Any] | None = None
    table: Mapping[str, Any] | None = None
    units: Units = field(default_factory=Units)
    left_out: tuple[str, ...] = ()
    motion: Motion | None = None

    @property
    def shapes(self) -> list[Shape]:
        """The ribbons as they are drawn."""
        found = []
        for subject in (ribbon.subject for ribbon in self.ribbons):
            width = subject.drawn if self.half_width is None else self.half_width
            found.append(shape_from(subject, sweep(subject.pieces, width)))
        return found


def contents(view: View) -> dict[str, Any]:
    """Return what the page reads, as plain data; texts as they are seen."""
    shapes = view.shapes
    centred = view.kind == "batch"  # shapes that do not follow from each other
    camera, frame, centres = _frame(view, shapes, centred)
    told = [_told(*both) for both in zip(view.ribbons, shapes, strict=True)]
    for one, centre in zip(told, centres, strict=True):
        one.update({"centre": centre} if centred else {})
    data = {
        "kind": view.kind,
        "name": view.name,
        "about": view.about,
        "units": {name: unit if view.units.si else "" for name, unit in SI.items()},
        "allowed": all(ribbon.subject.across == 0 for ribbon in view.ribbons),
        "camera": frame,
        "shapes": told,
        "ranges": ranges_of(shapes),
        "packed": packed(shapes) if shapes else "",
        "still": still(shapes[0], camera) if shapes else "",
        "diagram": view.diagram,
        "table": view.table,
        "modes": _motion(view, shapes),
    }
    found: dict[str, Any] = _seen(data)
    return found


def _motion(view: View, shapes: Sequence[Shape]) -> dict[str, Any] | None:
    if view.motion is None:
        return None
    i = view.motion.ribbon
    return plain_motion(view.motion, view.ribbons[i].subject, shapes[i])


def _told(ribbon: Ribbon, shape: Shape) -> dict[str, Any]:
    mirrored = np.flatnonzero(shape.mirrored)
    arrows = longest(ribbon.subject.acting, shape.units.si)
    return {
        "caption": ribbon.caption,
        "note": ribbon.note,
        "verified": ribbon.verified,
        "numbers": [list(pair) for pair in (*ribbon.numbers, *arrows)],
        "warnings": list(ribbon.warnings),
        "row": ribbon.row,
        "count": len(shape.s),
        "solved": int(mirrored[0]) if len(mirrored) else len(shape.s),
        "starts": list(shape.starts),
        "closing": shape.closing,
        "rod": shape.rod,
        "acting": arrows_of(ribbon.subject.acting, shape),
    }


def _frame(
    view: View, shapes: Sequence[Shape], centred: bool
) -> tuple[Camera, dict[str, Any], list[list[float]]]:
    """Return how the view begins, one for all shapes, as plain data too, and the middle of each."""
    lines = [_known(shape.r) for shape in shapes]
    every = max(1, sum(map(len, lines)) // PLACED)
    about = [line - line.mean(axis=0) if centred and len(line) else line for line in lines]
    line = np.concatenate([np.eye(3)[:0], *about])[::every]
    normals = np.concatenate([np.eye(3)[:0], *(_known(shape.d1) for shape in shapes)])[::every]
    ways = np.concatenate(
        [np.eye(3)[:0], *(ribbon.subject.acting.ways for ribbon in view.ribbons[:1])]
    )
    if len(line) < 2:
        line, normals = np.eye(3), np.eye(3)
    camera = place_camera(line, normals, ways)
    axes = np.stack([camera.right, camera.up, camera.towards])
    corners = [_known(np.concatenate([shape.points(-1), shape.points(1)])) for shape in shapes]
    boxes = [_box(part @ axes.T) for part in corners if len(part)] or [np.zeros((2, 3))]
    if not centred:
        boxes = [np.array([np.min(boxes, axis=0)[0], np.max(boxes, axis=0)[1]])]
    middles = [box.mean(axis=0) @ axes for box in boxes]
    extent = np.max([np.ptp(box, axis=0) for box in boxes], axis=0) / 2 * ROOM
    if view.motion is not None:
        extent = extent + view.motion.reach(view.ribbons[view.motion.ribbon].subject, axes)
    depth = max(float(np.linalg.norm(extent)), LEAST)
    frame = {
        "axes": axes.tolist(),
        "centre": middles[0].tolist(),
        "extent": np.maximum(extent[:2], 1e-3 * depth).tolist(),
        "depth": depth,
    }
    places = iter(middles)
    each = [next(places).tolist() if len(part) and centred else [0.0] * 3 for part in corners]
    return camera, frame, each


def _box(points: Array) -> Array:
    return np.array([points.min(axis=0), points.max(axis=0)])


def _known(vectors: Array) -> Array:
    """Return vectors (l, 3) all of whose components are numbers."""
    return np.asarray(vectors[np.isfinite(vectors).all(axis=1)])


def _seen(value: Any) -> Any:
    """Return plain data whose texts never act, and whose numbers JSON can say."""
    if isinstance(value, str):
        return printable(value)
    if isinstance(value, Mapping):
        return {_seen(key): _seen(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_seen(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
