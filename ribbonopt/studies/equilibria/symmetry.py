"""What leaves an equilibrium as it is, in words: read from its strains along the ribbon."""

from __future__ import annotations

import numpy as np

from ribbonopt.solution.solution import Solution
from ribbonopt.starts.equilibria import Described

#: signs of (u2, u3), whether s is reversed too, and what that is of a ribbon in space
OPERATIONS = (
    ((1, 1), True, "half a turn about d1 in the middle"),
    ((-1, 1), True, "half a turn about d2 in the middle"),
    ((1, -1), True, "reflection across the middle"),
    ((-1, -1), True, "inversion at the middle"),
    ((1, -1), False, "reflection in its plane"),
)
IN_PLANE = {
    ((1, 1), True): "reflection across the middle",
    ((-1, 1), True): "half a turn about the middle",
}


def symmetry_of(solution: Solution, gap: float) -> str:
    """Return what maps an equilibrium to itself, in words, "" for nothing; `gap` is relative.

    Of a ribbon that stays in a plane within that; of a closed one nothing is told.
    """
    if solution.scene.boundary.loop is not None:
        return ""
    strains = Described(solution).strains
    size = float(np.abs(strains).max())
    if size == 0:
        return "straight"

    def maps(signs: tuple[int, int], reverse: bool) -> bool:
        image = strains * np.array([1, *signs])[:, None]
        image = image[:, ::-1] if reverse else image
        return float(np.sqrt(np.mean((strains - image) ** 2))) <= gap * size

    flat = maps((1, -1), False)
    names = IN_PLANE if flat else {(s, r): name for s, r, name in OPERATIONS}
    found = [name for (signs, reverse), name in names.items() if maps(signs, reverse)]
    return ", ".join(found)
