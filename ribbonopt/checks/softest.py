"""The softest disturbance of an equilibrium: smallest eigenvalue of its second variation, and mode.

Eigenvalues are those of the second variation over the integral of the squared moments along the
ribbon: compliances. They go through zero at folds and branch points. The smallest is found by
inverse iteration from shifts that approach it from below, as the count of those below tells.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.rotations import product
from ribbonopt.solution.solution import Solution

from .chain_form import ChainForm
from .elimination import factored
from .stability import variation_of
from .variation import Variation

EXACT = 1e-7  # of the largest eigenvalue: width of the enclosure at which the shift is near
MOST, STEPS = 40, 3  # shifts, and steps of the inverse iteration with each
STILL = 1e-9  # largest displacement over the largest rotation: nothing moves
NEARER = 0.05  # distance of the next shift from the eigenvalue, over that of the last


@dataclass(frozen=True, eq=False)
class Softest:
    """Smallest eigenvalue, and its disturbance at k arclengths, lab frame.

    Attributes
    ----------
    eigenvalue : float
        One over a moment and a length, in the units of the scene. Negative where the equilibrium is
        unstable; about zero where a loop slides along itself.
    s : (k,) array
        Arclengths of the stages and the ends, in the units of the scene.
    displacement, rotation : (k, 3) arrays
        What it does to positions, over the unit of length, and to directors: they turn about the
        vector `rotation`. Scaled to a largest displacement of one; of rotation where nothing moves.
    """

    eigenvalue: float
    s: Array
    displacement: Array
    rotation: Array


def softest(solution: Solution) -> Softest | str:
    """Return the softest disturbance of a solution or, in words, why there is none."""
    variation = variation_of(solution)
    if isinstance(variation, str):
        return variation
    eigenvalue, x0, own = _smallest(variation.form, variation.largest)
    start, end = solution.scene.interval
    places = np.concatenate([[0.0], variation.stages.places, [1.0]])
    displacement, rotation = _shape(variation, x0, own)
    size, turn = (float(np.linalg.norm(v, axis=1).max()) for v in (displacement, rotation))
    if size <= STILL * turn:
        size = turn
    s = start + (end - start) * places
    eigenvalue /= solution.units.moment * solution.units.length
    return Softest(eigenvalue, s, displacement / size, rotation / size)


def _smallest(form: ChainForm, largest: float) -> tuple[float, Array, Array]:
    """Smallest eigenvalue, with x_0 (nx,) and own variables (N, m) of its mode."""
    N, nx, m = form.B.shape
    below, above = -largest, np.inf
    while (factors := factored(form, -below)).negative:
        below *= 4
    phase = np.arange(nx + N * m) ** 2 % 7 + 1.0
    x0, own = phase[:nx], phase[nx:].reshape(N, m)
    for _ in range(MOST):
        for _ in range(STEPS):
            x0, own = x0, form.mass * own
            size = np.sqrt(x0 @ x0 + (own**2).sum())
            before = x0 / size, own / size
            x0, own = factors.solve(*before)
        # Never below the eigenvalue: a quotient of the inverse, the shift being below it.
        found = below + 1 / float(x0 @ before[0] + (own * before[1]).sum())
        above = min(above, found)
        if above - below <= EXACT * largest:
            break
        nearer = above - NEARER * (above - below)
        tried = factored(form, -nearer)
        if tried.negative:
            above = nearer
        else:
            below, factors = nearer, tried
    return found, x0, own


def _shape(variation: Variation, x0: Array, own: Array) -> tuple[Array, Array]:
    """Displacements and rotations (k, 3), lab frame, at the start, the stages and the end."""
    form, at = variation.form, variation.stages
    nodes = form.nodes(x0, own)
    inner = np.concatenate([nodes[:-1], own], axis=1)
    dx = (variation.chain.stages @ inner[:, None, :, None])[..., : len(x0), 0]
    dx = np.concatenate([nodes[:1], dx.reshape(-1, len(x0)), nodes[-1:]])
    x = np.concatenate([at.ends[:1], at.x, at.ends[1:]])
    q, dq = x[:, 3:7].T, dx[:, 3:7].T
    turns = np.stack(product(dq, (q[0], -q[1], -q[2], -q[3])), axis=1)[:, 1:]
    return dx[:, :3], 2 * turns
