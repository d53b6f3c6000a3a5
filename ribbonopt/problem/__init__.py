"""Problem: a posed scene, the contract `BoundaryValueProblem`, formulations that fulfil it."""

from collections.abc import Callable
from importlib import import_module

from ribbonopt.scene import Algebraic, Scene

from .contract import BoundaryValueProblem, Phase
from .posed import Posed
from .ribbon import Ribbon

Formulation = Callable[[Ribbon, Posed], BoundaryValueProblem]

#: formulations by the name a scene gives them: each a function of its module of that name, which
#: is imported when a scene asks for it
FORMULATIONS = ("inverted", "algebraic", "differentiated", "energy")


def formulate(posed: Posed) -> tuple[Ribbon, BoundaryValueProblem]:
    """Return a scene's mechanics and, in its formulation, its boundary-value problem.

    Raises
    ------
    ModelError
        If the formulation does not suit the law, the states or the loads.
    """
    ribbon, name = Ribbon.of(posed), formulation_name(posed.scene)
    if posed.scene.states == "planar":
        from .wellposed.plane import in_plane  # few scenes are held in a plane

        ribbon = in_plane(ribbon, posed)
    formulation: Formulation = getattr(import_module(f"{__name__}.{name}"), name)
    return ribbon, formulation(ribbon, posed)


def formulation_name(scene: Scene) -> str:
    """Return the name of a scene's formulation, whichever way it was written."""
    return scene.formulation.type if isinstance(scene.formulation, Algebraic) else scene.formulation


__all__ = [
    "FORMULATIONS",
    "BoundaryValueProblem",
    "Phase",
    "Posed",
    "Ribbon",
    "formulate",
    "formulation_name",
]
