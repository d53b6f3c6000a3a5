"""What `ribbonopt check` says of a scene before anything is solved."""

from __future__ import annotations

from typing import Any

from ribbonopt.attempt.discretize import discretize
from ribbonopt.problem import pose, theta_values
from ribbonopt.problem.wellposed.examine import examine, refuse_unreachable, unknown_names
from ribbonopt.scene import Scene
from ribbonopt.scene.units import in_special_units

from .skipped import skipped


def check_scene(scene: Scene) -> dict[str, Any]:
    """Count unknowns and conditions, and say what solving would skip.

    Raises
    ------
    ModelError
        If conditions and unknowns do not fit.
    ConvergenceError
        If the prescribed ends cannot be reached.
    """
    posed = in_special_units(scene)
    ribbon, problem = pose(posed)
    examine(ribbon, problem, theta_values(posed))
    refuse_unreachable(scene)
    nlp = discretize(scene, problem)
    return {
        "name": scene.name,
        "unknowns": unknown_names(ribbon.model),
        "conditions": list(problem.conditions),
        "size": nlp.unknowns,
        "skipped": list(skipped(scene, problem)),
    }
