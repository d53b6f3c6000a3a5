"""Axes and signs on a piece of ribbon, for the page of the theory: `axes.svg`.

    python scripts/figure_axes.py [--out docs/figures/axes.svg]

A helix of `configs/helix.yaml`, whose strains are constant: on the left its directors and the
generatrix along b = d2 + eta d3, on the right what the part beyond a cut does to the part before.
Arrows are as long as is seen well, n excepted, whose direction is that of the solution.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt import Solution, load_scene, solve
from ribbonopt.arrays import Array
from ribbonopt.output.staging import replaced
from ribbonopt.views.camera import Camera
from ribbonopt.views.style import BENDING, INK, RATIO, TWIST, blank

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ROOT = Path(__file__).parents[1]
STRAINS = ("parameters.curvature=1.7", "parameters.torsion=0.85")
HALF_WIDTH, PLACE, CUT = 0.11, 0.5, 0.6  # lengths L = 1
ARROW, RADIUS = 0.3, 0.06
FRONT, BACK = (
    np.array([0.36, 0.58, 0.80]),
    np.array([0.93, 0.72, 0.45]),
)  # the side of d1, the other
TOWARDS = (0.6, 0.75, 0.28)  # the viewer, along the directors at `PLACE`
SLICES = (-1.0, -0.5, 0.0, 0.5, 1.0)  # of the half-width


def main() -> None:
    """Solve, draw, write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "figures" / "axes.svg")
    path = parser.parse_args().out
    solution = solve(load_scene(str(ROOT / "configs" / "helix.yaml"), STRAINS))
    figure = blank(7.6, 2.9)
    left, right = figure.subplots(1, 2)
    ribbon = Piece(solution, left)
    ribbon.surface(0, 1)
    ribbon.directors(PLACE)
    ribbon.lab()
    left.set_title("directors and generatrices", fontsize=10)
    ribbon = Piece(solution, right)
    ribbon.surface(CUT, 1, lighter=0.72)
    ribbon.surface(0, CUT)
    ribbon.cut(CUT)
    right.set_title("force and moment at a cut, signs of strains", fontsize=10)
    for axes in (left, right):
        axes.set(aspect="equal")
        axes.margins(0.07)
        axes.set_axis_off()
    import matplotlib as mpl

    # The same bytes whenever it is drawn: no date, ids from a salt.
    with mpl.rc_context({"svg.hashsalt": "axes", "svg.fonttype": "path"}), replaced(path) as new:
        figure.savefig(new, format="svg", metadata={"Date": None})


