"""Figure 4: the Moebius ribbon of Sadowsky's law, half of it solved, half by symmetry."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ribbonopt import Solution
from ribbonopt.views.camera import place_camera
from ribbonopt.views.facets import draw_surface
from ribbonopt.views.ribbon import paint, scale_bar
from ribbonopt.views.subject import subject_of
from ribbonopt.views.surface import sweep

from .found import MIDDLE, Answers, Found, Rows, half_of
from .numbers import Number
from .page import BENDING, FAINT, GREEN, INK, SOFT, TWIST, Panel
from .parts import label_strains, shade_plane
from .relations import SADOWSKY, on_arrays
from .space import Space

TITLE = "Figure 4   Möbius ribbon of Sadowsky's law"
HALF_WIDTH = 0.1 / np.pi  # that the ribbon is drawn to: w/L = 0.2/pi, as in figure 5
MOMENTS = np.array([[-12.0, 12.0], [-12.0, 24.0], [-15.0, 15.0]])  # limits of m2, m3, u2


def panels(found: Found) -> list[Panel]:
    """Return the four panels."""
    rows = half_of(found.sadowsky)
    return [
        Panel("a", "strains along the ribbon", _strains(rows), _of_strains(found.sadowsky)),
        Panel("b", r"in the plane $(u_2, u_3)$", _plane(rows), _of_plane(found.sadowsky, rows)),
        Panel("c", "the ribbon", _ribbon(found.sadowsky), _of_ribbon(found.sadowsky), bare=True),
        Panel("d", r"in $(m_2, m_3, u_2)$", _space(rows), _of_space(found.sadowsky), solid=True),
    ]


def columns(found: Found) -> dict[str, Any]:
    """Return the curves as columns."""
    return half_of(found.sadowsky)._asdict()


def _strains(rows: Rows) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        rest = rows.mirrored()
        for name, colour in (("u2", BENDING), ("u3", TWIST)):
            axes.plot(rows.s, getattr(rows, name), color=colour, lw=1.8, label=f"$u_{name[1]}$")
            axes.plot(rest.s, getattr(rest, name), color=colour, lw=1.6, ls=SOFT)
        axes.plot([MIDDLE] * 2, [rows.u2[-1], rest.u2[0]], color=FAINT, lw=1, ls=":")
        axes.plot([], [], color=FAINT, ls=SOFT, label="by symmetry")
        label_strains(axes)

    return draw


def _plane(rows: Rows) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        rest = rows.mirrored()
        shade_plane(axes)
        axes.plot(rows.u2, rows.u3, color=BENDING, lw=1.9)
        axes.plot(rest.u2, rest.u3, color=BENDING, lw=1.7, ls=SOFT)
        for start, end in (((rows, -1), (rest, 0)), ((rest, -1), (rows, 0))):
            places = [(curve.u2[k], curve.u3[k]) for curve, k in (end, start)]
            arrow = {"arrowstyle": "-|>", "color": FAINT, "lw": 1.3, "shrinkA": 3, "shrinkB": 3}
            axes.annotate("", *places, arrowprops=arrow)
        below = {"textcoords": "offset points", "ha": "center", "fontsize": 8.5, "color": INK}
        axes.annotate(r"jump at $s = 1/2$", (0, rows.u3[-1]), (0, 6), **below)
        axes.annotate(r"$s = 1$ is $s = 0$, turned over", (0, rows.u3[0]), (0, -16), **below)
        axes.plot(rows.u2[0], rows.u3[0], "o", color=BENDING, ms=6)
        axes.annotate("$s = 0$", (rows.u2[0], rows.u3[0]), (0, 7), **below)

    return draw


def _ribbon(solution: Solution) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        subject = subject_of(solution, complete=True)
        surface = sweep(subject.pieces, HALF_WIDTH)
        line = np.concatenate([piece.r for piece in subject.pieces])
        camera = place_camera(line, np.concatenate([piece.d1 for piece in subject.pieces]))
        drawing = draw_surface(surface, camera)
        low, high = (f(drawing.corners, axis=(0, 1)) for f in (np.min, np.max))
        size = float(high[0] - low[0])
        paint(axes, drawing)
        box = (
            low[0] - 0.04 * size,
            high[0] + 0.04 * size,
            low[1] - 0.14 * size,
            high[1] + 0.04 * size,
        )
        axes.set(xlim=box[:2], ylim=box[2:], aspect="equal")
        axes.set_axis_off()
        scale_bar(axes, box, size, r" $L$")
        words = r"generatrices $d_2 + \eta\,d_3$, drawn to $w/L = 0.2/\pi$; light: by symmetry"
        axes.text(1, 0.02, words, transform=axes.transAxes, ha="right", fontsize=8, color=INK)

    return draw


def _space(rows: Rows) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        space = Space(MOMENTS, 24, -128)
        draw_sheets(space)
        rest = rows.mirrored()
        for curve, dashes in ((rows, None), (rest, (0.025, 0.016))):
            space.curve(curve.m2, curve.m3, curve.u2, BENDING, 2, dashes)
        for start, end in (((rows, -1), (rest, 0)), ((rest, -1), (rows, 0))):
            jump = [[curve.m2[k], curve.m3[k], curve.u2[k]] for curve, k in (start, end)]
            space.curve(*np.transpose(jump), FAINT, 1.1, (0.012, 0.012), lift=0.2)
        space.paint(axes, ("$m_2$", "$m_3$", "$u_2$"))
        axes.text2D(0.05, 0.95, "dashed: by symmetry", transform=axes.transAxes, fontsize=8.5)

    return draw


def draw_sheets(space: Space) -> None:
    """Add the green sheets of the law (4.3) within the limits of a box."""
    for side in (1, -1):
        m2, m3 = np.meshgrid(
            side * np.linspace(1e-9, MOMENTS[0, 1], 25), np.linspace(*MOMENTS[1], 65), indexing="ij"
        )
        u2 = on_arrays(SADOWSKY.strains, m2, m3)[0]
        space.surface(m2, m3, np.clip(u2, *MOMENTS[2]), GREEN, mesh=8)


def _of_strains(solution: Solution) -> list[Number]:
    answers = Answers(solution)
    u2, u3 = (float(solution.sample(MIDDLE, name)) for name in ("u2", "u3"))
    return [
        answers.number("$u_2(0)$", "u2", "3.3866"),
        answers.number("$u_3(0)$", "u3"),
        Number("$u_2(1/2^-)$", u2, "", answers.bars["u"]),
        Number("$u_3(1/2)$", u3, "", answers.bars["u"]),
    ]


def _of_plane(solution: Solution, rows: Rows) -> list[Number]:
    eta = [
        float(solution.sample(MIDDLE, "eta")),
        float(rows.mirrored().u3[0] / rows.mirrored().u2[0]),
    ]
    return [
        Number(r"$\eta(1/2^-)$", eta[0], "1"),
        Number(r"$\eta(1/2^+)$", eta[1], "-1"),
        Number(r"$\eta(0)$", float(rows.u3[0] / rows.u2[0])),
        Number(r"largest $|\eta|$ on $0 \leq s < 1/2$", float(np.abs(rows.u3 / rows.u2).max())),
    ]


def _of_ribbon(solution: Solution) -> list[Number]:
    answers = Answers(solution)
    r = solution.sample(MIDDLE, "r")
    return [
        Number("$x(1/2)$", float(r[0]), "", answers.bars["states"]),
        Number("$|y(1/2)| + |z(1/2)|$", float(np.abs(r[1:]).sum())),
        Number("twist of the whole, turns", 2 * abs(solution.twist)),
        answers.number("$H$", "H0", "57.5"),
        answers.number("energy of the whole", "whole"),
    ]


def _of_space(solution: Solution) -> list[Number]:
    answers = Answers(solution)
    printed = {"n0y": "43.5", "n0z": "42.1", "m0y": "2.01", "m0z": "-8.87"}
    rows = [
        answers.number(f"${key[0]}_{key[2]}(0)$", key, digits) for key, digits in printed.items()
    ]
    return [*rows, Number("$m_3(1/2) = 4 u_3$", float(solution.sample(MIDDLE, "m3")))]
