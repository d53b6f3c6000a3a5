"""Marks of what acts on a ribbon, in a picture: arrows, and symbols of supports.

Arrows are as long as their share of the largest: one scale for forces, one for forces per length.
Marks lie under the ribbon and begin beside it, so that they hide none of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.classes import dataclass

from .acting import Acting, Site
from .camera import Camera
from .paper_style import stroke
from .pieces import Array
from .style import INK, TWIST
from .surface import Surface

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LONGEST, ROW = 0.17, 0.075  # of the picture: arrows of the largest force, and force per length
SYMBOL = 0.035  # of the picture: height of a triangle, depth of a clamp
WIDER = 1.3  # a clamp, than the ribbon
SEEN = 0.3  # of a direction, from which on the picture shows its way
AGAINST = -0.5  # cosine to what leads away from an end, below which arrows end there
NOTHING = 1e-12  # of the largest: forces that are zero
PLATE = "#b8b8b8"


@dataclass(frozen=True, eq=False)
class Marks:
    """Marks in the plane of a picture: polygons with their colours, lines, arrows (k, 2, 2).

    Arrows are pairs of tail and way: `arrows` of forces, `rows` of forces per length. `rings`
    (k, 2), of moments, end in an arrow.
    """

    polygons: tuple[tuple[Array, str], ...]
    lines: tuple[tuple[Array, str], ...]
    arrows: Array
    rows: Array
    rings: tuple[Array, ...] = ()

    @property
    def points(self) -> Array:
        """All that a picture must have room for, (k, 2)."""
        parts = [*(p for p, _ in (*self.polygons, *self.lines)), *self.rings]
        for arrows in (self.arrows, self.rows):
            parts += [arrows[:, 0], arrows.sum(axis=1)]
        return np.concatenate(parts)


def marks_of(acting: Acting, surface: Surface, camera: Camera, size: float) -> Marks:
    """Return the marks of what acts on a ribbon in a picture of this size."""
    artist = _Artist(surface, camera, size)
    polygons: list[tuple[Array, str]] = []
    lines: list[tuple[Array, str]] = []
    arrows, rows, rings = [], [], []
    for site in acting.sites:
        if np.linalg.norm(site.force) > NOTHING * acting.largest:
            length = LONGEST * size / acting.largest
            arrows.append(artist.arrow(site.at, length * site.force, site.outward))
        if np.linalg.norm(site.moment) > NOTHING * acting.strongest:
            rings.append(artist.ring(site.at, site.moment))
        if site.clamped:
            polygons.append((artist.clamp(site), PLATE if site.whole else "white"))
            if site.guide is not None:
                lines.append((artist.guide(site, site.guide), "-"))
        elif site.held:
            polygon, base = artist.support(site)
            polygons.append((polygon, PLATE))
            lines.append((base, "-"))
    for force in acting.along:
        scaled = ROW * size / acting.densest * force
        rows += [artist.arrow(s, f, 0) for s, f in zip(acting.s, scaled, strict=True)]
    if acting.string:
        lines.append((artist.chord, ":"))
    none = np.empty((0, 2, 2))
    both = np.array(arrows or none), np.array(rows or none)
    return Marks(tuple(polygons), tuple(lines), *both, tuple(rings))


def paint_marks(axes: Axes, marks: Marks) -> None:
    """Draw marks into axes, below what is drawn there otherwise."""
    from matplotlib.patches import FancyArrowPatch, Polygon
    from matplotlib.path import Path

    for ring in marks.rings:
        arrow = FancyArrowPatch(
            path=Path(ring),
            arrowstyle="-|>",
            mutation_scale=stroke(11),
            shrinkA=0,
            shrinkB=0,
            color=TWIST,
            lw=stroke(1.4),
            zorder=0.6,
        )
        axes.add_patch(arrow)
    for corners, colour in marks.polygons:
        axes.add_patch(Polygon(corners, fc=colour, ec=INK, lw=stroke(0.8), zorder=0.5))
    for points, style in marks.lines:
        axes.plot(*points.T, color=INK, lw=stroke(0.9), ls=style, zorder=0.4)
    for arrows, width, alpha in ((marks.rows, 0.9, 0.45), (marks.arrows, 2.0, 1.0)):
        if len(arrows):
            (x, y), (u, v) = arrows.transpose(1, 2, 0)
            axes.quiver(
                *(x, y, u, v),
                angles="xy",
                scale_units="xy",
                scale=1,
                units="inches",
                width=stroke(width) / 72,
                minlength=0,
                headwidth=4.5,
                headlength=5.5,
                headaxislength=5,
                color=TWIST,
                alpha=alpha,
                zorder=0.6,
            )


@dataclass(frozen=True, eq=False)
class _Artist:
    """Knows where in the picture the ribbon is, and what is beside it."""

    surface: Surface
    camera: Camera
    size: float

    @property
    def chord(self) -> Array:
        """The line (2, 2) from the start to the end."""
        first, last = self.surface.sheets[0].piece, self.surface.sheets[-1].piece
        return self._seen(np.array([first.r[0], last.r[-1]]))

    def arrow(self, s: float, vector: Array, outward: int) -> Array:
        """Return tail and way (2, 2) of a vector (3,); one that presses on an end ends there."""
        way = self._seen(vector)
        away = outward * self._direction(s)
        if outward and _unit(way) @ _unit(away) < AGAINST:
            return np.array([self._point(s) - way, way])
        return np.array([self._beside(s, _unit(way)), way])

    def ring(self, s: float, moment: Array) -> Array:
        """Return most of a circle (k, 2) about a moment (3,), right-handed, around the ribbon."""
        sheet, row = self.surface.at(s)
        middle, axis = sheet.piece.r[row], moment / np.linalg.norm(moment)
        out = np.linalg.norm(sheet.points(1)[row] - middle)
        frame = (sheet.piece.d1[row], sheet.piece.d2[row], sheet.piece.d3[row])
        across = [v - (v @ axis) * axis for v in frame]
        first = _unit(max(across, key=lambda v: float(v @ v)))
        angle = np.linspace(0.15 * np.pi, 1.75 * np.pi, 49)[:, None]
        circle = np.cos(angle) * first + np.sin(angle) * np.cross(axis, first)
        return self._seen(middle + max(WIDER * out, SYMBOL * self.size) * circle)

    def clamp(self, site: Site) -> Array:
        """Return the corners (4, 2) of a plate behind an end."""
        sheet, row = self.surface.at(site.at)
        middle = sheet.piece.r[row]
        sides = [middle + WIDER * (sheet.points(f)[row] - middle) for f in (-1, 1)]
        depth = site.outward * SYMBOL * self.size * sheet.piece.d3[row]
        return self._seen(np.array([*sides, sides[1] + depth, sides[0] + depth]))

    def guide(self, site: Site, along: Array) -> Array:
        """Return the line (2, 2) along which a clamp slides, at its back."""
        middle = self.clamp(site)[2:].mean(axis=0)
        way = 2.5 * SYMBOL * self.size * self._seen(along / np.linalg.norm(along))
        return np.array([middle - way, middle + way])

    def support(self, site: Site) -> tuple[Array, Array]:
        """Return a triangle (3, 2), or a circle where the position is held in part, and its base.

        It stands where the support pushes from, or below along what it holds.
        """
        way, away = self._seen(-site.reaction), _unit(site.outward * self._direction(site.at))
        if np.linalg.norm(way) <= max(SEEN * np.linalg.norm(site.reaction), NOTHING):
            held = [self._seen(np.eye(3)["xyz".index(axis)]) for axis in site.held]
            way = max(held, key=lambda v: float(v @ v))
            fit = way @ away if abs(way @ away) > abs(AGAINST) else -way[1]
            way = way if fit >= 0 else -way
        way = away if _unit(way) @ away < AGAINST else _unit(way)
        side, height = np.array([-way[1], way[0]]), SYMBOL * self.size
        tip = self._beside(site.at, way)
        foot = tip + height * way
        base = np.array([foot - height * side, foot + height * side])
        if site.whole:
            return np.array([tip, foot - 0.6 * height * side, foot + 0.6 * height * side]), base
        angle = np.linspace(0, 2 * np.pi, 25)[:, None]
        radius = height / 2
        return tip + radius * (way * (1 - np.cos(angle)) + side * np.sin(angle)), base

    def _point(self, s: float) -> Array:
        sheet, row = self.surface.at(s)
        return self._seen(sheet.piece.r[row])

    def _direction(self, s: float) -> Array:
        sheet, row = self.surface.at(s)
        return self._seen(sheet.piece.d3[row])

    def _beside(self, s: float, way: Array) -> Array:
        """Return the point (2,) that is so far from the centre line as the ribbon reaches."""
        sheet, row = self.surface.at(s)
        reach = self._seen(sheet.points(1)[row] - sheet.piece.r[row])
        return np.asarray(self._point(s) + abs(reach @ way) * way)

    def _seen(self, vectors: Array) -> Array:
        return self.camera.project(vectors)[0]


def _unit(vector: Array) -> Array:
    return np.asarray(vector / max(float(np.linalg.norm(vector)), np.finfo(float).tiny))
