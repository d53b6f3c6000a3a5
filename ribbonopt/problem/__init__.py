"""Problem: the contract `BoundaryValueProblem` and the formulations that fulfil it."""

from collections.abc import Callable
from importlib import import_module

from ribbonopt.scene import Algebraic, Scene

from .contract import BoundaryValueProblem, Phase
from .ribbon import Ribbon, ribbon_of, structure_of, theta_of, theta_values

Formulation = Callable[[Ribbon, Scene], BoundaryValueProblem]

#: formulations by the name a scene gives them: each a function of its module of that name, which
#: is imported when a scene asks for it
FORMULATIONS = ("inverted", "algebraic", "differentiated", "energy")


def pose(scene: Scene) -> tuple[Ribbon, BoundaryValueProblem]:
    """Return a scene's mechanics and, in its formulation, its boundary-value problem.

    Raises
    ------
    ModelError
        If the formulation does not suit the law, the states or the loads.
    """
    ribbon, name = ribbon_of(scene), formulation_name(scene)
    formulation: Formulation = getattr(import_module(f"{__name__}.{name}"), name)
    return ribbon, formulation(ribbon, scene)


def formulation_name(scene: Scene) -> str:
    """Return the name of a scene's formulation, whichever way it was written."""
    return scene.formulation.type if isinstance(scene.formulation, Algebraic) else scene.formulation


__all__ = [
    "FORMULATIONS",
    "BoundaryValueProblem",
    "Phase",
    "Ribbon",
    "formulation_name",
    "pose",
    "ribbon_of",
    "structure_of",
    "theta_of",
    "theta_values",
]
