"""The law of a scene with natural strains."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.scene import Scene

from .law import ConstitutiveLaw
from .natural import NAMES, NaturalStrains
from .natural_sides import NaturalSides
from .shifted import ShiftedLaw


def natural_law(
    scene: Scene, law: ConstitutiveLaw, fields: Mapping[str, ca.SX], position: ca.SX
) -> ConstitutiveLaw:
    """Return a law with the natural strains of a scene, whose numbers are `fields` by name.

    Raises
    ------
    ModelError
        If the law knows no curvature across, nor Poisson's ratio, and the scene has one.
    """
    along, twist, across, ratio = (fields[f"natural.{name}"] for name in NAMES)
    natural = NaturalStrains(along, twist, across, ratio, position, fields.get("width", 1.0))
    found = law.naturally(natural)
    if found is not None:
        return found
    for name in ("across", "poisson_ratio"):
        if value := getattr(scene.natural, name):
            raise ModelError(
                f"natural.{name}: found {value}, which law {scene.law.type} cannot have; write 0, "
                "or use law sadowsky, variational, single_sheet or wunderlich",
                f"natural.{name}",
            )
    return ShiftedLaw(law, natural, NaturalSides(natural) if law.sheeted else None)
