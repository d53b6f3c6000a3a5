"""Thresholds of the sheared arch, in published units.

Shooting of symmetric halves, complex-step tangents, determinant of the block that breaks the
symmetry; two numbers of steps agree to the digits. A kink is no zero of that determinant but a jump
through zero: m2 at the clamp passes 0, m3 does not.
"""

from typing import NamedTuple

#: w / L by which rows of the study are named
WIDTHS = (1 / 30, 1 / 12, 1 / 6)
RIGID, BENDING, BOTH = "", "bending", "bending, stretching"


class Thresholds(NamedTuple):
    """Where the arch loses, and the level state regains, its symmetry; the digits that hold."""

    first: float
    second: float
    kink: bool = False
    digits: tuple[int, int] = (8, 8)


Key = tuple[str, str, float | None]

TRUTH: dict[Key, Thresholds] = {
    ("kirchhoff", RIGID, None): Thresholds(0.23377286, 0.35174678),
    ("sadowsky", RIGID, None): Thresholds(0.20048401, 0.30629257, kink=True),
    ("sano", RIGID, WIDTHS[0]): Thresholds(0.23385083, 0.35131166),
    ("sano", RIGID, WIDTHS[1]): Thresholds(0.23439840, 0.34028035),
    ("sano", RIGID, WIDTHS[2]): Thresholds(0.22729479, 0.3157755, True, (8, 7)),
    ("extensible", RIGID, WIDTHS[0]): Thresholds(0.23377431, 0.35119715),
    ("extensible", RIGID, WIDTHS[1]): Thresholds(0.23184408, 0.34014150),
    ("extensible", RIGID, WIDTHS[2]): Thresholds(0.22207723, 0.31842127, kink=True),
    ("kirchhoff", BENDING, WIDTHS[0]): Thresholds(0.31880444, 0.39547374),
    ("kirchhoff", BENDING, WIDTHS[1]): Thresholds(0.24741012, 0.35828795),
    ("kirchhoff", BENDING, WIDTHS[2]): Thresholds(0.23718664, 0.35336677),
    ("sano", BENDING, WIDTHS[0]): Thresholds(0.31915305, 0.39535085),
    ("sano", BENDING, WIDTHS[1]): Thresholds(0.25019247, 0.34812719),
    ("sano", BENDING, WIDTHS[2]): Thresholds(0.23501014, 0.3184291, True, (8, 7)),
    ("extensible", BENDING, WIDTHS[0]): Thresholds(0.31951989, 0.39563254),
    ("extensible", BENDING, WIDTHS[1]): Thresholds(0.24999628, 0.34982387),
    ("extensible", BENDING, WIDTHS[2]): Thresholds(0.23267912, 0.32225927, kink=True),
    ("kirchhoff", BOTH, WIDTHS[0]): Thresholds(0.31870749, 0.39524286),
    ("kirchhoff", BOTH, WIDTHS[1]): Thresholds(0.24730859, 0.35802521),
    ("kirchhoff", BOTH, WIDTHS[2]): Thresholds(0.23708383, 0.35309966),
    ("sano", BOTH, WIDTHS[0]): Thresholds(0.31905636, 0.39512018),
    ("sano", BOTH, WIDTHS[1]): Thresholds(0.25010507, 0.34787025),
    ("sano", BOTH, WIDTHS[2]): Thresholds(0.23501879, 0.3181937, True, (8, 7)),
    ("extensible", BOTH, WIDTHS[0]): Thresholds(0.31942249, 0.39540114),
    ("extensible", BOTH, WIDTHS[1]): Thresholds(0.24989723, 0.34955344),
    ("extensible", BOTH, WIDTHS[2]): Thresholds(0.23270002, 0.32201524, kink=True),
}

#: Wunderlich's ribbon by w / L, with u1 = 0: both thresholds and the unit to which each is known.
#: The first by the determinant of the equations with costates (two meshes); the second, which is
#: of first order in the elements at the middle, from three meshes. The energy form's count of
#: negative directions changes within 2e-6 of the first and 2e-5 of the second (w / L = 1 / 6).
WIDE: dict[float, tuple[tuple[float, float], tuple[float, float]]] = {
    WIDTHS[0]: ((0.25386468, 1e-8), (0.28114854, 2e-8)),
    WIDTHS[1]: ((0.19827227, 1e-8), (0.24538881, 2e-8)),
    WIDTHS[2]: ((0.14400900, 1e-8), (0.20653531, 2e-8)),
}
