"""The natural strains of a scene, and the law that has them."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.scene import Scene

from .law import ConstitutiveLaw
from .natural import NAMES, NaturalStrains
from .shifted import ShiftedLaw


def natural_law(
    scene: Scene, law: ConstitutiveLaw, theta: Callable[[str], ca.SX], position: ca.SX
) -> ConstitutiveLaw:
    """Return a law with the natural strains of a scene.

    Raises
    ------
    ModelError
        If the law knows no curvature across, nor Poisson's ratio, and the scene has one.
    """
    found = law.naturally(strains_of(theta, position))
    if isinstance(found, ShiftedLaw) and scene.natural is not None:
        for name in ("across", "poisson_ratio"):
            if number := getattr(scene.natural, name):
                raise ModelError(
                    f"natural.{name}: found {number:g}, which law {scene.law.type} cannot have; "
                    "write 0, or use law sadowsky, variational or single_sheet",
                    f"natural.{name}",
                )
    return found


def strains_of(theta: Callable[[str], ca.SX], position: ca.SX) -> NaturalStrains:
    """Return natural strains from the symbols of their numbers."""
    return NaturalStrains(*(theta(f"natural.{name}") for name in NAMES), position)
