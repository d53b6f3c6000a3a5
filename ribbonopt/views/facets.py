"""A surface as small faces and lines, far to near: what is painted later hides what is behind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass

from .camera import Camera
from .pieces import ROWS, Array
from .surface import Sheet, Surface
from .tint import DARKEST, Tint

STRIPS = 8  # faces across the ribbon
GENERATRICES = 48  # over the length drawn
FRONT = np.array([0.36, 0.58, 0.80])  # side of d1
BACK = np.array([0.93, 0.72, 0.45])  # other side, of a ribbon that has two
LINES = np.array([0.12, 0.16, 0.24])
EDGE, CENTRE, GENERATRIX = (0.8, 0.9), (1.0, 0.85), (0.5, 0.5)  # width in points, opacity
PLACE = (1.6, 0.9)
SEAM = 0.35  # width in points of a face's own outline, which closes the seams between faces
LIGHTER = 0.45  # of the way to white, for what follows by symmetry
HAZE = 0.22  # of the way to white, for what is furthest


@dataclass(frozen=True)
class Drawing:
    """Polygons in painting order: corners (k, 4, 2), face and edge colours (k, 4), line widths."""

    corners: Array
    faces: Array
    edges: Array
    line_widths: Array

    def thinned(self, share: float) -> Drawing:
        """Return it with lines of a share of their width, but seams stay closed."""
        return replace(self, line_widths=np.maximum(share * self.line_widths, SEAM))


#: a Drawing with heights (k,) after its corners
Part = tuple[Array, Array, Array, Array, Array]


def draw_surface(
    surface: Surface, camera: Camera, places: Sequence[float] = (), tint: Tint | None = None
) -> Drawing:
    """Project, light and sort the faces, generatrices, edges and centre line of a ribbon.

    The generatrices at `places`, arclengths, are drawn strongly. With `tint` both sides have the
    colours of a field, what follows by symmetry too.
    """
    return sorted_far(parts_of(surface, camera, places, tint), HAZE if tint is None else 0.0)


def parts_of(
    surface: Surface, camera: Camera, places: Sequence[float] = (), tint: Tint | None = None
) -> list[Part]:
    """Return what of a ribbon is drawn, projected and lit, in no order; see `draw_surface`."""
    back = FRONT if surface.one_sided else BACK
    length = surface.sheets[-1].piece.s[-1] - surface.sheets[0].piece.s[0]
    # A line lies in the faces that it borders: lifted by their radius it is painted after them.
    across = 2 * surface.widest / STRIPS
    sheared = across * max(float(np.abs(sheet.eta).max()) for sheet in surface.sheets)
    lift = 0.5 * float(np.hypot(length / ROWS + sheared, across))
    parts = []
    for sheet in surface.sheets:
        if tint is None:
            parts.append(_lit(camera, *_faces(sheet), back, sheet.piece.mirrored))
        else:
            parts.append(_tinted(camera, *_faces(sheet), tint.colours(sheet.piece)))
        parts += [_segments(camera, lift, points, width) for points, width in _lines(sheet, length)]
    for s in places:
        sheet, row = surface.at(s)
        parts.append(_segments(camera, lift, _across(sheet, row), PLACE))
    if not surface.closed:
        for sheet, row in ((surface.sheets[0], 0), (surface.sheets[-1], -1)):
            parts.append(_segments(camera, lift, _across(sheet, row), EDGE))
    return parts


def sorted_far(parts: Sequence[Part], far: float) -> Drawing:
    """Return parts from far to near; what is furthest is `far` of the way to white."""
    corners, heights, faces, edges, line_widths = (
        np.concatenate(column) for column in zip(*parts, strict=True)
    )
    order = np.argsort(heights, kind="stable")
    haze = far * (heights.max() - heights) / max(float(np.ptp(heights)), 1e-300)
    for colours in (faces, edges):
        colours[:, :3] += haze[:, None] * (1 - colours[:, :3])
    return Drawing(corners[order], faces[order], edges[order], line_widths[order])


def faded(part: Part, share: float) -> Part:
    """Return a part whose colours are a share of the way to white."""
    corners, heights, faces, edges, line_widths = part
    paler = [np.column_stack([c[:, :3] + share * (1 - c[:, :3]), c[:, 3]]) for c in (faces, edges)]
    return corners, heights, paler[0], paler[1], line_widths


def _faces(sheet: Sheet) -> tuple[Array, Array]:
    """Corners (k, 4, 3) and normals (k, 3) of the faces of a sheet."""
    grid = np.stack([sheet.points(f) for f in np.linspace(-1, 1, STRIPS + 1)], axis=1)
    corners = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2)
    d1 = sheet.piece.d1[:-1] + sheet.piece.d1[1:]
    normals = d1 / np.linalg.norm(d1, axis=1, keepdims=True)
    return corners.reshape(-1, 4, 3), np.repeat(normals, STRIPS, axis=0)


def _lit(camera: Camera, corners: Array, normals: Array, back: Array, mirrored: bool) -> Part:
    """Faces with the colour of the side that is seen, in the camera's light."""
    front = normals @ camera.towards > 0
    diffuse, gloss = camera.brightness(normals)
    colour = np.where(front[:, None], FRONT, back)
    if mirrored:
        colour = colour + LIGHTER * (1 - colour)
    colour = np.minimum(colour * diffuse[:, None] + gloss[:, None], 1)
    rgba = np.column_stack([colour, np.ones(len(colour))])
    plane, heights = camera.project(corners)
    return plane, heights.mean(axis=1), rgba, rgba.copy(), np.full(len(rgba), SEAM)


def _tinted(camera: Camera, corners: Array, normals: Array, colours: Array) -> Part:
    """Faces in colours (rows, 3) that light changes little, so that a bar tells what they mean."""
    diffuse, _ = camera.brightness(normals)
    light = DARKEST + (1 - DARKEST) * diffuse
    colour = np.repeat(colours, STRIPS, axis=0) * light[:, None]
    rgba = np.column_stack([colour, np.ones(len(colour))])
    plane, heights = camera.project(corners)
    return plane, heights.mean(axis=1), rgba, rgba.copy(), np.full(len(rgba), SEAM)


def _lines(sheet: Sheet, length: float) -> list[tuple[Array, tuple[float, float]]]:
    """Polylines (k, ..., 3): the edges, the centre line, and generatrices, evenly spaced."""
    s = sheet.piece.s
    step = length / GENERATRICES
    wanted = np.arange(np.ceil(s[0] / step), s[-1] / step) * step
    rows = np.unique(np.abs(s[:, None] - wanted).argmin(axis=0))
    along = [(sheet.points(f), style) for f, style in ((-1, EDGE), (0, CENTRE), (1, EDGE))]
    return [*along, (_across(sheet, rows), GENERATRIX)]


def _across(sheet: Sheet, rows: Any) -> Array:
    """Points (STRIPS + 1, ..., 3) of the generatrices at some rows."""
    return np.stack([sheet.points(f)[rows] for f in np.linspace(-1, 1, STRIPS + 1)])


def _segments(camera: Camera, lift: float, points: Array, style: tuple[float, float]) -> Part:
    """Segments between successive points (k, 3) or (k, l, 3), as polygons without area."""
    width, alpha = style
    a, b = points[:-1].reshape(-1, 3), points[1:].reshape(-1, 3)
    plane, heights = camera.project(np.stack([a, b, b, a], axis=1))
    edges = np.tile([*LINES, alpha], (len(a), 1))
    return plane, heights.mean(axis=1) + lift, np.zeros_like(edges), edges, np.full(len(a), width)
