"""Conditions of a scene that a rod in its plane meets by itself, and those that it never can."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.asymmetry import leaves_plane
from ribbonopt.mechanics.loads.load import Load
from ribbonopt.problem.posed import Posed
from ribbonopt.problem.ribbon import Ribbon
from ribbonopt.scene.planes import Said, said

from .linearized import linearize

NOTHING = 1e-9  # largest residual of a condition that holds, and derivative of one without effect
PLACES = 33  # at which loads along the ribbon are looked at


def in_plane(ribbon: Ribbon, posed: Posed) -> Ribbon:
    """Return a planar ribbon without the conditions that hold whatever it does in its plane.

    Raises
    ------
    ModelError
        If the scene prescribes something that is not in the plane, or the law twists there.
    """
    words = said(posed.scene)
    if leaves_plane(posed.scene, posed.theta):
        raise ModelError(
            f"{words.words}, but the natural strains of law {posed.scene.law.type} lead out of the "
            f"plane across d2; {words.instead}, or leave it natural bending about d2 only",
            "law.natural",
        )
    conditions = linearize(ribbon, posed)
    samples = [conditions.at(conditions.generic(seed)) for seed in (0.3, 0.8)]
    without = np.all([np.abs(jacobian).max(axis=1) < NOTHING for _, jacobian in samples], axis=0)
    residuals = np.max([np.abs(values) for values, _ in samples], axis=0)
    for name, residual in zip(np.array(conditions.names)[without], residuals[without], strict=True):
        if residual > NOTHING:
            raise _refusal(words, str(name), float(residual), str(name).partition(" ")[0])
    for load in posed.loads:
        across = _across(ribbon, load, conditions.generic(0.3), posed)
        if across > NOTHING:
            raise _refusal(words, load.name, across, load.name)
    return replace(ribbon, idle=frozenset(np.array(conditions.names)[without].tolist()))


def _across(ribbon: Ribbon, load: Load, z: Array, posed: Posed) -> float:
    """Part of a load that would take the ribbon out of its plane, at the states of one end."""
    x, constants = (ca.SX.sym("x", len(names)) for names in (ribbon.states, ribbon.constants))
    rod, theta = ribbon.section(x, constants).rod, ribbon.theta.__getitem__
    force, couple = load.force(rod, theta), load.couple(rod, theta)
    parts = [ca.dot(force, rod.d2), ca.dot(couple, rod.d1), ca.dot(couple, rod.d3)]
    inputs = [x, constants, ribbon.parameters, ribbon.position]
    function = ca.Function("across", inputs, [ca.densify(ca.vertcat(*parts))])
    count = x.numel()
    c = z[len(z) - len(ribbon.constants) :]
    places = np.linspace(*posed.scene.interval, PLACES)
    found = [function(z[:count], c, posed.values, s) for s in places]
    return float(np.abs(np.array(found)).max())


def _refusal(words: Said, name: str, size: float, key: str) -> ModelError:
    return ModelError(
        f"{words.words}, but {name} leads out of the plane across d2 (by {size:.2g}); "
        f"{words.instead}, or keep the scene in the plane",
        key,
    )
