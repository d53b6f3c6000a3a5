"""Layers that a law makes: singularities of its strains at complex s, near the ribbon.

Where m2 changes sign the strains of a smoothed law change over a width of about delta |m3| / |m2'|,
and wherever (m2, m3) passes near zero over about |m| / |m'|. Two schemes whose stages both step
over such a layer agree, and are wrong. The law says where it is singular; a step of Newton's method
from each pair of neighbouring stages, in the complex plane, says where on this solution that is.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.trajectory import Trajectory

REACH = 1.0  # widths of an element, beyond which nothing can be said from it
BEYOND = 1e-3  # of a phase, how far beyond its ends at least
SEEN = 10.0  # decay of a solution over the stages of an element, by which they show a singularity
SHARE = 0.1  # of a change of strains that a step over it may cost
BESIDE = 0.3  # steps between stages, by which the nearest pair may miss a singularity
NEAR = 2.5  # ellipse of an element between whose nodes errors may be larger than at them
WATCHED = 1.5  # exponent of an element, from which on it is looked at between its nodes
LOW = 8  # order up to which the error of an element is looked at inside it too
FADED = 10.0  # how much less than it may a layer shows where strains count again
FAINT = 1e-6  # of the largest change of strains: what is no layer
THINNEST = 1e-12  # of a phase: distance to a singularity that counts as none

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Layers:
    """Singularities near one phase: relative positions (k,), and by how much strains change.

    Where they `fade` (k,), by that times the distance; where they `jump` (k,) they are smooth on
    either side; nowhere by default.
    """

    places: Complex
    sizes: Array
    fades: NDArray[np.bool_] | None = None
    jumps: NDArray[np.bool_] | None = None

    @classmethod
    def none(cls) -> Layers:
        """Return no singularities."""
        return cls(np.empty(0, complex), np.empty(0))

    @property
    def fade(self) -> NDArray[np.bool_]:
        """Which of them fade."""
        return np.zeros(len(self), bool) if self.fades is None else self.fades

    @property
    def jump(self) -> NDArray[np.bool_]:
        """Which of them jump."""
        return np.zeros(len(self), bool) if self.jumps is None else self.jumps

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.places)

    def overlooked(self, nodes: Array, degree: int, order: int) -> Array:
        """Local errors (n,) of elements whose stages cannot have seen the nearest singularity.

        `nodes` (n + 1,) are relative positions; errors per length of the phase.
        """
        widths = np.diff(nodes)
        x, rho = self._seen_from(nodes)
        # Beside an element it acts over no more than its distance.
        beside = (np.maximum(np.abs(x.real) - 1, 0) + np.abs(x.imag)) * widths / 2
        over = np.where(np.abs(x.real) <= 1, widths, np.minimum(widths, beside))
        sizes = self.sizes[:, None] * np.where(self.fade[:, None], over, 1.0)
        missed = sizes * over * rho ** -(order + 1.0)
        unseen = np.where(self.jump[:, None], np.abs(x.real) <= 1, rho < seen(degree))
        return np.asarray(np.where(unseen, SHARE * missed, 0.0).max(axis=0))

    def close(self, nodes: Array) -> NDArray[np.bool_]:
        """Elements (n,) in which strains change faster than the nodes show."""
        return np.asarray(self._seen_from(nodes)[1].min(axis=0, initial=np.inf) < NEAR)

    def _seen_from(self, nodes: Array) -> tuple[Complex, Array]:
        """Places (k, n) in each element, -1 to 1 at its ends, and ellipses rho (k, n) there."""
        half = np.diff(nodes) / 2
        x = (self.places[:, None] - (nodes[:-1] + half)) / half
        # The larger of both roots is outside the unit circle.
        return x, np.abs(x + np.sqrt(x - 1) * np.sqrt(x + 1))

    def widths(self, positions: Array, degree: int, order: int, target: float) -> Array:
        """Largest widths (k,) at relative positions, for a local error `target`."""
        distance = np.maximum(np.abs(positions[:, None] - self.places), THINNEST)
        depth = np.where(self.fade, distance**2, np.maximum(np.abs(self.places.imag), THINNEST))
        larger = (self.sizes * depth / target) ** (1 / (order + 1))
        larger = np.maximum(larger, seen(degree))
        widths = 4 * distance / (larger - 1 / larger)
        # Beside a jump nothing is to be resolved: only the element that holds it is to be narrow.
        widths[:, self.jump] = np.maximum(distance, target / self.sizes / SHARE)[:, self.jump]
        matters = self.sizes * np.where(self.fade, distance**2, 1.0) > target
        return np.asarray(np.where(matters, widths, np.inf).min(axis=1))


def seen(degree: int) -> float:
    """Ellipse of an element from which on its stages show how a solution decays."""
    return float(SEEN ** (1 / degree))


def layers(trajectory: Trajectory, phase: int) -> Layers:
    """Return the singularities near a phase of a solution.

    None for shooting, which takes many steps in an element, none of which is known here.
    """
    stages = trajectory.dense.blocks.layout.stages
    rows = trajectory.singular_at_stages(phase) if stages else None
    if rows is None or not rows.size:
        return Layers.none()
    _, sigma, _, phases = trajectory.stages
    if len(trajectory.ends) > 2:
        a, b = trajectory.ends[phase : phase + 2]
        sigma = (sigma[phases == phase] - a) / (b - a)
    nodes = trajectory.nodes_within[phase]
    values = rows[:, :, 0] + 1j * rows[:, :, 1]
    step, change = (sigma[1:] - sigma[:-1])[:, None], values[1:] - values[:-1]
    widths = nodes[1:] - nodes[:-1]
    farthest = max(REACH * float(widths.max()), BEYOND)
    if not (np.abs(values[:-1]) * step <= farthest * np.abs(change)).any():
        return Layers.none()
    sizes = np.maximum(rows[:-1, :, 2], rows[1:, :, 2])
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = -values[:-1] / change  # in steps from one stage to the next
        offset = ahead * step
        near = (ahead.real > -BESIDE) & (ahead.real < 1 + BESIDE)
    # Those beyond an end are seen from there only.
    near[0] |= ahead.real[0] < 0
    near[-1] |= ahead.real[-1] > 1
    at = np.clip(np.searchsorted(nodes, sigma[:-1], side="right") - 1, 0, len(widths) - 1)
    reach = REACH * widths[at][:, None]
    reach[[0, -1]] = np.maximum(reach[[0, -1]], BEYOND)
    near &= (np.abs(offset) <= reach) & (step > 0)
    # In a moment that fades away everything is near to zero, and of no account.
    near &= sizes > FAINT * rows[:, :, 2].max()
    stage, which = np.nonzero(near)
    places, kind = sigma[stage] + offset[stage, which], rows[stage, which, 3]
    return Layers(places, sizes[stage, which], kind > 0, kind < 0)


def clear_of(
    trajectory: Trajectory, found: tuple[Layers, ...], thin: float
) -> Callable[[Array], NDArray[np.bool_]]:
    """Return what tells which fractions (k,) of the length are outside layers thinner than `thin`.

    What rounding does to the place of such a layer is more than strains in it can bear.
    """
    if all(not len(near) or near.fade.all() for near in found):
        return lambda fractions: np.ones(len(fractions), bool)
    places, depths = [], []
    for a, b, near in zip(trajectory.ends[:-1], trajectory.ends[1:], found, strict=True):
        z = near.places[~near.fade]
        beyond = np.maximum(np.maximum(-z.real, z.real - 1), 0.0)
        depths.append((b - a) * np.hypot(beyond, z.imag))
        places.append(a + (b - a) * z.real)
    depth, place = np.concatenate(depths), np.concatenate(places)
    depth, place = depth[depth < thin], place[depth < thin]

    def clear(fractions: Array) -> NDArray[np.bool_]:
        if not len(depth):
            return np.ones(len(fractions), bool)
        # Beside it strains change by its depth over the square of the distance.
        reach = np.sqrt(FADED * np.maximum(depth, THINNEST) * thin)
        away = np.abs(fractions[:, None] - place) > reach
        return np.asarray(away.all(axis=1))

    return clear


def between(
    trajectory: Trajectory, found: tuple[Layers, ...], growth: Array
) -> tuple[Array, NDArray[np.intp], NDArray[np.bool_]]:
    """Return where to look at a solution between nodes: fractions (k,) and their elements (k,).

    In elements of large `growth` (N,), and next to layers and in them: which that are is (N,) told
    too. In all of a low order, at whose ends errors may be far less than inside.
    """
    degree, nodes, ends = trajectory.dense.blocks.degree, trajectory.nodes, trajectory.ends
    chosen, extra = growth > WATCHED, [np.empty(0)]
    if any(map(len, found)):
        pairs = zip(found, trajectory.nodes_within, strict=True)
        chosen = chosen | np.concatenate([near.close(within) for near, within in pairs])
        extra += [
            a + (b - a) * near.places.real
            for a, b, near in zip(ends[:-1], ends[1:], found, strict=True)
        ]
    blocks = trajectory.dense.blocks
    # Steps of shooting begin anew where the algebraic variables may not be found.
    every = blocks.order <= LOW and (blocks.layout.nz == 0 or blocks.layout.stages > 0)
    elements = np.arange(len(nodes) - 1) if every else np.flatnonzero(chosen)
    if not len(elements):
        return np.empty(0), elements, chosen
    # The error of a collocation polynomial is largest at its stages.
    inside = _inside(max(3, degree))
    regular = (nodes[elements, None] + np.diff(nodes)[elements, None] * inside).ravel()
    fractions = np.concatenate([regular, *extra])
    fractions = fractions[(fractions > 0) & (fractions < 1)]
    return fractions, np.clip(np.searchsorted(nodes, fractions) - 1, 0, len(nodes) - 2), chosen


@lru_cache
def _inside(count: int) -> Array:
    """Gauss nodes (count,) in an element, from 0 to 1."""
    return np.asarray((1 + np.polynomial.legendre.leggauss(count)[0]) / 2)


def overlooked(trajectory: Trajectory, found: tuple[Layers, ...]) -> Array:
    """Local errors (N,) of elements that no stage can have seen; (1,) zero if there are none."""
    blocks = trajectory.dense.blocks
    if not any(map(len, found)):
        return np.zeros(1)
    lengths = np.diff(trajectory.ends) * trajectory.length
    parts = [
        length * near.overlooked(within, blocks.degree, blocks.order)
        if len(near)
        else np.zeros(len(within) - 1)
        for near, length, within in zip(found, lengths, trajectory.nodes_within, strict=True)
    ]
    return np.concatenate(parts)
