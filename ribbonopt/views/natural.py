"""The plane of strains of a ribbon with natural strains: what its sheets allow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .paper_style import stroke
from .style import ALLOWED, FAINT, FORBIDDEN, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

POINTS = 301


def shade_natural(axes: Axes, far: float, across: float) -> None:
    """Shade u3^2 <= u2^2 + K22 u2 outside of the disc u2^2 + u3^2 < K22 u2, up to a distance."""
    u3 = np.linspace(-far, far, POINTS)
    vertex = np.hypot(across / 2, u3)
    edge = max(2 * far, far + abs(across))
    label = r"$u_3^2 \leq u_2^2 + K_{22} u_2$, allowed"
    axes.axvspan(-edge, edge, color=FORBIDDEN, lw=0, zorder=0, label="forbidden to this ribbon")
    for side in (1, -1):
        u2 = -across / 2 + side * vertex
        x, y = [side * edge, *u2, side * edge], [-far, *u3, far]
        axes.fill(x, y, color=ALLOWED, lw=0, zorder=0.5, label=label if side > 0 else None)
        axes.plot(u2, u3, color=FAINT, lw=stroke(0.6), zorder=1)
    turn = np.linspace(0, 2 * np.pi, POINTS)
    disc = across / 2 * (1 + np.cos(turn)), across / 2 * np.sin(turn)
    axes.fill(*disc, color=FORBIDDEN, lw=0, zorder=0.6)
    axes.plot(*disc, color=FAINT, lw=stroke(0.6), zorder=1)
    axes.axhline(0, color=INK, lw=stroke(0.5), zorder=1)
    axes.axvline(0, color=INK, lw=stroke(0.5), zorder=1)
