"""Surfaces and curves in three dimensions, painted from far to near so that all hides rightly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

Array = NDArray[np.float64]

LIGHT = np.array([-0.35, -0.55, 0.76])
LIFT = 0.02  # of a box of size 1: how much nearer to the viewer lines are painted than faces
AMBIENT = 0.62


@dataclass
class Space:
    """What stands in one box, to be painted together.

    Attributes
    ----------
    limits : (3, 2) array
        Of the three axes.
    elevation, azimuth : float
        Degrees, of the viewer.
    """

    limits: Array
    elevation: float
    azimuth: float
    aspect: tuple[float, float, float] = (1.0, 1.0, 0.85)
    parts: list[tuple[Array, Array, Array, Array]] = field(default_factory=list)

    def surface(
        self, x: Array, y: Array, z: Array, colour: Any, alpha: float = 1.0, mesh: int = 0
    ) -> None:
        """Add a grid (k, l) of points, of one colour; with lines on every `mesh`-th row."""
        grid = np.stack([x, y, z], axis=-1)
        corners = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2)
        corners = corners.reshape(-1, 4, 3)
        scaled = self._scaled(corners)
        normals = np.cross(scaled[:, 2] - scaled[:, 0], scaled[:, 3] - scaled[:, 1])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True) + 1e-300
        bright = AMBIENT + (1 - AMBIENT) * np.abs(normals @ (LIGHT / np.linalg.norm(LIGHT)))
        rgb = np.minimum(np.array(to_rgb(colour)) * bright[:, None] * 1.05, 1)
        faces = np.column_stack([rgb, np.full(len(rgb), alpha)])
        self._add(corners, faces, faces, 0.3)
        if mesh:
            for i in range(0, len(x), mesh):
                self.curve(x[i], y[i], z[i], "black", 0.35, alpha=0.45)
            for j in range(0, x.shape[1], mesh):
                line = (x[:, j], y[:, j], z[:, j])
                self.curve(*line, "black", 0.35, alpha=0.45)

    def curve(
        self,
        x: Any,
        y: Any,
        z: Any,
        colour: Any,
        width: float,
        dashes: tuple[float, float] | None = None,
        alpha: float = 1.0,
        lift: float = LIFT,
    ) -> None:
        """Add a polyline; `dashes`: lengths of dash and gap, as shares of the box."""
        points = np.stack(np.broadcast_arrays(*map(np.asarray, (x, y, z))), axis=-1).astype(float)
        scaled = self._scaled(points)
        length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(scaled, axis=0), axis=1))])
        fine = np.linspace(0, length[-1], max(2, int(length[-1] / 0.008)))
        points = np.stack([np.interp(fine, length, column) for column in points.T], axis=-1)
        segments = np.stack([points[:-1], points[1:], points[1:], points[:-1]], axis=1)
        if dashes:
            segments = segments[(fine[:-1] % sum(dashes)) < dashes[0]]
        segments = segments + lift * self._towards() * np.ptp(self.limits, axis=1)
        edge = np.tile([*to_rgb(colour), alpha], (len(segments), 1))
        self._add(segments, np.zeros_like(edge), edge, width)

    def paint(self, axes: Any, labels: Sequence[str]) -> None:
        """Paint all of it into axes."""
        corners, faces, edges, widths = (
            np.concatenate(column) for column in zip(*self.parts, strict=True)
        )
        # The collection sorts its polygons and their colours, but not their widths: all in order.
        order = np.argsort(self._scaled(corners.mean(axis=1)) @ self._viewer(), kind="stable")
        corners, faces, edges, widths = (x[order] for x in (corners, faces, edges, widths))
        axes.set_proj_type("ortho")
        axes.add_collection3d(
            Poly3DCollection(
                list(corners),
                facecolors=faces,
                edgecolors=edges,
                linewidths=widths,
                zsort="average",
                capstyle="round",
            )
        )
        axes.set(xlim=self.limits[0], ylim=self.limits[1], zlim=self.limits[2])
        axes.set_xlabel(labels[0], labelpad=-3)
        axes.set_ylabel(labels[1], labelpad=-3)
        axes.set_zlabel(labels[2], labelpad=-4)
        axes.tick_params(labelsize=7.5, pad=-2)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10], prune="both"))
        axes.view_init(elev=self.elevation, azim=self.azimuth)
        axes.set_box_aspect(self.aspect, zoom=1.04)
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_pane_color((1, 1, 1, 0))
            axis._axinfo["grid"].update(color=(0.88, 0.88, 0.88, 1), linewidth=0.5)

    def _add(self, corners: Array, faces: Array, edges: Array, width: float) -> None:
        self.parts.append((corners, faces, edges, np.full(len(corners), width)))

    def _scaled(self, points: Array) -> Array:
        """Return points in a box of size 1, with the aspect of the picture."""
        scaled = (points - self.limits[:, 0]) / np.ptp(self.limits, axis=1) * self.aspect
        return np.asarray(scaled)

    def _towards(self) -> Array:
        """Return the unit step to the viewer, as shares of the limits."""
        return self._viewer() / np.array(self.aspect)

    def _viewer(self) -> Array:
        """Return the unit vector to the viewer, in the box of size 1."""
        e, a = np.radians([self.elevation, self.azimuth])
        return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
