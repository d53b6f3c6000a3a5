"""Meshes of starts: as fine as a ribbon winds, and graded to where it bends.

A strong force keeps the bending in a layer of width 1 / sqrt(force) next to an end, thinner than an
interval of a uniform mesh; a ribbon of many turns needs intervals in proportion to them.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.accuracy.remesh import redistributed, size_for
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

EACH, MOST = 0.5, 80  # radians to an interval; intervals
FAR = 1.0  # radians in an interval
FLAT = 1 / 5  # power of the strains: a layer is followed far into its tail


def is_coarse(solution: Solution) -> bool:
    """Whether the ribbon turns so far in some interval that layers may be missed."""
    widths, turning = solution.mesh.widths, solution.trajectory.at_stages["u"]
    stages = np.linalg.norm(turning, axis=1).reshape(len(widths), -1)
    return bool((stages.max(axis=1) * widths * solution.posed.length > FAR).any())


def graded_mesh(solution: Solution, least: int, power: float = FLAT) -> Mesh:
    """Return a mesh of one phase, half of its intervals by length and half by bending.

    As many as the ribbon winds, but no fewer than `least`; they gather as a `power` of the strains.
    """
    o, (_, fraction, weights, _) = solution.trajectory.at_stages, solution.trajectory.stages
    strains = np.linalg.norm(o["u"], axis=1)
    turning = solution.posed.length * float(weights @ strains)
    count = max(least, min(size_for(int(np.ceil(turning / EACH))), MOST))
    bending = strains**power
    mean = float(weights @ bending)
    density = 1 + bending / mean if mean > 0 else np.ones_like(bending)
    density = np.concatenate([density[:1], density, density[-1:]])
    positions = np.concatenate([[0.0], fraction, [1.0]])
    share = np.append(0.0, np.cumsum(np.diff(positions) * (density[1:] + density[:-1]) / 2))
    return Mesh((redistributed(positions, share, count),))
