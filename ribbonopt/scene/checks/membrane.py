"""Stiffnesses in a ribbon's own plane that mean nothing, or that its law has of its own."""

from __future__ import annotations

from collections.abc import Iterator

from ribbonopt.scene import limits
from ribbonopt.scene.faults import Problem, shown
from ribbonopt.scene.laws import Rod
from ribbonopt.scene.membrane import AnyMembrane, Membrane, in_units, stiffnesses
from ribbonopt.scene.model import Scene
from ribbonopt.scene.units import units_of


def check_membrane(scene: Scene, membrane: AnyMembrane) -> Iterator[Problem]:
    """Yield what is wrong with the membrane of a scene."""
    if not isinstance(membrane, Membrane) and scene.ribbon is None:
        message = "takes its numbers from `ribbon`, which this scene has not; write `ribbon` with "
        message += 'its sizes, or numbers, such as "membrane: {bending: 900, stretching: 120000}"'
        yield Problem(("membrane",), message, shown(membrane))
        return
    if not stiffnesses(membrane):
        message = "says nothing; expected bending (B1), stretching (EA) or both, such as "
        yield Problem(("membrane",), message + '"membrane: {bending: 900}"; or remove it', "{}")
    if isinstance(scene.law, Rod) and "bending" in stiffnesses(membrane):
        message = "stands beside law.B, whose first is the same B1; "
        if isinstance(membrane, Membrane):
            yield Problem(("membrane", "bending"), message + "remove this", f"{membrane.bending:g}")
        else:
            message += 'write "membrane: {stretching: ...}"'
            yield Problem(("membrane",), message, shown(membrane))
    if isinstance(membrane, Membrane):
        yield from _sizes(scene, membrane)


def _sizes(scene: Scene, membrane: Membrane) -> Iterator[Problem]:
    """Yield stiffnesses too unlike those of the law and the length."""
    inside = in_units(membrane, units_of(scene), scene.ribbon)
    for name, worth in stiffnesses(inside).items():
        if worth is not None and not 1 / limits.RATIO <= worth <= limits.RATIO:
            unit = "Dw" if name == "bending" else "Dw / L^2"
            message = f"which is {worth:g} {unit}; expected from {1 / limits.RATIO:g} to "
            message += f"{limits.RATIO:g} of it; leave out what is not to give"
            yield Problem(("membrane", name), message, f"{getattr(membrane, name):g}")
