"""What panels of figures 4 and 5 share."""

from __future__ import annotations

from typing import Any

from .page import FAINT, INK, PALE_GREEN, PALE_ORANGE

STRAINS = ((-14.5, 14.5), (-4.6, 7.2))  # limits of u2, u3


def label_strains(axes: Any) -> None:
    """Label a panel of strains along s."""
    axes.axhline(0, color=FAINT, lw=0.5)
    axes.set(xlim=(0, 1), ylim=(-14.5, 14.5), xlabel="arclength $s$  ($L$)")
    axes.set_ylabel("strains $u_2$, $u_3$  ($1/L$)")
    axes.legend(frameon=False, fontsize=8.5, loc="lower left")


def shade_plane(axes: Any) -> None:
    """Shade and label the plane of strains: green where |eta| <= 1, orange beyond."""
    for side in (1, -1):
        far = [0, 20 * side, 20 * side]
        axes.fill(far, [0, 20, -20], color=PALE_GREEN, lw=0, zorder=0)
        axes.fill([0, 20, -20], far, color=PALE_ORANGE, lw=0, zorder=0)
        axes.plot([-20, 20], [-20 * side, 20 * side], color=FAINT, lw=0.6, zorder=1)
    axes.set(xlim=STRAINS[0], ylim=STRAINS[1])
    axes.set(xlabel="bending strain $u_2$  ($1/L$)", ylabel="twisting strain $u_3$  ($1/L$)")
    axes.text(14, -4.3, r"$|\eta| \leq 1$", ha="right", fontsize=8.5, color=INK)
    axes.text(0, 6.6, r"$|\eta| > 1$", ha="center", fontsize=8.5, color=INK)
