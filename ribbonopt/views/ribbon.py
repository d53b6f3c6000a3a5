"""Figure: the ribbon in space, a shaded surface with its generatrices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.solution.solution import Solution

from .camera import Camera, camera_for
from .facets import Drawing, draw_surface
from .generatrices import ETA_BOUND, LEAP_SLOPE
from .lettering import wrapped
from .marks import marks_of, paint_marks
from .paper_style import PLAIN, USUAL, Style, sized, stroke
from .pieces import Array
from .style import FAINT, INK, blank, head
from .subject import Subject, subject_of
from .surface import Surface, sweep
from .tint import tint_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 7.2, 6.4  # inches, at most
NARROWEST = 0.75  # width of a picture over its height: room for its title
WORDS, BAR = 0.7, 0.85  # inches: of title and caption, and of a bar of colours
FLAT = 0.5  # height of a picture over its width, below which it is
MARGINS = 0.3  # inches that are no caption's
UNSHORTENED = {"shrinkA": 0, "shrinkB": 0}  # arrows


def plot_ribbon(
    solution: Solution,
    half_width: float | None = None,
    complete: bool = True,
    style: Style = PLAIN,
) -> Figure:
    """Draw the ribbon: points r + v (d2 + eta d3), |v| <= half_width.

    Parameters
    ----------
    solution
        What to draw.
    half_width
        Default: that of the ribbon, where the scene says it; else a twentieth of the length drawn,
        or less so that no generatrices cross; an eightieth of a rod. The figure states it. It is
        that where the width along the ribbon is 1.
    complete
        Add, in a lighter tone, the rest of a band of which this solution is a piece by symmetry.
    style
        Size, type, camera and colours; its half-width where no other is given.
    """
    with style.applied():
        return draw_ribbon(subject_of(solution, complete), half_width, style)


def draw_ribbon(subject: Subject, half_width: float | None = None, style: Style = PLAIN) -> Figure:
    """Draw a ribbon; a rod with u1 as a strip along d2, which is straight across."""
    pieces = subject.pieces
    half_width = style.half_width if half_width is None else half_width
    surface = sweep(pieces, subject.drawn if half_width is None else half_width)
    line = np.concatenate([p.r for p in pieces])
    normals = np.concatenate([p.d1 for p in pieces])
    camera = camera_for(style.camera, line, normals, subject.acting.ways)
    tint = tint_of(style.color, [subject])
    drawing = draw_surface(surface, camera, list(subject.acting.places), tint)
    (left, low), (right, high) = drawing.corners.min(axis=(0, 1)), drawing.corners.max(axis=(0, 1))
    size = max(right - left, (high - low) * WIDTH / HEIGHT)
    marks = marks_of(subject.acting, surface, camera, size)
    for x, y in marks.points:
        left, right, low, high = min(left, x), max(right, x), min(low, y), max(high, y)
    foot = 0.13 * size
    low, high = low - foot, high + 0.03 * size
    beside = max(0.03 * size, (NARROWEST * (high - low) - (right - left)) / 2)
    box = (left - beside, right + beside, low, high)
    width, type_size = style.width or WIDTH, style.type_size / USUAL
    flat, bar = is_flat(box), BAR * type_size if tint else 0.0
    page = (width - (0.0 if flat else bar)) / (box[1] - box[0])
    height = min(HEIGHT * width / WIDTH, page * (box[3] - box[2]))
    words = (WORDS * type_size if style.titles else 0.0) + (bar if flat else 0.0)
    figure = blank(width, max(height, 0.2 * width) + words, style)
    axes = figure.add_subplot()
    paint(axes, drawing)
    paint_marks(axes, marks)
    axes.set(xlim=box[:2], ylim=box[2:], aspect="equal")
    axes.set_axis_off()
    head(axes, subject.name, subject.units)
    scale_bar(axes, box, size, " m" if subject.units.si else "")
    _triad(axes, camera, box, size)
    if tint:
        tint.bar([axes], below=flat)
    if style.titles:
        caption = _caption(subject, surface, lit=tint is None).splitlines()
        text = "\n".join(wrapped(line, width - MARGINS, sized(8.5)) for line in caption)
        figure.supxlabel(text, fontsize=sized(8.5), color=INK)
    return figure


def is_flat(box: tuple[float, float, float, float]) -> bool:
    """Whether a bar of colours beside a picture (left, right, low, high) would be short."""
    return box[3] - box[2] < FLAT * (box[1] - box[0])


def paint(axes: Axes, drawing: Drawing) -> None:
    """Draw the facets and lines of a ribbon into axes."""
    from matplotlib.collections import PolyCollection

    axes.add_collection(
        PolyCollection(
            list(drawing.corners),
            facecolors=drawing.faces,
            edgecolors=drawing.edges,
            linewidths=stroke(1) * drawing.line_widths,
            capstyle="round",
            joinstyle="round",
        ),
        autolim=False,
    )


def scale_bar(axes: Axes, box: tuple[float, float, float, float], size: float, unit: str) -> None:
    """Draw a bar of a round length, at most a quarter of `size`, below a box."""
    exponent = np.floor(np.log10(0.25 * size))
    length = max(k * 10**exponent for k in (1, 2, 5) if k * 10**exponent <= 0.25 * size)
    x, y = box[0] + 0.03 * size, box[2] + 0.03 * size
    axes.plot([x, x + length], [y, y], color=INK, lw=stroke(2), solid_capstyle="butt")
    label = f"{length:g}{unit}"
    axes.text(x + length / 2, y + 0.012 * size, label, ha="center", va="bottom", fontsize=sized(9))


def _triad(axes: Axes, camera: Camera, box: tuple[float, float, float, float], size: float) -> None:
    """Draw the lab's axes as seen, in the lower right corner."""
    origin = np.array([box[1] - 0.08 * size, box[2] + 0.055 * size])
    tips, heights = camera.project(np.eye(3))
    places: list[Array] = []
    for i in np.argsort(heights):
        if np.linalg.norm(tips[i]) < 0.2:
            continue
        tip = 0.045 * size * tips[i]
        axes.annotate(
            "",
            xy=(origin + tip).tolist(),
            xytext=origin.tolist(),
            arrowprops={"arrowstyle": "-|>", "color": FAINT, "lw": stroke(1)} | UNSHORTENED,
        )
        place = origin + tip * (1 + 0.25 / max(float(np.linalg.norm(tips[i])), 0.25))
        for other in places:
            way = place - other
            if np.linalg.norm(way) < 0.024 * size:  # letters would lie on one another
                side = np.array([-tip[1], tip[0]]) / np.linalg.norm(tip)
                place += 0.024 * size * (side if way @ side >= 0 else -side)
        places.append(place)
        axes.text(
            place[0],
            place[1],
            "xyz"[i],
            ha="center",
            va="center",
            fontsize=sized(9),
            color=FAINT,
            fontstyle="italic",
        )


