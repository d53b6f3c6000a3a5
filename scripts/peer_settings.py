"""Settings with which peers are timed: a ladder of errors for every ribbon and number of states.

They are tuned with the answer in view: of many meshes and tolerances those stand here that reached
an error most quickly, whatever the peer's own estimate says. Ours have none of that.
"""

from __future__ import annotations

from typing import Any

from peer_casadi import IPOPT, NEWTON
from peer_states import Ribbon

SCIPY, AUTO, COLNEW = "scipy solve_bvp", "AUTO", "COLNEW"
HALF = Ribbon(False), Ribbon(False, 18)
WHOLE = Ribbon(True), Ribbon(True, 18)


def _both(ribbons: tuple[Ribbon, Ribbon], settings: list[Any]) -> dict[Ribbon, list[Any]]:
    """Return the same settings for both numbers of states."""
    return {ribbon: settings for ribbon in ribbons}


# stages, intervals of the first mesh, tolerance
_COLNEW: dict[Ribbon, list[tuple[int, int, float]]] = {
    HALF[0]: [
        *((4, 2, 1e-2), (5, 2, 1e-2), (4, 3, 1e-2), (5, 3, 1e-2), (6, 3, 1e-2), (5, 5, 1e-2)),
        *((5, 6, 1e-2), (7, 4, 1e-4), (6, 6, 1e-4), (6, 8, 1e-4)),
    ],
    HALF[1]: [
        *((4, 2, 1e-3), (5, 2, 1e-2), (4, 4, 1e-3), (5, 4, 1e-2), (4, 8, 1e-2), (7, 4, 1e-3)),
        (6, 8, 1e-3),
    ],
    WHOLE[0]: [
        *((5, 2, 1e-2), (5, 2, 1e-3), (6, 4, 1e-5), (5, 4, 1e-5), (4, 6, 1e-5), (4, 4, 1e-5)),
        *((3, 6, 3e-6), (4, 6, 3e-6), (3, 6, 1e-7), (4, 4, 1e-7), (4, 4, 3e-8), (5, 4, 1e-8)),
        (4, 8, 1e-10),
    ],
    WHOLE[1]: [
        *((4, 4, 1e-3), (4, 4, 1e-4), (5, 4, 1e-5), (5, 16, 1e-2), (5, 24, 1e-3), (4, 4, 1e-6)),
        *((5, 24, 1e-6), (5, 6, 1e-7), (4, 8, 1e-7), (5, 4, 1e-8)),
    ],
}
# intervals, stages, tolerance, steps to the closed end
_AUTO: dict[Ribbon, list[tuple[int, int, float, int]]] = {
    HALF[0]: [
        *((4, 4, 1e-8, 1), (5, 5, 1e-8, 1), (6, 5, 1e-8, 1), (6, 6, 1e-6, 1), (8, 5, 1e-8, 1)),
        *((10, 5, 1e-8, 1), (16, 5, 1e-6, 1)),
    ],
    HALF[1]: [
        *((4, 4, 1e-8, 1), (4, 5, 1e-8, 1), (4, 6, 1e-6, 1), (6, 5, 1e-8, 1), (6, 6, 1e-8, 1)),
        (8, 6, 1e-6, 1),
    ],
    WHOLE[0]: [(16, 3, 1e-8, 2), (32, 3, 1e-8, 3), (64, 3, 1e-8, 3), (64, 5, 1e-8, 2)],
    WHOLE[1]: [(16, 3, 1e-8, 2), (64, 3, 1e-8, 2), (96, 4, 1e-8, 2), (64, 6, 1e-8, 2)],
}
# intervals, degree, tolerance of the solver
_NEWTON = {
    **_both(HALF, [(6, 3, 1e-7), (6, 4, 1e-7), (6, 6, 1e-9), (8, 6, 1e-10)]),
    **_both(WHOLE, [(6, 4, 1e-7), (16, 4, 1e-7), (16, 6, 1e-9), (32, 6, 1e-9)]),
}
_IPOPT = {
    **_both(HALF, [(n, 3, 1e-10) for n in (6, 10, 20, 40, 80)]),
    **_both(WHOLE, [(n, 3, 1e-10) for n in (6, 10, 20, 40, 80)]),
}
# of solve_bvp's residuals; the last of the half ribbon takes seconds
_SCIPY = {
    **_both(HALF, [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9]),
    **_both(WHOLE, [1e-3, 1e-4, 1e-5, 1e-6, 1e-7]),
}
SETTINGS: dict[str, dict[Ribbon, list[Any]]] = {
    COLNEW: _COLNEW,
    AUTO: _AUTO,
    NEWTON: _NEWTON,
    IPOPT: _IPOPT,
    SCIPY: _SCIPY,
}
# Along the branch of the half ribbon in epsilon, by the number of states: for errors at its end of
# about 2e-9 (AUTO on 18 states 6e-9).
BRANCH: dict[str, dict[int, Any]] = {
    COLNEW: {13: (7, 8, 1e-8), 18: (5, 8, 1e-7)},
    AUTO: {13: (24, 4, 1e-8, 1), 18: (16, 6, 1e-8, 1)},
    SCIPY: {13: 1e-6, 18: 1e-6},
}
