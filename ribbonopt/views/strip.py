"""Ribbons in rows, such as those along a branch: to one scale, in one view."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.solution.solution import Solution

from .camera import place_camera
from .facets import SEAM, draw_surface
from .ribbon import paint, scale_bar
from .style import FAINT, INK, blank
from .subject import subject_of
from .surface import sweep

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURE, ROW, TALLEST, NARROWEST = 3.0, 14.0, 3.2, 1.7  # inches
MOST = 6  # pictures in a row


def plot_strip(ribbons: Sequence[Solution], captions: Sequence[str]) -> Figure:
    """Draw ribbons in rows, to one scale, in one view of one frame; bands whole."""
    subjects = [subject_of(solution, complete=True) for solution in ribbons]
    lines = [np.concatenate([p.r for p in subject.pieces]) for subject in subjects]
    camera = place_camera(
        np.concatenate([line - line.mean(axis=0) for line in lines]),
        np.concatenate([p.d1 for subject in subjects for p in subject.pieces]),
    )
    usual = min(sweep(subject.pieces).half_width for subject in subjects)
    drawings = [draw_surface(sweep(s.pieces, s.drawn or usual), camera) for s in subjects]
    corners = np.concatenate([drawing.corners.reshape(-1, 2) for drawing in drawings])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    size = max(right - left, (high - low) / 2)
    box = (left - 0.04 * size, right + 0.04 * size, low - 0.2 * size, high + 0.04 * size)
    tall = (box[3] - box[2]) / (box[1] - box[0])
    rows = -(-len(subjects) // MOST)
    columns = -(-len(subjects) // rows)
    width = max(min(PICTURE, ROW / columns, TALLEST / tall), NARROWEST)
    fill = textwrap.TextWrapper(round(13 * width)).fill
    texts = ["\n".join(map(fill, caption.splitlines())) for caption in captions]
    below = 0.4 + 0.17 * max(text.count("\n") for text in texts)
    height = min(width * tall, TALLEST) + below
    figure = blank(max(width * columns, 3.4), rows * height + 0.2)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in panels[len(subjects) :]:
        axes.set_axis_off()
    for axes, drawing, text in zip(panels, drawings, texts, strict=False):
        paint(axes, replace(drawing, line_widths=np.maximum(0.6 * drawing.line_widths, SEAM)))
        axes.set(xlim=box[:2], ylim=box[2:], aspect="equal", xticks=[], yticks=[])
        axes.spines[:].set_visible(False)
        axes.set_xlabel(text, fontsize=9, color=INK)
    scale_bar(panels[0], box, size, " m" if subjects[0].units.si else "")
    note = "; light: by symmetry" if any(subject.mirrored for subject in subjects) else ""
    figure.supxlabel(f"one scale, one view{note}", fontsize=8.5, color=FAINT)
    return figure
