"""The linear twin of a ribbon: straight where the ribbon is straight, and differentiable there.

Where m2 = m3 = 0 all laws say the same, u = 0; Newton's method, for which a law with a kink is
singular there, finds the state with any linear one.
"""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.attempt.structure import Structure
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed
from ribbonopt.scene import Kirchhoff, Scene

#: stiffnesses at which hardly a load that a scene names buckles a rod
STIFF = Kirchhoff(B2=1.737, B3=2.391)


def has_twin(law: ConstitutiveLaw, scene: Scene, parameter: str = "") -> bool:
    """Whether a rod has the same unknowns, and the parameter that moves, if one is named."""
    if parameter.startswith("law.") or law.states:
        return False
    return law.components == capabilities(twin_scene(scene)).components


def twin_scene(scene: Scene) -> Scene:
    """Return a scene with a linear law."""
    return replace(scene, law=STIFF, switching="auto")


def twin_of(scene: Scene) -> Prepared:
    """Return the structure of a scene with a linear law."""
    return Prepared(Structure.of(Posed.of(twin_scene(scene))), 0.0)
