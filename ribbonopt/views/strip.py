"""Ribbons in rows, such as those along a branch: to one scale, in one view."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ribbonopt.solution.solution import Solution

from .album import album_of, place
from .lettering import wrapped
from .paper_style import PLAIN, USUAL, Style, sized
from .ribbon import scale_bar
from .style import FAINT, INK, blank

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURE, ROW, TALLEST, NARROWEST = 3.0, 14.0, 3.2, 1.7  # inches
MOST = 6  # pictures in a row
THIN = 0.6  # lines of small pictures, of the width of others
APART = 0.1  # inches between captions


def plot_strip(
    ribbons: Sequence[Solution], captions: Sequence[str], style: Style = PLAIN
) -> Figure:
    """Draw ribbons in rows, to one scale, in one view of one frame; bands whole."""
    album = album_of(ribbons, style)
    box, count = album.box(), len(ribbons)
    tall = (box.high - box.low) / (box.right - box.left)
    size = style.type_size / USUAL
    most = MOST if style.width is None else max(2, int(style.width / (NARROWEST * size)))
    rows = -(-count // most)
    columns = -(-count // rows)
    width = max(min(PICTURE, ROW / columns, TALLEST / tall), NARROWEST)
    if style.width is not None:
        width = style.width / columns
    texts = [
        "\n".join(wrapped(line, width - APART, sized(9)) for line in caption.splitlines())
        for caption in captions
    ]
    below = size * (0.4 + 0.17 * max(text.count("\n") for text in texts))
    height = min(width * tall, TALLEST) + below
    figure = blank(style.width or max(width * columns, 3.4), rows * height + 0.2 * size, style)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels[count:]:
        axes.remove()
    for axes, drawing, text in zip(panels, album.drawings, texts, strict=False):
        place(axes, drawing, box, THIN)
        axes.set_xlabel(text, fontsize=sized(9), color=INK)
    scale_bar(panels[0], box, album.size, " m" if album.subjects[0].units.si else "")
    if album.tint:
        album.tint.bar(list(panels[:count]), below=rows == 1)
    if style.titles:
        note = "; light: by symmetry" if album.mirrored and not album.tint else ""
        figure.supxlabel(f"one scale, one view{note}", fontsize=sized(8.5), color=FAINT)
    return figure