def _caption(subject: Subject, surface: Surface, lit: bool) -> str:
    unit = " m" if subject.units.si else ""
    width = f"{surface.half_width:.3g}{unit}" + (" w(s)" if surface.tapers else "")
    if surface.half_width == subject.half_width:
        width += ", the ribbon's own,"
    across = "$d_2$" if subject.rod else r"generatrices $d_2 + \eta\, d_3$"
    lines = [f"drawn to the half-width {width} along {across}"]
    notes = []
    if subject.mirrored:
        notes.append(subject.rest + " (light)" * lit)
    if surface.bounded:
        notes.append(rf"$|\eta|$ drawn at most {ETA_BOUND:g}")
    if surface.crossing:
        notes.append("generatrices cross")
    if surface.leaps:
        reach = ETA_BOUND * surface.half_width / LEAP_SLOPE
        notes.append(rf"$\eta$ drawn smooth within {reach:.2g}{unit} of where it jumps")
    return "\n".join([*lines, *filter(None, [", ".join(notes), _arrows(subject)])])


def _arrows(subject: Subject) -> str:
    """Return what the longest arrows are, in words; "" if there is none."""
    acting, si = subject.acting, subject.units.si
    found = []
    if acting.largest > 0:
        found.append(f"force {acting.largest:.3g}{' N' * si}")
    if acting.strongest > 0:
        found.append(f"moment {acting.strongest:.3g}{' N m' * si}")
    if acting.densest > 0:
        found.append(f"force per length {acting.densest:.3g}{' N/m' * si}")
    return "arrows, the longest: " + ", ".join(found) if found else ""
