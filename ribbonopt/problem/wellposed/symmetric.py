"""Whether a piece of a loop stands for the whole of it: the law must have the symmetry, too.

A flip about d1 takes (u1, u2, u3) to (-u1, u2, u3), one about d2 to (u1, -u2, u3), and moments
likewise. Laws without natural strains are the same after either.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.problem.posed import Posed
from ribbonopt.problem.ribbon import Ribbon

ABOUT_D1, ABOUT_D2 = (-1.0, 1.0, 1.0), (1.0, -1.0, 1.0)
MOMENT = (0.3, 0.7, -0.45)  # without any symmetry
SAME = 1e-9


def refuse_asymmetry(ribbon: Ribbon, posed: Posed) -> None:
    """Raise a ModelError for a piece of a loop whose natural strains differ in its images."""
    loop = posed.scene.boundary.loop
    if loop is None or loop.piece == "whole" or not ribbon.law.natural:
        return
    twisted = loop.half_twists % 2 == 1 or (loop.piece == "fundamental" and loop.half_twists != 0)
    for flip, axis in ((ABOUT_D1, "d1"), (ABOUT_D2, "d2"))[: 2 if twisted else 1]:
        m, signs = ca.SX.sym("m", 3), np.array(flip)
        own = ca.SX.zeros(len(ribbon.law.states))
        u = ribbon.law.strain(Stress(ca.SX.zeros(3), m, own))
        strain = ca.Function("strain", [m, ribbon.parameters, ribbon.position], [u])
        at = posed.values, posed.scene.interval[0]
        here, image = (np.array(strain(k * np.array(MOMENT), *at)).ravel() for k in (1, signs))
        if np.abs(image - signs * here).max() > SAME * np.abs(here).max():
            raise ModelError(
                f"boundary.loop.piece: {loop.piece} stands for all of the loop by flips about "
                f"{axis}, after which the natural strains of law {posed.scene.law.type} are "
                "others; solve piece: whole",
                "boundary.loop.piece",
            )
