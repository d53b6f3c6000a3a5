"""What `ribbonopt check` says of a scene before anything is solved."""

from __future__ import annotations

from typing import Any

from ribbonopt.attempt.structure import Structure
from ribbonopt.problem import Posed
from ribbonopt.problem.wellposed.examine import examine, refuse_unreachable, unknown_counts
from ribbonopt.scene import Scene

from .skipped import skipped


def check_scene(scene: Scene) -> dict[str, Any]:
    """Count unknowns and conditions, and say what solving would skip.

    Raises
    ------
    ModelError
        If conditions and unknowns do not fit, or a continuation leads to what is out of reach.
    ConvergenceError
        If the prescribed ends cannot be reached.
    """
    posed = Posed.of(scene)
    structure = Structure.of(posed)
    examine(structure.ribbon, structure.problem, posed)
    refuse_unreachable(posed)
    if scene.continuation is not None:
        from ribbonopt.problem.wellposed.reach import refuse_far_goals  # few scenes are continued

        refuse_far_goals(scene)
    nlp, _ = structure.on(structure.mesh(None).elements)
    return {
        "name": scene.name,
        "unknowns": unknown_counts(structure.ribbon),
        "conditions": list(structure.problem.conditions),
        "size": nlp.unknowns,
        "skipped": list(skipped(posed, structure.problem)),
    }
