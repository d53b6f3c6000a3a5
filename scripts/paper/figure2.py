"""Figure 2: Sadowsky's relations (2.4)-(2.5) as surfaces over the moments, two sheets each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from .numbers import Number
from .page import GREEN, ORANGE, Panel
from .relations import Array, on_arrays, sheet
from .space import Space

TITLE = "Figure 2   Inverting Sadowsky's constitutive relations"
VIEWS = (-128, -62)  # degrees: where both sheets are seen
REACH, CELLS = 6.0, 24  # of the moments shown; cells from 0 to it
EXAMPLE = (3.0, 4.0)  # moments at which both sheets are told


def panels() -> list[Panel]:
    """Return the two panels."""
    return [
        Panel("a", "bending strain", _surface(0), _bending(), solid=True),
        Panel("b", "twisting strain", _surface(1), _twisting(), solid=True),
    ]


def _patch(chi: int, side: int) -> tuple[Array, ...]:
    """Return m2, m3, u2, u3 of the sheet chi on the side of the sign of m2.

    The points are strains (u2, eta u2) of one sheet; the moments are worked out from them. The ray
    of moments at the angle phi from m2 has eta = tan(phi / 2): green where chi m2 >= 0.
    """
    m2, m3 = np.meshgrid(
        side * np.linspace(0, REACH, CELLS + 1),
        np.linspace(-REACH, REACH, 2 * CELLS + 1),
        indexing="ij",
    )
    size = np.hypot(m2, m3)
    eta = np.tan(np.arctan2(m3, chi * m2) / 2)
    defined = np.abs(eta) < 1e6  # not on the ray chi m2 < 0, m3 = 0, where u2 = u3 = 0
    eta = np.where(defined, eta, 1)
    u2 = np.where(defined, chi * size / (1 + eta**2) ** 2, 0)
    return m2, m3, u2, eta * u2


def _surface(component: int) -> Callable[[Any], None]:
    def draw(axes: Any) -> None:
        top = REACH + 0.3 if component == 0 else REACH / 2 + 0.15
        space = Space(
            np.array([[-REACH, REACH], [-REACH, REACH], [-top, top]]), 24, VIEWS[component]
        )
        for chi in (1, -1):
            for side in (1, -1):
                colour = GREEN if chi == side else ORANGE
                m2, m3, *u = _patch(chi, side)
                space.surface(m2, m3, u[component], colour, mesh=6)
        space.paint(axes, ("$m_2$", "$m_3$", ("$u_2$", "$u_3$")[component]))
        for label, colour, place in (
            (r"$|\eta| < 1$", GREEN, 0.97),
            (r"$|\eta| > 1$", ORANGE, 0.91),
        ):
            axes.text2D(0.03, place, "■", color=colour, transform=axes.transAxes, fontsize=11)
            axes.text2D(0.075, place, label, transform=axes.transAxes, fontsize=9)

    return draw


def both() -> tuple[Array, Array]:
    """Return the two strains (u2, u3), one on each sheet, that give the moments of the example."""
    upper, lower = (np.array(on_arrays(sheet(chi).strains, *EXAMPLE)) for chi in (1, -1))
    return upper, lower


def worst_round_trip() -> float:
    """Return the largest error of the inverse on the points shown, relative to the strain."""
    worst = 0.0
    for chi in (1, -1):
        for side in (1, -1):
            _, _, u2, u3 = _patch(chi, side)
            used = np.hypot(u2, u3) > 1e-9
            u = np.array([u2[used], u3[used]])
            m = on_arrays(sheet(chi).moments, *u)
            gap = np.array(on_arrays(sheet(chi).strains, *m)) - u
            worst = max(worst, float((np.hypot(*gap) / np.hypot(*u)).max()))
    return worst


def _bending() -> list[Number]:
    upper, lower = both()
    jump = [float(on_arrays(sheet(chi).strains, 0.0, EXAMPLE[1])[0]) for chi in (1, -1)]
    return [
        Number("$u_2$ at $m = (3, 4)$, green sheet", upper[0]),
        Number("$u_2$ at $m = (3, 4)$, orange sheet", lower[0]),
        Number("$u_2$ at $m = (0^+, 4)$, green", jump[0]),
        Number("$u_2$ at $m = (0^-, 4)$, green", jump[1]),
        Number(r"largest error of $u^*(m(u)) = u$", worst_round_trip()),
    ]


def _twisting() -> list[Number]:
    upper, lower = both()
    return [
        Number("$u_3$ at $m = (3, 4)$, green sheet", upper[1]),
        Number("$u_3$ at $m = (3, 4)$, orange sheet", lower[1]),
        Number(r"$\eta$ at $m = (3, 4)$, green sheet", upper[1] / upper[0]),
        Number(r"$\eta$ at $m = (3, 4)$, orange sheet", lower[1] / lower[0]),
        Number("$u_3$ at $m = (0, 4)$, both sheets", float(on_arrays(sheet(1).strains, 0, 4)[1])),
    ]