class Piece:
    """A solution as seen from one side, drawn into axes."""

    def __init__(self, solution: Solution, axes: Axes) -> None:
        self.solution, self.axes = solution, axes
        frame = np.array([self._vector(PLACE, name) for name in ("d1", "d2", "d3")])
        towards = TOWARDS @ frame / np.linalg.norm(TOWARDS)
        right = np.cross(frame[0], towards)
        right /= np.linalg.norm(right)
        self.camera = Camera(right, np.cross(towards, right), towards)

    def surface(self, start: float, end: float, lighter: float = 0.0) -> None:
        """Draw the ribbon between two arclengths: faces far to near, edges, generatrices."""
        from matplotlib.collections import PolyCollection

        s = np.linspace(start, end, int(60 * (end - start)) + 2)
        grid = np.stack([self._at(s, v * HALF_WIDTH) for v in SLICES], axis=1)
        corners = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2)
        normals = np.repeat(self.solution.sample(s[:-1], "d1"), len(SLICES) - 1, axis=0)
        plane, heights = self.camera.project(corners.reshape(-1, 4, 3))
        diffuse, gloss = self.camera.brightness(normals)
        sides = np.where((normals @ self.camera.towards > 0)[:, None], FRONT, BACK)
        colours = np.minimum(sides * diffuse[:, None] + gloss[:, None], 1)
        colours += lighter * (1 - colours)
        order = np.argsort(heights.mean(axis=1))
        faces = PolyCollection(list(plane[order]), fc=colours[order], ec=colours[order], lw=0.4)
        self.axes.add_collection(faces)
        shade = 0.75 * lighter
        for v, width in ((-1, 0.9), (1, 0.9), (0, 1.1)):
            self._line(self._at(s, v * HALF_WIDTH), width, shade)
        for place in np.arange(np.ceil(start * 20), end * 20 + 1e-9) / 20:
            self._line(self._generatrix(place), 0.4, shade)
        for place in (start, end):
            self._line(self._generatrix(place), 0.9, shade)

    def directors(self, s: float) -> None:
        """Draw d1, d2, d3 at an arclength, the generatrix there and its angle to d2."""
        r, b = self._vector(s, "r"), self._across(s)
        self._line(self._generatrix(s), 2.0, 0.0, TWIST)
        for name, colour, shift in (
            ("d1", BENDING, (0.0, 0.03)),
            ("d2", BENDING, (-0.04, 0.03)),
            ("d3", BENDING, (0.035, -0.01)),
        ):
            label = rf"$\mathbf{{d}}_{name[1]}$"
            self._arrow(r, ARROW * 0.75 * self._vector(s, name), colour, label, shift)
        way = 2.1 * HALF_WIDTH * b
        self._line(np.array([r, r + way]), 0.8, 0.0, TWIST, "--")
        self._text(r + way, r"$\mathbf{b}=\mathbf{d}_2+\eta\,\mathbf{d}_3$", TWIST, (0.13, -0.015))
        angle = np.linspace(0, np.arctan(self._eta(s)), 16)[:, None]
        d2, d3 = self._vector(s, "d2"), self._vector(s, "d3")
        arc = r + 0.175 * (np.cos(angle) * d2 + np.sin(angle) * d3)
        self._line(arc, 1.0, 0.0, TWIST)
        self._text(arc[6], r"$\arctan\,\eta$", TWIST, (-0.085, -0.045))
        self._text(self._vector(1, "r"), r"$\mathbf{r}(s)$", INK, (0.06, 0.0))

    def lab(self) -> None:
        """Draw the lab's axes, beside the start."""
        r = self._vector(0, "r") - 0.4 * self.camera.up - 0.04 * self.camera.right
        for axis, way in zip("xyz", np.eye(3), strict=True):
            shift = tuple(0.035 * self.camera.project(way)[0])
            self._arrow(r, 0.16 * way, RATIO, rf"$\mathbf{{e}}_{axis}$", shift)

    def cut(self, s: float) -> None:
        """Draw n at an arclength, and rings about d2 and d3 the way moments and strains turn."""
        r = self._vector(s, "r")
        force = self._vector(s, "n")
        way = 1.15 * ARROW * force / np.linalg.norm(force)
        self._arrow(r, way, TWIST, r"$\mathbf{n}$", (0.03, 0.0))
        for name, first, second in (("d1", "d2", "d3"), ("d2", "d3", "d1"), ("d3", "d1", "d2")):
            axis, number = self._vector(s, name), name[1]
            self._arrow(r, 0.8 * ARROW * axis, BENDING, "", (0.0, 0.0))
            label = rf"$m_{number},\,u_{number}$" if number != "1" else r"$m_1,\,u_1=0$"
            middle = r + 0.8 * ARROW * axis * 0.72
            angle = np.linspace(-0.2 * np.pi, 1.45 * np.pi, 60)[:, None]
            sides = self._vector(s, first), self._vector(s, second)
            ring = middle + RADIUS * (np.cos(angle) * sides[0] + np.sin(angle) * sides[1])
            self._ring(ring, BENDING)
            shift = {"1": (-0.02, 0.06), "2": (-0.13, -0.02), "3": (0.09, -0.03)}[number]
            self._text(r + 0.8 * ARROW * axis, label, BENDING, shift)

    def _at(self, s: Array, v: float) -> Array:
        """Points (k, 3) of the surface, r + v b."""
        u2, u3 = self.solution.sample(s, "u2"), self.solution.sample(s, "u3")
        b = self.solution.sample(s, "d2") + (u3 / u2)[:, None] * self.solution.sample(s, "d3")
        return np.asarray(self.solution.sample(s, "r") + v * b)

    def _vector(self, s: float, name: str) -> Array:
        return np.asarray(self.solution.sample(np.array([s]), name)[0])

    def _eta(self, s: float) -> float:
        return float(self.solution.sample(np.array([s]), "u3 / u2")[0])

    def _across(self, s: float) -> Array:
        return self._vector(s, "d2") + self._eta(s) * self._vector(s, "d3")

    def _generatrix(self, s: float) -> Array:
        way = HALF_WIDTH * self._across(s)
        return self._vector(s, "r") + np.array([[-1.0], [1.0]]) * way

    def _line(
        self, points: Array, width: float, shade: float, colour: str = INK, style: str = "-"
    ) -> None:
        plane = self.camera.project(points)[0]
        self.axes.plot(*plane.T, color=colour, lw=width, alpha=1 - shade, ls=style)

    def _arrow(
        self, tail: Array, way: Array, colour: str, label: str, shift: tuple[float, ...]
    ) -> None:
        ends = self.camera.project(np.array([tail, tail + way]))[0]
        look = {"arrowstyle": "-|>", "color": colour, "lw": 1.6, "shrinkA": 0, "shrinkB": 0}
        self.axes.annotate("", xy=tuple(ends[1]), xytext=tuple(ends[0]), arrowprops=look, zorder=5)
        self.axes.plot(*ends.T, lw=0)  # an annotation asks for no room
        self._text(tail + way, label, colour, shift)

    def _ring(self, points: Array, colour: str) -> None:
        plane = self.camera.project(points)[0]
        self.axes.plot(*plane[:-1].T, color=colour, lw=1.2, zorder=5)
        look = {"arrowstyle": "-|>", "color": colour, "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
        self.axes.annotate("", xy=tuple(plane[-1]), xytext=tuple(plane[-4]), arrowprops=look)

    def _text(self, point: Array, words: str, colour: str, shift: tuple[float, ...]) -> None:
        from matplotlib.patheffects import withStroke

        x, y = self.camera.project(point)[0] + np.array(shift)
        halo = [withStroke(linewidth=2.5, foreground="white")]
        look = {"ha": "center", "va": "center", "fontsize": 11, "color": colour}
        self.axes.text(x, y, words, look, path_effects=halo, zorder=6)


if __name__ == "__main__":
    main()
