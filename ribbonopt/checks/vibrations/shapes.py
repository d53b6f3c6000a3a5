"""Shapes of modes: displacements and turns along the ribbon, in the lab frame."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.planar import PlanarRod
from ribbonopt.problem import Ribbon
from ribbonopt.solution.solution import Solution

from ..variation import Variation
from ..zero_moment import law_in_space
from .found import Vibrations
from .kinetic import moves_of

STILL = 1e-9  # largest displacement over the largest rotation: nothing moves
FLAT = 1e-7  # part of a tangent along the normal of a plane


class Shapes(NamedTuple):
    """Shapes of k modes at n arclengths, as `Modes` has them."""

    s: Array
    displacement: Array
    rotation: Array
    in_plane: Array


class Moved(NamedTuple):
    """Displacements and turns (k, n, 3) at n places: the start, the stages and the end."""

    displacement: Array
    rotation: Array


def moved(variation: Variation, ribbon: Ribbon, modes: Array) -> Moved:
    """Return how k modes (N, nx + m, k), by the variables of each element, move the sections."""
    at, nx = variation.stages, variation.stages.x.shape[1]
    stages = variation.chain.stages[:, :, :nx] @ modes[:, None]  # (N, K, nx, k)
    end = variation.chain.step[-1] @ modes[-1]
    count = modes.shape[2]
    dx = np.concatenate([modes[:1, :nx], stages.reshape(-1, nx, count), end[None]])
    moves = moves_of(ribbon.model, np.concatenate([at.ends[:1], at.x, at.ends[1:]]))
    return Moved(*(np.moveaxis(part @ dx, 2, 0) for part in moves))


def shapes_of(solution: Solution, found: Vibrations) -> Shapes:
    """Return the shapes of vibrations, scaled, and their shares in the plane."""
    displacement, rotation = moved(found.variation, found.ribbon, found.modes)
    start, end = solution.scene.interval
    places = np.concatenate([[0.0], found.variation.stages.places, [1.0]])
    size, turn = (np.linalg.norm(v, axis=2).max(axis=1) for v in (displacement, rotation))
    size = np.where(size > STILL * turn, size, turn)[:, None, None]
    share = in_plane(found, displacement)
    s = start + found.pieces * (end - start) * places
    return Shapes(s, displacement / size, rotation / size, share)


def in_plane(found: Vibrations, displacement: Array) -> Array:
    """Share (k,) of the kinetic energy of modes in the plane of a ribbon; nan where it has none."""
    if isinstance(found.ribbon.model, PlanarRod):
        return np.ones(len(displacement))
    normal = normal_of(found.variation.stages.x)
    if normal is None:
        return np.full(len(displacement), np.nan)
    inside = displacement - (displacement @ normal)[..., None] * normal
    # Of a kinetic energy of one half at unit frequency, turns included.
    share: Array = (inside[:, 1:-1] ** 2).sum(axis=2) @ found.weights
    return share


def straightens(solution: Solution) -> bool:
    """Whether the bending of a ribbon in a plane vanishes somewhere, where its law is singular.

    Across the plane: there a law that is homogeneous twists as it bends.
    """
    law = law_in_space(solution)
    if law.linear_at_zero or law.natural:
        return False
    m2 = solution.trajectory.at_stages["m2"]
    return bool(m2.min() * m2.max() < 0)


def normal_of(x: Array) -> Array | None:
    """Return d2 (3,) of states (k, nx) if it is the same all along, else None."""
    a, b, c, d = x[:, 3:7].T
    d2 = np.stack([2 * (b * c - a * d), a * a - b * b + c * c - d * d, 2 * (c * d + a * b)], axis=1)
    return d2[0] if np.abs(d2 - d2[0]).max() < FLAT else None
