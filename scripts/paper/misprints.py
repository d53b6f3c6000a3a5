"""The misprints of the paper: each as printed and mended, with one number that tells which holds.

The number is an error: large as printed, rounding (or the bar of the solution) as mended. The
second list is of what is no misprint but misleads.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .found import MIDDLE, Answers, Found, half_of
from .numbers import write_columns
from .relations import Array, on_arrays, sheet


class Misprint(NamedTuple):
    """One misprint.

    Attributes
    ----------
    place
        Equation or section.
    printed, mended
        In words.
    measure
        What the two numbers are.
    as_printed, as_mended
        The numbers.
    """

    place: str
    printed: str
    mended: str
    measure: str
    as_printed: float
    as_mended: float


def misprints(found: Found) -> list[Misprint]:
    """Demonstrate all of them."""
    return [
        half_ends(found),
        whole_ends(found),
        legendre(found),
        sheets(),
        hamiltonian(found),
        twist_at_seam(found),
    ]


def half_ends(found: Found) -> Misprint:
    """(5.1): x, y where it must be y, z."""
    x, y, z = (float(value) for value in found.sadowsky.sample(MIDDLE, "r"))
    return Misprint(
        "(5.1)",
        "r(1/2).e_i = 0 for i = x, y",
        "for i = y, z",
        "what the ends leave of r(1/2) on the ribbon with the n(0), m(0) of the paper",
        abs(x) + abs(y),
        abs(y) + abs(z),
    )


def whole_ends(found: Found) -> Misprint:
    """(6.2): eight end frames; the ribbon found from nothing is a flat ring."""
    ring, band = found.printed_whole, found.regularized
    turned = np.diag([-1.0, -1.0, 1.0])
    gaps = []
    for solution in (ring, band):
        frames = [np.array([solution.sample(s, d) for d in ("d1", "d2", "d3")]) for s in (0.0, 1.0)]
        gaps.append(float(np.abs(frames[1] - turned @ frames[0]).max()))
    return Misprint(
        "(6.2)",
        "d1(1).d2(0) = d2(1).d3(0) = d3(1).d1(0) = 0",
        "d1(1) = -d1(0), d2(1) = -d2(0), d3(1) = d3(0)",
        "distance of the end frame from that of a Moebius ribbon, of what the ends lead to",
        *gaps,
    )


def legendre(found: Found) -> Misprint:
    """(7.2): both roots are of m2^2 + m3^2; H = W_Leg + n3 tells, along the ribbon."""
    rows = half_of(found.sadowsky)
    n3 = found.sadowsky.sample(rows.s, "n3")
    size = np.hypot(rows.m2, rows.m3)
    printed, mended = ((first + size) ** 2 / 8 + n3 for first in (size, np.abs(rows.m2)))
    return Misprint(
        "(7.2)",
        "W_Leg = (sqrt(m2^2 + m3^2) + sqrt(m2^2 + m3^2))^2 / 8",
        "the first root is sqrt(m2^2) = |m2|",
        "drift of H = W_Leg + n3 along the ribbon of figure 4",
        float(np.ptp(printed)),
        float(np.ptp(mended)),
    )


def branch(m2: Array, m3: Array, chi: int, sign: int) -> tuple[Array, Array]:
    """Return (u2, u3) of (B 1) with a sign of m2 chi in the denominators: + as printed."""
    size = np.hypot(m2, m3)
    bottom = size**2 + sign * m2 * chi * size
    return chi / 4 * m3**4 * size / bottom**2, m3**3 / bottom / 4


def sheets() -> Misprint:
    """(B 1): the sign of m2 chi in the denominators; back to the moments by (2.4), (2.5)."""
    m2, m3 = (grid.ravel() for grid in np.meshgrid([-5.0, -2, 1, 4], [-3.0, -1, 2, 6]))
    gaps = []
    for sign in (1, -1):
        gap = 0.0
        for chi in (1, -1):
            back = on_arrays(sheet(chi).moments, *branch(m2, m3, chi, sign))
            gap = max(gap, float(np.abs(np.array(back) - [m2, m3]).max()))
        gaps.append(gap)
    return Misprint(
        "(B 1)",
        "m2^2 + m3^2 + m2 chi sqrt(m2^2 + m3^2) in the denominators",
        "m2^2 + m3^2 - m2 chi sqrt(m2^2 + m3^2)",
        "largest error of m(u(m)) = m by (2.4), (2.5) on a grid of moments",
        *gaps,
    )


def hamiltonian(found: Found) -> Misprint:
    """Section 7: H = 57.5, as follows from the rounded n(0), m(0); it is 57.4495."""
    H = Answers(found.sadowsky).value("H0")
    m2, m3, n3 = 2.01, -8.87, 42.1  # as printed
    rounded = (abs(m2) + np.hypot(m2, m3)) ** 2 / 8 + n3
    return Misprint(
        "section 7",
        "H = 57.5",
        "H = 57.4 (57.4495); 57.5 follows from n(0), m(0) rounded as printed",
        "distance from the H of the ribbon: of that of the printed loads, and of 57.4495",
        float(abs(rounded - H)),
        float(abs(57.4495 - H)),
    )


def twist_at_seam(found: Found) -> Misprint:
    """Section 5: u_i(1) = -u_i(0) for i = 1, 2 is said of bending and twist; u3 does not jump."""
    u3 = found.regularized.sample([0.0, 1.0], "u3")
    return Misprint(
        "section 5, last but one paragraph",
        "jump of the bending and twisting strains, u_i(1) = -u_i(0), i = 1, 2",
        "of the bending strains; u3(1) = u3(0)",
        "|u3(1) + u3(0)| and |u3(1) - u3(0)|",
        float(abs(u3[1] + u3[0])),
        float(abs(u3[1] - u3[0])),
    )


def write_misprints(rows: Sequence[Misprint], folder: Path) -> None:
    """Write `misprints.json` and `misprints.csv` into a folder."""
    text = json.dumps([row._asdict() for row in rows], indent=1)
    (folder / "misprints.json").write_text(text + "\n", encoding="utf-8")
    columns = {name: [getattr(row, name) for row in rows] for name in Misprint._fields}
    write_columns(columns, folder / "misprints.csv")
