"""Kinetic energy of small vibrations: a quadratic form along the same chain as the energy.

All states at the stages follow linearly from the state before an element and its own variables, so
displacements and turns there do, and half the sum of their weighted squares is the kinetic energy
of unit frequency. A section turns about d1 and d3 with the inertia that is asked for; about d2 with
none, as is usual of slender rods.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.model import RodModel
from ribbonopt.mechanics.planar import PlanarRod

from ..variation import Variation


class Gyration(NamedTuple):
    """Squared radii of gyration about d1 and d3 of a section of relative width one, L = 1."""

    d1: float = 0.0
    d3: float = 0.0


class Kinetic(NamedTuple):
    """What moves at the stages, by the variables of each element, units of mass and length one.

    `rows` (N, c, nx + m) are displacements and turns times the roots of their inertia, so that the
    Hessian of an element is rows^T rows. `weights` (N K,) are those of the stages, mass included.
    """

    rows: Array
    weights: Array

    @property
    def hessians(self) -> Array:
        """Hessians (N, nx + m, nx + m) of the elements."""
        found: Array = self.rows.swapaxes(1, 2) @ self.rows
        return found


class Moves(NamedTuple):
    """How states move a section: linear maps from nx states, lab frame."""

    displacement: Array  # (k, 3, nx)
    rotation: Array  # (k, 3, nx)


def moves_of(model: RodModel, x: Array) -> Moves:
    """Return displacements and turns (lab frame) of sections by changes of their states (k, nx).

    A turn is delta phi = 2 vec(dq o q*) of a quaternion q, or about the normal of a plane.
    """
    k, nx = x.shape
    displacement, rotation = np.zeros((k, 3, nx)), np.zeros((k, 3, nx))
    if isinstance(model, PlanarRod):
        i, j = model.plane.inside
        displacement[:, i, 0] = displacement[:, j, 1] = 1.0
        rotation[:, model.plane.axis, 2] = model.plane.sign
        return Moves(displacement, rotation)
    displacement[:, :, :3] = np.eye(3)
    a, b, c, d = x[:, 3:7].T
    rows = [[-b, a, -d, c], [-c, d, a, -b], [-d, -c, b, a]]
    rotation[:, :, 3:7] = 2 * np.moveaxis(np.array(rows), 2, 0)
    return Moves(displacement, rotation)


class Sections(NamedTuple):
    """Positions and directors d1, d3 (k, 3) of sections, lab frame, units L = 1.

    Of a rod in a plane the positions are those in the plane through the origin.
    """

    r: Array
    d1: Array
    d3: Array


def sections_of(model: RodModel, x: Array) -> Sections:
    """Return where sections are by their states (k, nx)."""
    if isinstance(model, PlanarRod):
        r, (a, b) = np.zeros((len(x), 3)), model.plane.basis
        r[:, list(model.plane.inside)] = x[:, :2]
        cos, sin = np.cos(x[:, 2:3]), np.sin(x[:, 2:3])
        return Sections(r, cos * a - sin * b, sin * a + cos * b)
    a, b, c, d = x[:, 3:7].T
    d1 = [a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)]
    d3 = [2 * (b * d + a * c), 2 * (c * d - a * b), a * a - b * b - c * c + d * d]
    return Sections(x[:, :3], np.array(d1).T, np.array(d3).T)


def kinetic(
    variation: Variation, model: RodModel, length: float, width: Array, gyration: Gyration
) -> Kinetic:
    """Return the kinetic energy of a chain whose stages have relative widths `width` (N K,).

    Mass per length is the relative width, the inertia of turns that times `gyration` and the square
    of the relative width. In a plane nothing turns about d1 or d3.
    """
    at, chain = variation.stages, variation.chain
    N, K = chain.weight.shape
    nx = at.x.shape[1]
    weights = length * chain.weight.ravel() * width
    moves = moves_of(model, at.x)
    parts = [np.sqrt(weights)[:, None, None] * moves.displacement]
    if any(gyration) and not isinstance(model, PlanarRod):
        _, d1, d3 = sections_of(model, at.x)
        turns = np.stack([d1, d3], axis=1) @ moves.rotation
        sizes = np.sqrt(weights * width**2)[:, None] * np.sqrt(gyration)
        parts += [(sizes[..., None] * turns)[:, [i]] for i in (0, 1) if gyration[i]]
    moved = np.concatenate(parts, axis=1).reshape(N, K, -1, nx)
    rows = moved @ chain.stages[:, :, :nx]
    return Kinetic(rows.reshape(N, -1, rows.shape[3]), weights)
