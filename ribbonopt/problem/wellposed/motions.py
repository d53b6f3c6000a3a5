"""Motions that no condition opposes: of the ribbon as a whole, and of a closed loop along itself.

Equilibria go over into equilibria under three translations, three rotations, and, the equations
being the same at every s, under sliding: (x(s), x(s + L)) for (x(0), x(L)). If a combination of
these seven motions keeps every condition, at ends that have no symmetry but what the conditions
demand, then no solution that it moves is isolated, and as many conditions are at odds or repeated.

Under a translation t and a rotation w about the reference point, the fields r, n and m of the
reduced states change by t + w x (r - reference), w x n and w x m. Since m = m_0 + n x (r -
reference), the constant m_0 changes by w x m_0 + t x n; a quaternion q changes by w q / 2.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.rotations import matrix_of, product

from .linearized import NX, Linearized

SEEDS = (0.3, 0.8, 0.55)
CLOSED = 1e-8  # gap of a closed loop, relative to its length, and of its directors
FREE = 1e-8  # change of the conditions, relative to that of the unknowns, that counts as none


def refuse_motions(conditions: Linearized, *, sliding: bool) -> None:
    """Raise ModelError if the conditions leave the ribbon free to move, or to slide along itself.

    Said only where two different ends that satisfy the conditions agree; nothing is said where
    none are found. `sliding` says whether that does harm.
    """
    found = 0
    for seed in SEEDS:
        z = conditions.satisfied(seed)
        if z is None:
            continue
        motions = rigid(conditions, z)
        free = unopposed(conditions, z, motions)
        slides = False
        if sliding and not free.size and one_sided(conditions, z):
            # Where the start is held, a rigid motion takes it back to its place.
            motions = np.hstack([motions, along_itself(conditions, z)])
            slides = unopposed(conditions, z, motions).size > 0
        if not (free.size or slides):
            return
        found += 1
        if found == 2:
            from .remedies import motion_refusal, sliding_refusal  # words for those who need them

            raise (
                motion_refusal(conditions, z, free) if free.size else sliding_refusal(conditions, z)
            )


def unopposed(conditions: Linearized, z: Array, motions: Array) -> Array:
    """Independent combinations (k, free) of k motions (nz, k) that keep the conditions at ends z.

    To first order; none if the motions are not finite (the law has no derivative everywhere).
    """
    if not np.isfinite(motions).all():
        return np.empty((motions.shape[1], 0))
    scale = conditions.scales(z)
    jacobian = conditions.at(z)[1]
    rows = np.linalg.norm(jacobian * scale, axis=1)
    sizes = np.linalg.norm(motions / scale[:, None], axis=0)
    _, singular, right = np.linalg.svd(jacobian @ motions / np.outer(rows, sizes))
    return np.asarray((right[singular < FREE] / sizes).T)


def one_sided(conditions: Linearized, z: Array) -> bool:
    """Whether z closes a loop with d1 and d2 reversed.

    Of loops, these can never be uniform; others may be circles, which sliding only turns, so that
    the circle held at one point is isolated, and no error.
    """
    gap = z[NX : NX + 3] - z[:3]
    turn = matrix_of(z[3:7]).T @ matrix_of(z[NX + 3 : 2 * NX])
    reversed_ = np.abs(turn - np.diag([-1.0, -1.0, 1.0])).max() < CLOSED
    return bool(reversed_ and np.linalg.norm(gap) < CLOSED * conditions.length)


def rigid(conditions: Linearized, z: Array) -> Array:
    """Return changes (nz, 6) of the ends z: translations by the length, then rotations."""
    n, m0 = z[2 * NX : 2 * NX + 3], z[2 * NX + 3 :]
    result = np.zeros((len(z), 6))
    for at in (0, NX):
        r, q0, q = z[at : at + 3] - conditions.reference, z[at + 3], z[at + 4 : at + 7]
        result[at : at + 3, :3] = conditions.length * np.eye(3)
        result[at : at + 3, 3:] = -_cross(r)
        result[at + 3, 3:] = -q / 2
        result[at + 4 : at + 7, 3:] = (q0 * np.eye(3) - _cross(q)) / 2
    result[2 * NX : 2 * NX + 3, 3:] = -_cross(n)
    result[2 * NX + 3 :, :3] = -conditions.length * _cross(n)
    result[2 * NX + 3 :, 3:] = -_cross(m0)
    return result


def along_itself(conditions: Linearized, z: Array) -> Array:
    """Change (nz, 1) of the ends z by sliding along by the length."""
    result = np.zeros((len(z), 1))
    for at in (0, NX):
        x = z[at : at + NX]
        *_, u2, u3 = conditions.ribbon.section_function(x, z[2 * NX :], conditions.theta)
        result[at : at + 3, 0] = matrix_of(x[3:])[:, 2]
        result[at + 3 : at + 7, 0] = np.array(product(x[3:], (0.0, 0.0, float(u2), float(u3)))) / 2
    return conditions.length * result


def _cross(v: Array) -> Array:
    """Matrix (3, 3) of v x."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
