"""`solve`: one scene as it asks to be solved, for one equilibrium or for all of them."""

from __future__ import annotations

from ribbonopt.pipeline import prepared
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution


def solve(scene: Scene) -> Solution:
    """Solve a scene: the whole path once, from as many `starts`, or for all its `equilibria`.

    Of several distinct equilibria the one of least energy is returned, with `others`.

    Raises
    ------
    ModelError
        If the conditions do not fit the unknowns.
    ConvergenceError
        If the prescribed ends cannot be reached. A solve that merely fails to converge returns a
        Solution whose status and message say so.
    """
    if scene.equilibria is None:
        return prepared.solve(scene)
    from .equilibria.solved import solved  # few scenes ask for all of them

    return solved(scene)
