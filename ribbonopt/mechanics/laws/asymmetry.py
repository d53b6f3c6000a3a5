"""Where natural strains break a symmetry that laws without them have: of a plane, of a flip."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.scene import Scene

from .catalogue import relation_of
from .law import Stress

NEGLIGIBLE = 1e-9  # strains, of other strains or of 1 / L
FLIPS = {"d1": np.array([-1.0, 1.0, 1.0]), "d2": np.array([1.0, -1.0, 1.0])}


def leaves_plane(scene: Scene, theta: Mapping[str, float]) -> bool:
    """Whether natural strains take a ribbon out of the plane across its width.

    `theta` are the numbers of the scene by name.
    """
    start, end = scene.interval
    strain = _natural_strains(scene, theta)
    if strain is None:
        return False
    places, moment = start + (end - start) * np.array([0.0, 0.4, 1.0]), np.array([0.0, 0.7, 0.0])
    u1, u2, u3 = np.abs([strain(moment, float(s)) for s in places]).max(axis=0)
    return bool(max(u1, u3) > NEGLIGIBLE * max(1.0, u2))


def changed_by_flip(scene: Scene, theta: Mapping[str, float]) -> str:
    """Return d1 or d2 where a piece of a loop stands for all of it by flips about that director.

    After which the natural strains are others; "" if they are not. A flip about d1 takes
    (u1, u2, u3) to (-u1, u2, u3), one about d2 to (u1, -u2, u3), and moments likewise.
    """
    loop = scene.boundary.loop
    if loop is None or loop.piece == "whole":
        return ""
    strain, s = _natural_strains(scene, theta), scene.interval[0]
    if strain is None:
        return ""
    twisted = loop.half_twists % 2 == 1 or (loop.piece == "fundamental" and loop.half_twists != 0)
    moment = np.array([0.3, 0.7, -0.45])  # without any symmetry
    for axis, signs in FLIPS.items():
        here, image = strain(moment, s), strain(signs * moment, s)
        changed = np.abs(image - signs * here).max() > NEGLIGIBLE * np.abs(here).max()
        if changed and (axis == "d1" or twisted):
            return axis
    return ""


def _natural_strains(
    scene: Scene, theta: Mapping[str, float]
) -> Callable[[Array, float], Array] | None:
    """Return the strains (3,) at a moment (3,) and an arclength; None of laws that have none."""
    m, position = ca.SX.sym("m", 3), ca.SX.sym("s")
    law = relation_of(scene, lambda name: ca.SX(theta[name]), position)
    if not law.natural:
        return None
    u = law.strain(Stress(ca.SX.zeros(3), m, ca.SX.zeros(len(law.states))))
    strain = ca.Function("strain", [m, position], [ca.densify(u)])
    return lambda moment, s: np.array(strain(moment, s)).ravel()
