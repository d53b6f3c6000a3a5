"""Problem: the contract `BoundaryValueProblem` and the formulations that fulfil it."""

from ribbonopt.scene import Scene

from .contract import BoundaryValueProblem, Phase
from .inverted import inverted
from .ribbon import Ribbon, ribbon_of, theta_of

#: formulations by the name a scene gives them
FORMULATIONS = {"inverted": inverted}


def pose(scene: Scene) -> tuple[Ribbon, BoundaryValueProblem]:
    """Return a scene's mechanics and, in its formulation, its boundary-value problem."""
    ribbon = ribbon_of(scene)
    return ribbon, FORMULATIONS[scene.formulation](ribbon)


__all__ = [
    "FORMULATIONS",
    "BoundaryValueProblem",
    "Phase",
    "Ribbon",
    "inverted",
    "pose",
    "ribbon_of",
    "theta_of",
]
