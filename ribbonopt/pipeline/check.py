"""What `ribbonopt check` says of a scene before anything is solved."""

from __future__ import annotations

from typing import Any

from ribbonopt.attempt.structure import Structure
from ribbonopt.mechanics.ends.conditions import Component, Frame
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
        "hints": _hints(posed),
    }


def _hints(posed: Posed) -> list[str]:
    """Say what a scene has and does not use: half a turn that maps its clamps to each other."""
    if any(not isinstance(condition, Component | Frame) for condition in posed.conditions):
        return []
    from ribbonopt.mechanics.ends.twofold import axes_of  # scenes between clamps alone

    axes = axes_of(posed.scene, posed.conditions)
    choice = " or ".join(f"symmetric: {axis.director}" for axis in axes)
    told = "half a turn maps the ends to each other: equilibria that have this symmetry are found "
    return [f"{told}on half of the strip by {choice} (others may have less energy)"] if axes else []
