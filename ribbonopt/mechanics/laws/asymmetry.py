"""Where a ribbon breaks a symmetry that others have: of a plane, a flip, sliding along itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.scene import Scene

from .catalogue import always_the_same, fields_of, numbers_of, relation_of
from .law import ConstitutiveLaw, Stress

Strain = Callable[[Array, float], Array]

NEGLIGIBLE = 1e-9  # strains, of other strains or of 1 / L
FLIPS = {"d1": np.array([-1.0, 1.0, 1.0]), "d2": np.array([1.0, -1.0, 1.0])}
HALF_TWIST = np.array([-1.0, -1.0, 1.0])  # directors behind a half twist
MOMENT = np.array([0.3, 0.7, -0.45])  # without any symmetry
ALONG = np.array([0.0, 0.4, 1.0])  # of the interval


def never_bent(scene: Scene) -> bool:
    """Whether a ribbon has no natural strains, whatever its numbers are."""
    return scene.natural is None and always_the_same(scene.law)


def leaves_plane(scene: Scene, theta: Mapping[str, float]) -> bool:
    """Whether natural strains take a ribbon out of the plane across its width.

    `theta` are the numbers of the scene by name.
    """
    if never_bent(scene):
        return False
    start, end = scene.interval
    strain = _natural_strains(scene, theta)
    if strain is None:
        return False
    places, moment = start + (end - start) * ALONG, np.array([0.0, 0.7, 0.0])
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
    twisted = loop.half_twists % 2 == 1 or (loop.piece == "fundamental" and loop.half_twists != 0)
    for axis in ("d1", "d2") if twisted else ("d1",):
        if flipped(scene, theta, axis):
            return axis
    return ""


def flipped(scene: Scene, theta: Mapping[str, float], axis: str) -> bool:
    """Whether a flip about d1 or d2 changes the natural strains of a scene, anywhere along it."""
    strain, (start, end) = _natural_strains(scene, theta), scene.interval
    if strain is None:
        return False
    places, signs = start + (end - start) * ALONG, FLIPS[axis]
    return any(_differs(strain, signs, s, s) for s in places)


def changed_by_sliding(scene: Scene, odd: bool) -> bool:
    """Whether a whole loop that has slid along itself is another ribbon, or otherwise loaded.

    Its law or width varies along it, or is another behind an odd number of half twists (`odd`),
    which reverse d1 and d2; or something acts on it but a uniform pressure that they do not
    reverse.
    """
    loads, (start, end) = scene.loads, scene.interval
    if scene.gravity is not None or scene.supports or loads.points or loads.own:
        return True
    if loads.force is not None or loads.couple is not None:
        return True
    given = {"loads.pressure": loads.pressure, "width": scene.width}
    if along := {name: value for name, value in given.items() if value is not None}:
        from ribbonopt.mechanics.along import Field  # few scenes have any

        if not all(Field(name, value).uniform for name, value in along.items()):
            return True
    if odd and loads.pressure:
        return True
    if never_bent(scene):
        return False
    law, m, position = _relation(scene, numbers_alone(scene))
    u = law.strain(Stress(ca.SX.zeros(3), m, ca.SX.zeros(len(law.states))))
    varied = bool(ca.depends_on(u, position))
    if not (varied or (odd and law.natural)):
        return False
    strain = _function(m, position, u)
    places = start + (end - start) * ALONG
    still, signs = np.ones(3), HALF_TWIST if odd else np.ones(3)
    return any(_differs(strain, still, start, s) for s in places) or _differs(
        strain, signs, start, start
    )


def numbers_alone(scene: Scene) -> dict[str, float]:
    """Return the numbers by name that the law of a scene, in units Dw = L = 1, may depend on."""
    theta = {f"law.{name}": value for name, value in numbers_of(scene.law).items()}
    theta |= {name: value for field in fields_of(scene) for name, value in field.numbers().items()}
    theta |= {"interval.start": scene.interval[0], "interval.end": scene.interval[1]}
    return theta | {f"parameters.{name}": value for name, value in scene.parameters.items()}


def _differs(strain: Strain, signs: Array, s: float, image: float) -> bool:
    """Whether the strains at an image are others but for the signs (3,) of directors there."""
    here, there = strain(MOMENT, s), strain(signs * MOMENT, image)
    return bool(np.abs(there - signs * here).max() > NEGLIGIBLE * np.abs(here).max())


def _natural_strains(scene: Scene, theta: Mapping[str, float]) -> Strain | None:
    """Return the strains (3,) at a moment (3,) and an arclength; None of laws that have none."""
    law, m, position = _relation(scene, theta)
    if not law.natural:
        return None
    u = law.strain(Stress(ca.SX.zeros(3), m, ca.SX.zeros(len(law.states))))
    return _function(m, position, u)


def _relation(scene: Scene, theta: Mapping[str, float]) -> tuple[ConstitutiveLaw, ca.SX, ca.SX]:
    """Return the law with numbers put in, and symbols of the moment and of the arclength."""
    m, position = ca.SX.sym("m", 3), ca.SX.sym("s")
    return relation_of(scene, lambda name: ca.SX(theta[name]), position), m, position


def _function(m: ca.SX, position: ca.SX, u: ca.SX) -> Strain:
    strain = ca.Function("strain", [m, position], [ca.densify(u)])
    return lambda moment, s: np.array(strain(moment, s)).ravel()
