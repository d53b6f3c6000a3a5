"""Zero modes: motions that cost nothing, told by name and not counted among the vibrations.

Rigid motions that the conditions allow, sliding of a closed band along itself, the spin of an
isotropic rod. They are known beforehand; which of the modes that were found they are is told by the
part of its displacements that is one of theirs, and by an omega^2 that is next to nothing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ribbonopt.accuracy.spin import SPIN, spins
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.catalogue import capabilities

from ..variation import Variation
from .kinetic import Kinetic, sections_of
from .lowest import Spectrum
from .stated import Vibrating

FREE = 1e-8  # change of the conditions by a motion that they allow
OTHER = 1e-3  # part of the displacements of a zero mode that is no such motion, squared
SMALL = 0.1  # omega^2 of one over the shift: the mesh alone makes it differ from zero
STILL = 1e-20  # square of a displacement that is none
AXIS = 1e-9  # of a direction along an axis of the lab
TURNING = "sections turning about the line"
SLIDING = "sliding along itself"


@dataclass(frozen=True, eq=False)
class Neutral:
    """Motions that may cost nothing: their names, and what they move.

    `fields` (3 N K, j) are displacements of the stages times the roots of their masses, orthonormal
    in the order of the names; one that others make up already has none, and no name. `turns` says
    whether sections that have inertia may turn about the line at no cost, which displaces nothing.
    """

    words: tuple[str, ...]
    fields: Array
    turns: bool = False

    @property
    def most(self) -> int:
        """How many zero modes there may be."""
        return len(self.words) + self.turns

    @classmethod
    def of(cls, what: Vibrating, variation: Variation, energy: Kinetic) -> Neutral:
        """Return what the conditions of a ribbon allow at no cost."""
        motions = _allowed(what, variation)
        isotropic = capabilities(what.posed.scene).spins
        spin = isotropic and (what.pieces > 1 or spins(what.solution))
        if not (motions.size or what.slides or spin):
            return cls((), np.empty((3 * len(energy.weights), 0)))
        r, _, d3 = sections_of(what.ribbon.model, variation.stages.x)
        first, _, tangent = sections_of(what.ribbon.model, variation.stages.ends)
        named = [(_name(motion), motion[:3] + np.cross(motion[3:], r)) for motion in motions.T]
        named += [(SPIN, np.cross(tangent[0], r - first[0]))] if spin else []
        named += [(SLIDING, d3)] if what.slides else []
        words, fields = [], np.empty((3 * len(r), 0))
        for name, moved in named:
            field = (np.sqrt(energy.weights)[:, None] * moved).ravel()
            rest = field / np.linalg.norm(field)
            for _ in range(2):
                rest = rest - fields @ (fields.T @ rest)
            if rest @ rest > OTHER:
                words.append(name)
                fields = np.column_stack([fields, rest / np.linalg.norm(rest)])
        heavy = energy.rows.shape[1] > 3 * variation.stages.tableau.degree
        return cls(tuple(words), fields, isotropic and heavy)

    def among(self, found: Spectrum, energy: Kinetic) -> NDArray[np.bool_]:
        """Return which of the modes (k,) that were found are zero modes."""
        if not self.words:
            return np.zeros(len(found.squared), dtype=bool)
        moved = self._displaced(found, energy)
        size = (moved**2).sum(axis=0)
        rest = size - ((self.fields.T @ moved) ** 2).sum(axis=0)
        small = np.abs(found.squared) <= SMALL * found.shift
        among: NDArray[np.bool_] = small & (size > STILL) & (rest <= OTHER * size)
        if self.turns:
            among |= small & (size <= OTHER)
        return among

    def names(self, found: Spectrum, energy: Kinetic) -> tuple[str, ...]:
        """Return the names of the motions that zero modes make."""
        zero = self.among(found, energy)
        q, _ = np.linalg.qr(self._displaced(found, energy)[:, zero])
        made = ((q.T @ self.fields) ** 2).sum(axis=0) if self.words else []
        told = [word for word, part in zip(self.words, made, strict=True) if part > 0.5]
        return (*told, *[TURNING] * (int(zero.sum()) - len(told)))

    def _displaced(self, found: Spectrum, energy: Kinetic) -> Array:
        """Displacements (3 N K, k) of modes, times the roots of masses."""
        moved = energy.rows @ found.modes
        by_stage = moved.reshape(len(energy.weights), -1, moved.shape[2])
        displaced: Array = by_stage[:, :3].reshape(-1, moved.shape[2])
        return displaced


def _allowed(what: Vibrating, variation: Variation) -> Array:
    """Rigid motions (6, k) that the conditions allow: translations, and turns about the origin.

    Reduced to such as are about one axis of the lab, or along it, where there are any.
    """
    model, ends = what.ribbon.model, variation.stages.ends
    if ends.shape[1] != len(model.states):
        return np.empty((6, 0))  # held between the ends
    c, motions = np.zeros(len(model.constants)), model.motions
    both = np.vstack([model.moved(x, c, np.zeros(3))[0] @ motions for x in ends])
    _, singular, right = np.linalg.svd(variation.form.C @ both)
    sizes = np.zeros(len(right))
    sizes[: len(singular)] = singular
    free = motions @ right[sizes <= FREE * np.linalg.norm(variation.form.C)].T
    return _reduced(free)


def _reduced(motions: Array) -> Array:
    """Echelon form of motions (6, k): translations, then turns, each about another axis."""
    rows = np.roll(motions.T, 3, axis=1)
    at = 0
    for column in range(6):
        if at == len(rows):
            break
        pivot = at + int(np.abs(rows[at:, column]).argmax())
        if abs(rows[pivot, column]) < FREE:
            continue
        rows[[at, pivot]] = rows[[pivot, at]]
        rows[at] /= rows[at, column]
        others = np.arange(len(rows)) != at
        rows[others] -= np.outer(rows[others, column], rows[at])
        at += 1
    turns = int((np.abs(rows[:, :3]).max(axis=1, initial=0.0) > FREE).sum())
    found: Array = np.roll(np.roll(rows, -turns, axis=0), -3, axis=1).T
    return found


def _name(motion: Array) -> str:
    """Name a rigid motion (6,): a translation, or a turn."""
    translation, turn = motion[:3], motion[3:]
    turned = bool(np.abs(turn).max() > AXIS)
    along = turn if turned else translation
    along = along / np.linalg.norm(along)
    kind = "rotation about" if turned else "translation along"
    axis = int(np.abs(along).argmax())
    if abs(along[axis]) > 1 - AXIS:
        return f"{kind} {'xyz'[axis]}"
    x, y, z = along
    return f"{kind} ({x:.4g}, {y:.4g}, {z:.4g})"
