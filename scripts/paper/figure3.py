"""Figure 3: Sadowsky's energy W_S(u2, u3), eq. (2.8), and the convexified W_F.

In polar coordinates of the strains W_S = r^2 / (2 cos^2 psi): its level sets are circles that touch
the axis u2 = 0 at the origin, two for each level, and those of W_F the hulls of both.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .numbers import Number
from .page import BENDING, FAINT, GREEN, INK, ORANGE, PALE_GREEN, PALE_ORANGE, Panel
from .relations import SADOWSKY, Array, on_arrays, sheet
from .space import Space

TITLE = "Figure 3   Sadowsky's energy, and its level sets"
LEVELS = np.array([0.5, 1.0, 2.0, 3.0, 4.0])
CONVEX = 2.0  # the level of W_F that is drawn
REACH = 3.0  # of the strains, in the plane


def panels() -> list[Panel]:
    """Return the two panels."""
    return [
        Panel("a", "energy surface $W_S(u_2, u_3)$", _surface, _levels(), solid=True),
        Panel("b", "level sets; dashed, one of the convexified $W_F$", _plane, _convex()),
    ]


def level(W: float, side: int, psi: Array) -> tuple[Array, Array]:
    """Return the strains (u2, u3) of a level set of W_S, on one side, at angles psi (k,)."""
    r = np.sqrt(2 * W) * np.cos(psi)
    return side * r * np.cos(psi), r * np.sin(psi)


def _surface(axes: Any) -> None:
    top = float(LEVELS[-1])
    wide, high = np.sqrt(2 * top) * 1.02, np.sqrt(top / 2) * 1.1
    limits = np.array([[-wide, wide], [-high, high], [0, top]])
    space = Space(limits, 34, -64, aspect=(1.25, 0.85, 0.8))
    heights = np.linspace(0, 1, 41) ** 2 * top
    quarter = np.pi / 4
    for side in (1, -1):
        for low, end, colour in (
            (-quarter, quarter, GREEN),
            (quarter, 2 * quarter, ORANGE),
            (-2 * quarter, -quarter, ORANGE),
        ):
            W, psi = np.meshgrid(heights, np.linspace(low, end, 37), indexing="ij")
            r = np.sqrt(2 * W) * np.cos(psi)
            space.surface(side * r * np.cos(psi), r * np.sin(psi), W, colour)
        for W in LEVELS:
            u = level(float(W), side, np.linspace(-np.pi / 2, np.pi / 2, 181))
            space.curve(*u, W, "black", 0.8, lift=0.035)
    space.paint(axes, ("$u_2$", "$u_3$", "$W_S$"))


def _plane(axes: Any) -> None:
    for side in (1, -1):
        far = np.array([0, 2 * side * REACH, 2 * side * REACH])
        across = np.array([0, 2 * REACH, -2 * REACH])
        axes.fill(far, across, color=PALE_GREEN, lw=0, zorder=0)
        axes.fill(across, far, color=PALE_ORANGE, lw=0, zorder=0)
        axes.plot([-REACH, REACH], [-side * REACH, side * REACH], color=FAINT, lw=0.6)
        for W in LEVELS:
            u2, u3 = level(float(W), side, np.linspace(-np.pi / 2, np.pi / 2, 361))
            axes.plot(u2, u3, color=INK, lw=0.9)
            if side > 0:
                axes.annotate(
                    f"{W:g}",
                    (np.sqrt(2 * W), 0),
                    (1, 0),
                    textcoords="offset points",
                    fontsize=7.5,
                    va="center",
                    bbox={"boxstyle": "square,pad=0.05", "fc": PALE_GREEN, "ec": "none"},
                )
    half = np.sqrt(CONVEX / 2)
    for sign in (1, -1):
        axes.plot([-half, half], [sign * half] * 2, color=BENDING, lw=2, ls=(0, (4, 2)))
    axes.plot([], [], color=INK, lw=0.9, label="$W_S$ constant (values on the right)")
    axes.plot([], [], color=BENDING, lw=2, ls=(0, (4, 2)), label=f"$W_F = {CONVEX:g}$")
    axes.set(xlim=(-3.15, 3.15), ylim=(-1.95, 2.5), aspect="equal")
    axes.set(xlabel="bending strain $u_2$  ($1/L$)", ylabel="twisting strain $u_3$  ($1/L$)")
    axes.legend(loc="upper center", ncols=2, fontsize=8.5, edgecolor="none", framealpha=0.9)


def worst_level() -> float:
    """Return the largest error of W_S on the level sets drawn."""
    psi = np.linspace(-1.5, 1.5, 301)
    gaps = [
        on_arrays(sheet(side).stored, *level(float(W), side, psi))[0] - W
        for side in (1, -1)
        for W in LEVELS
    ]
    return float(np.abs(gaps).max())


def least_at_twist(u3: float) -> tuple[float, float]:
    """Return the bending u2 > 0 of least W_S at a twist, and that energy, by a fine search."""
    u2 = np.linspace(0.2, 3, 28001) * u3
    W = on_arrays(sheet(1).stored, u2, u3)[0]
    return float(u2[W.argmin()]), float(W.min())


def _levels() -> list[Number]:
    return [
        Number("$W_S$ at $u = (1, 1/2)$", float(on_arrays(sheet(1).stored, 1.0, 0.5)[0])),
        Number("$W_S$ at $u = (1, 1)$, the border", float(on_arrays(sheet(1).stored, 1.0, 1.0)[0])),
        Number(
            "$W_S$ at $u = (1/2, 1)$, forbidden", float(on_arrays(sheet(1).stored, 0.5, 1.0)[0])
        ),
        Number(r"largest error of $W_S$ on the levels", worst_level()),
    ]


def _convex() -> list[Number]:
    u2, least = least_at_twist(1.0)
    relaxed = float(on_arrays(SADOWSKY.stored, 0.5, 1.0)[0])
    return [
        Number(r"$u_2/u_3$ of least $W_S$ at a given $u_3$", u2, "1"),
        Number(r"that energy over $u_3^2$", least, "2"),
        Number("$W_F$ at $u = (1/2, 1)$: $2 u_3^2$", relaxed, "2"),
        Number(r"radius of the level $W_S = 2$: $\sqrt{W/2}$", float(np.sqrt(CONVEX / 2))),
    ]
