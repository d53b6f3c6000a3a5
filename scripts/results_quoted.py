"""Figures of peers that were told, not measured here: quoted on the page of results as such.

One quiet run on another machine, CPU ms and errors, as they stand in this project's design notes.
"""

from __future__ import annotations

Quote = list[tuple[float, float]]  # ms, error
# name: half ribbon, whole ribbon
QUOTED: dict[str, tuple[Quote, Quote]] = {
    "COLNEW, 13 states": (
        [(1.0, 2e-8), (1.4, 1e-10), (2.8, 2e-13)],
        [(9.8, 2e-7), (21.6, 2e-11), (24.7, 7e-13)],
    ),
    "COLNEW, 18 states": ([(3.3, 3e-10), (6.6, 4e-13)], []),
    "AUTO, 13 states": ([(9.9, 4e-10)], []),
    "CasADi rootfinder, 13 states": ([(5.2, 2e-10)], []),
    "scipy solve_bvp, 13 states": ([(85, 2e-9), (667, 4e-12)], []),
    "ribbonopt with its bar, 13 states": ([(5.3, 5e-10), (6.2, 3e-13)], [(26, 3e-11), (33, 3e-14)]),
}
# Branch of the half ribbon, epsilon from 0.1 to 1e-4, 21 points: seconds, error at its end.
QUOTED_BRANCH: dict[str, tuple[str, float]] = {
    "COLNEW, 13 states": ("0.14", 3e-12),
    "AUTO, 13 states": ("0.18", 5e-10),
    "ribbonopt": ("0.19 to 0.25", 6e-11),
}
