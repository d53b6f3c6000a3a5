"""Motions that no condition opposes: of the ribbon as a whole, and of a closed loop along itself.

Equilibria go over into equilibria under three translations, three rotations, and, the equations
being the same at every s, under sliding: (x(s), x(s + L)) for (x(0), x(L)). If a combination of
these seven motions keeps every condition, at ends that have no symmetry but what the conditions
demand, then no solution that it moves is isolated, and as many conditions are at odds or repeated.

Under a translation t and a rotation w about the reference point, r, n and m change by
t + w x (r - reference), w x n and w x m, a quaternion q by w q / 2. Under dead loads only turns
about their direction are motions of equilibria, and nothing slides.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.asymmetry import changed_by_sliding
from ribbonopt.mechanics.rotations import matrix_of, product

from .linearized import Linearized

SEEDS = (0.3, 0.8, 0.55)
CLOSED = 1e-8  # gap of a closed loop, relative to its length, and of its directors
FREE = 1e-8  # change of the conditions, relative to that of the unknowns, that counts as none


def refuse_motions(conditions: Linearized, *, sliding: bool) -> None:
    """Raise ModelError if the conditions leave the ribbon free to move, or to slide along itself.

    Said only where two different ends that satisfy the conditions agree; nothing is said where
    none are found. `sliding` says whether that does harm.
    """
    found, loaded = 0, conditions.posed.loaded
    for seed in SEEDS:
        z = conditions.satisfied(seed)
        if z is None:
            continue
        allowed = allowed_motions(conditions)
        motions = rigid(conditions, z) @ allowed
        free = allowed @ unopposed(conditions, z, motions)
        slides = False
        may = sliding and not free.size and not loaded and one_sided(conditions, z)
        if may and not changed_by_sliding(conditions.posed.scene, odd=True):
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
    start, end, _ = conditions.parts(z)
    (r0, first), (r1, last) = (conditions.ribbon.model.place(x) for x in (start, end))
    gap, turn = r1 - r0, first.T @ last
    reversed_ = np.abs(turn - np.diag([-1.0, -1.0, 1.0])).max() < CLOSED
    return bool(reversed_ and np.linalg.norm(gap) < CLOSED * conditions.length)


def rigid(conditions: Linearized, z: Array) -> Array:
    """Return changes (nz, 6) of the ends z: translations by the length, then rotations."""
    nx, count, c = conditions.nx, conditions.points, conditions.parts(z)[2]
    model, result = conditions.ribbon.model, np.zeros((len(z), 6))
    for at in range(0, count * nx, nx):
        own = slice(at, at + len(model.states))
        result[own], result[count * nx :] = model.moved(z[own], c, conditions.reference)
    result[:, :3] *= conditions.length
    return result


def along_itself(conditions: Linearized, z: Array) -> Array:
    """Change (nz, 1) of the ends z by sliding along by the length; there are no loads."""
    result = np.zeros((len(z), 1))
    start, end, c = conditions.parts(z)
    posed, section = conditions.posed, conditions.ribbon.section_function
    for at, x, s in zip((0, conditions.nx), (start, end), posed.scene.interval, strict=True):
        u, e = (np.array(part).ravel() for part in section(x, c, posed.values, s)[7:9])
        result[at : at + 3, 0] = (1 + e) * matrix_of(x[3:7])[:, 2]
        result[at + 3 : at + 7, 0] = np.array(product(x[3:7], (0.0, *u))) / 2
    return conditions.length * result


def allowed_motions(conditions: Linearized) -> Array:
    """Return combinations (6, k) of the rigid motions that take equilibria into equilibria."""
    motions = conditions.ribbon.model.motions
    for load in conditions.posed.loads:
        motions = motions @ load.symmetries(motions)
    for station in conditions.posed.stations:
        for action in station.actions:
            motions = motions @ action.symmetries(motions)
    return motions
