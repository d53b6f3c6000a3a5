"""Figure: modes of small vibrations, each a ribbon at several moments of its motion."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.checks.modes import Modes
from ribbonopt.errors import ViewError
from ribbonopt.output.modes_rows import HERTZ, plane_of, rows_of, value_of, which_of
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution
from ribbonopt.text import drawn

from .album import BESIDE, Box, place
from .camera import Camera, camera_for
from .facets import HAZE, Drawing, faded, parts_of, sorted_far
from .lettering import wrapped
from .moved import amplitude_of, moved, subject_with
from .paper_style import PAGE, PLAIN, Style, sized, spaced
from .pieces import Array
from .style import FAINT, INK, SI, SPECIAL, TITLE, Drawn, blank, draw_all
from .subject import Subject
from .surface import Surface, sweep
from .tint import check_field

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OMEGA = r"\omega"
MOST = 24  # modes on a sheet
ACROSS, NARROW_ACROSS = 4, 2  # panels side by side
ROWS = 121  # of a ribbon: there are many
Phase = tuple[float, float]  # a share of the amplitude, and how far it is faded to white
PHASES: tuple[Phase, ...] = ((1.0, 0.0), (0.5, 0.66), (0.0, 0.78), (-0.5, 0.66), (-1.0, 0.4))
OF_BANDS: tuple[Phase, ...] = ((1.0, 0.0), (0.0, 0.8), (-1.0, 0.5))
NARROWER = 0.5  # half-width of bands, over the one that they are drawn to by themselves
WORDS = 0.16  # inches of a line under a panel
MARGIN = 0.2  # inches about a panel
ENOUGH = 2e-6  # relative error of a number that is read in a figure
THIN = 0.6  # lines of a panel over those of a figure of its own
FLATTEST = 0.3  # height of a panel over its width, at least,
TALLEST = 1.1  # and at most


def save_modes_figure(
    solution: Solution, modes: Modes, folder: str | Path, style: Style = PLAIN
) -> Drawn:
    """Write modes.png, or as the style says, into an existing folder."""
    drawings = {"modes.png": partial(draw_modes, solution, modes, style)}
    return draw_all(drawings, Path(folder), style)


def plot_modes(solution: Solution, modes: Modes, style: Style = PLAIN) -> Figure:
    """Draw modes of a solution.

    Parameters
    ----------
    solution, modes
        An equilibrium and its modes; the first 24 are drawn.
    style
        Size, type, camera, half-width and colours.

    Raises
    ------
    ViewError
        If there is no mode.
    """
    with style.applied():
        return draw_modes(solution, modes, style)


def draw_modes(solution: Solution, modes: Modes, style: Style = PLAIN) -> Figure:
    """Draw a panel for each mode: the ends of its motion, what is between them faded."""
    rows = rows_of(solution, modes)[:MOST]
    if not rows:
        raise ViewError(f"{solution.scene.name}: there are no modes to draw")
    check_field(style.color)
    subject = subject_with(solution, modes, ROWS)
    surface = sweep(subject.pieces, style.half_width or subject.drawn)
    phases = OF_BANDS if surface.closed else PHASES
    narrower = surface.closed and style.half_width is None
    half_width = (NARROWER if narrower else 1.0) * surface.half_width
    swept = [_swept(subject, modes, i, half_width, phases) for i in range(len(rows))]
    camera = _camera(style.camera, subject, swept)
    drawings = [_drawing(surfaces, camera, phases) for surfaces in swept]
    box = _box(drawings)
    across = min(len(rows), NARROW_ACROSS if style.narrow else ACROSS)
    down = -(-len(rows) // across)
    width = style.width or PAGE
    tall = np.clip((box.high - box.low) / (box.right - box.left), FLATTEST, TALLEST)
    room = width / across - spaced(MARGIN)
    words = [_caption(row, modes.unit, room) for row in rows]
    lines = 1 + max(text.count("\n") for text in words)
    panel = room * tall + spaced(MARGIN + WORDS * lines)
    figure = blank(width, down * panel + spaced(0.5) * style.titles, style)
    panels = figure.subplots(down, across, squeeze=False)
    for axes in panels.flat[len(rows) :]:
        axes.set_axis_off()
    for axes, drawing, text in zip(panels.flat, drawings, words, strict=False):
        place(axes, drawing, box, THIN)
        axes.set_xlabel(text, fontsize=sized(8.5), color=INK)
    if style.titles:
        _title(figure, subject, modes.unit)
        which = wrapped(which_of(solution, modes), width - MARGIN, sized(8.5))
        figure.supxlabel(which, fontsize=sized(8.5), color=INK)
    return figure


def _swept(
    subject: Subject, modes: Modes, number: int, half_width: float, phases: Sequence[Phase]
) -> list[Surface]:
    """Return the ribbon at the phases of its motion."""
    most = amplitude_of(subject, modes, number)
    return [
        sweep(moved(subject, modes, number, share * most).pieces, half_width) for share, _ in phases
    ]


def _camera(said: str, subject: Subject, swept: Sequence[Sequence[Surface]]) -> Camera:
    """Return one view for all: of the ribbon at rest and at the ends of its motions."""
    pieces = [sheet.piece for surfaces in swept for s in (0, -1) for sheet in surfaces[s].sheets]
    pieces += [*subject.pieces] * len(swept)
    line, normals = (np.concatenate([getattr(p, name) for p in pieces]) for name in ("r", "d1"))
    return camera_for(said, line, normals)


def _drawing(surfaces: Sequence[Surface], camera: Camera, phases: Sequence[Phase]) -> Drawing:
    """Return all phases in one picture, those that are less faded over the others."""
    order = np.argsort([-paler for _, paler in phases], kind="stable")
    layers = []
    for i in order:
        parts = [faded(part, phases[i][1]) for part in parts_of(surfaces[i], camera)]
        layers.append(sorted_far(parts, HAZE))
    return Drawing(*(np.concatenate(parts) for parts in zip(*map(_parts, layers), strict=True)))


def _parts(drawing: Drawing) -> tuple[Array, Array, Array, Array]:
    return drawing.corners, drawing.faces, drawing.edges, drawing.line_widths


def _box(drawings: Sequence[Drawing]) -> Box:
    corners = np.concatenate([drawing.corners.reshape(-1, 2) for drawing in drawings])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    room = BESIDE * max(right - left, high - low)
    return Box(left - room, right + room, low - room, high + room)


def _caption(row: Row, unit: str, width: float) -> str:
    """Return what stands under a mode, in lines of a width (inches): frequency, where it moves."""
    value = value_of(row, unit, ENOUGH)
    if row["grows"]:
        value = f"grows, {value}"
    else:
        value = f"${'f' if unit == HERTZ else OMEGA}$ = {value}"
    words = ", ".join(filter(None, (plane_of(row), row["symmetry"])))
    told = [f"{row['number']}   {value}", *([wrapped(words, width, sized(8.5))] if words else [])]
    return "\n".join(told)


def _title(figure: Figure, subject: Subject, unit: str) -> None:
    words = f"{drawn(subject.name, TITLE)}: small vibrations"
    figure.suptitle(words, x=0.01, ha="left", fontsize=sized(11), fontweight="bold")
    units = SI if subject.units.si else SPECIAL
    units += "" if unit == HERTZ else r", $\omega$ over $\sqrt{Dw/(\rho L^4)}$"
    figure.text(0.99, 0.985, units, ha="right", va="top", fontsize=sized(8.5), color=FAINT)
