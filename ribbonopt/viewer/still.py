"""A small still picture of a ribbon as SVG, for where the scripts of a page do not run."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.views.camera import Camera
from ribbonopt.views.facets import BACK, FRONT, LIGHTER
from ribbonopt.views.shape import Shape

FACES, SIZE = 40, 400  # at most; pixels of the longer side


def still(shape: Shape, camera: Camera) -> str:
    """Return the surface of a shape as faces from far to near; "" where there is nothing to see."""
    known = np.isfinite(np.column_stack([shape.r, shape.b, shape.d1])).all(axis=1)
    places = np.flatnonzero(known & (np.diff(shape.s, prepend=-np.inf) > 0))
    if len(places) < 2:
        return ""
    chosen = np.searchsorted(shape.s[places], np.linspace(shape.s[0], shape.s[-1], FACES + 1))
    rows: NDArray[np.intp] = np.unique(places[np.minimum(chosen, len(places) - 1)])
    edges = [camera.project(shape.points(side)[rows]) for side in (-1.0, 1.0)]
    (left, deep), (right, deeper) = edges
    low = np.minimum(left.min(axis=0), right.min(axis=0))
    size = np.maximum(left.max(axis=0), right.max(axis=0)) - low
    scale = SIZE / max(float(size.max()), 1e-300)
    # Down in a picture is what is low.
    a, b = (np.column_stack([p - low[0], low[1] + size[1] - q]) for p, q in (left.T, right.T))
    corners = np.rint(scale * np.stack([a[:-1], b[:-1], b[1:], a[1:]], axis=1)).astype(int)
    colours = _lit(shape, camera, rows)
    order = np.argsort((deep + deeper)[:-1] + (deep + deeper)[1:])
    faces = "".join(f'<path d="{_path(corners[i])}" fill="{colours[i]}"/>' for i in order)
    width, height = np.ceil(scale * size).astype(int)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" overflow="visible" role="img" aria-label="the ribbon">'
        f"{faces}</svg>"
    )


def _lit(shape: Shape, camera: Camera, rows: NDArray[np.intp]) -> list[str]:
    """Return the colours of the faces after some rows, in the light of the figures."""
    normals = shape.d1[rows[:-1]]
    front = (normals @ camera.towards > 0) | (shape.closing < 0)
    diffuse, gloss = camera.brightness(normals)
    colour = np.where(front[:, None], FRONT, BACK)
    pale = LIGHTER * shape.mirrored[rows[:-1], None]
    colour = (colour + pale * (1 - colour)) * diffuse[:, None] + gloss[:, None]
    levels = np.rint(255 * np.clip(colour, 0, 1)).astype(int)
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in levels]


def _path(corners: Array) -> str:
    (x, y), *others = corners.tolist()
    return f"M{x} {y}L{' '.join(f'{x} {y}' for x, y in others)}z"
