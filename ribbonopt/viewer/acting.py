"""What acts on a ribbon as arrows of a page: places, and vectors of which the longest is 1."""

from __future__ import annotations

from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.views.acting import Acting
from ribbonopt.views.shape import Shape

AGAINST = -0.5  # cosine to what leads away from an end, below which arrows end there
NOTHING = 1e-12  # of the largest: what is zero
DIGITS = 6


def arrows_of(acting: Acting, shape: Shape) -> list[dict[str, Any]]:
    """Return arrows of forces, moments and forces per length, each with its share of the largest.

    `at` is the place on the centre line, `way` the vector (lab frame), `kind` one of "force",
    "moment" and "density"; one that presses on an end has `press`.
    """
    found = []
    for site in acting.sites:
        for kind, vector, most in (
            ("force", site.force, acting.largest),
            ("moment", site.moment, acting.strongest),
        ):
            if np.linalg.norm(vector) > NOTHING * most:
                found.append(_arrow(shape, site.at, vector / most, kind, site.outward))
    for force in acting.along:
        scaled = force / acting.densest
        rows = zip(acting.s, scaled, strict=True)
        found += [_arrow(shape, s, f, "density", 0) for s, f in rows if np.linalg.norm(f) > NOTHING]
    return found


def longest(acting: Acting, si: bool) -> list[tuple[str, str]]:
    """Return in words what the longest arrow of each kind is."""
    sizes = {
        f"force {acting.largest:.3g}{' N' * si}": acting.largest,
        f"moment {acting.strongest:.3g}{' N m' * si}": acting.strongest,
        f"force per length {acting.densest:.3g}{' N/m' * si}": acting.densest,
    }
    found = ", ".join(text for text, size in sizes.items() if size > 0)
    return [("longest arrows", found)] if found else []


def _arrow(shape: Shape, s: float, way: Array, kind: str, outward: int) -> dict[str, Any]:
    row = int(np.abs(shape.s - s).argmin())
    press = kind == "force" and outward * float(shape.d3[row] @ way) < AGAINST * np.linalg.norm(way)
    return {
        "at": [float(f"{x:.{DIGITS}g}") for x in shape.r[row]],
        "way": [float(f"{x:.{DIGITS}g}") for x in way],
        "kind": kind,
        "press": bool(press),
    }
