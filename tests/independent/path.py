"""A ribbon as steps that are to meet, in phases on one sheet of the law each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .rod import Array, Law, along, cross, dot, step


@dataclass(frozen=True, eq=False)
class Path:
    """Steps k = 0 ... K - 1 in phases, with places r (3, K + 1) and frames (3, 3, K + 1)."""

    law: Law
    kinds: tuple[int, ...]
    fractions: Array
    phases: Array
    switches: Array
    length: float
    n: Array
    m0: Array
    r: Array
    frames: Array

    @cached_property
    def lengths(self) -> Array:
        """Lengths of the phases."""
        return np.diff(np.concatenate([[0.0], self.switches, [self.length]]))

    @cached_property
    def h(self) -> Array:
        """Lengths (K,) of the steps."""
        return self.fractions * self.lengths[self.phases]

    @cached_property
    def s(self) -> Array:
        """Arclengths (K + 1,) of the joints; exact where phases meet."""
        s = np.concatenate([[0.0], np.cumsum(self.h)])
        first = np.flatnonzero(np.diff(self.phases)) + 1
        s[first], s[-1] = self.switches, self.length
        return s

    @cached_property
    def kind(self) -> Array:
        """Kinds (K,) of the steps."""
        return np.array(self.kinds)[self.phases]

    @cached_property
    def moments(self) -> Array:
        """Moments (3, K + 1) at the joints, lab frame."""
        return self.m0[:, None] + cross(self.n[:, None], self.r - self.r[:, :1])

    @property
    def at_joints(self) -> tuple[Array, Array]:
        """Places (K + 1, 3) and frames (K + 1, 3, 3)."""
        return self.r.T, np.moveaxis(self.frames, 2, 0)

    def steps(self) -> tuple[Array, Array, Array]:
        """Way gone, frame at the end and energy of all steps."""
        return step(
            self.law,
            self.kind,
            self.n[:, None],
            self.moments[:, :-1],
            self.frames[:, :, :-1],
            self.h,
        )

    @cached_property
    def energy(self) -> float:
        """Strain energy."""
        return float(self.steps()[2].sum())

    def split(self, parts: Array) -> Path:
        """Return the path with every step in equal parts (K,)."""
        widths = np.repeat(self.fractions / parts, parts)
        phases = np.repeat(self.phases, parts)
        empty = replace(self, fractions=widths, phases=phases)
        first = np.concatenate([[0], np.cumsum(parts)])
        r, frames = (np.empty((*x.shape[:-1], len(empty.s))) for x in (self.r, self.frames))
        within = np.arange(len(widths)) - np.repeat(first[:-1], parts)
        owner = np.repeat(np.arange(len(parts)), parts)
        way, frame, _ = self.partial(owner, self.h[owner] * within / parts[owner])
        r[:, :-1], frames[:, :, :-1] = self.r[:, owner] + way, frame
        r[:, first], frames[:, :, first] = self.r, self.frames
        return replace(empty, r=r, frames=frames)

    def partial(self, k: Array, h: Array) -> tuple[Array, Array, Array]:
        """Parts of length h (j,) of the steps k (j,)."""
        return step(
            self.law, self.kind[k], self.n[:, None], self.moments[:, k], self.frames[:, :, k], h
        )

    def places(self, s: Array) -> tuple[Array, Array]:
        """Places (k, 3) and frames (k, 3, 3) at arclengths (k,)."""
        found = self.at(s)
        return found["r"], np.stack([found[f"d{i}"] for i in (1, 2, 3)], axis=1)

    def at(self, s: Array) -> dict[str, Array]:
        """Everything at arclengths (k,): r, d1, d2, d3, n, m in the lab frame, u, n1 ... m3, H."""
        s = np.asarray(s, float)
        k = np.clip(np.searchsorted(self.s, s, side="right") - 1, 0, len(self.kind) - 1)
        way, frame, _ = self.partial(k, s - self.s[k])
        r = self.r[:, k] + way
        n = self.n[:, None] + 0 * s
        m = self.moments[:, k] + cross(n, way)
        own, force = along(frame, m), along(frame, n)
        u2, u3 = self.law.strains(self.kind[k], own, force)
        result = {"r": r.T, "n": n.T, "m": m.T, "u": np.stack([0 * s, u2, u3], axis=1)}
        result |= {f"d{i + 1}": frame[i].T for i in range(3)}
        result |= {"u2": u2, "u3": u3, "H": force[2] + (own[1] * u2 + own[2] * u3) / 2}
        result |= {f"n{i + 1}": force[i] for i in range(3)}
        return result | {f"m{i + 1}": own[i] for i in range(3)}

    def length_scales(self) -> Array:
        """Distance of each step to the nearest singularity, the lesser of its two ends."""
        d = self.frames
        own, force = along(d, self.moments), along(d, self.n[:, None] + 0 * self.s)
        ends = (slice(None, -1), slice(1, None))
        return np.minimum(*(self.law.distance(self.kind, own[:, e], force[:, e]) for e in ends))


def rotation(frame: Array, other: Array) -> Array:
    """Rotation vectors (3, ...) from one frame to another that is near: zero where they agree."""
    return sum(cross(other[i], frame[i]) for i in range(3)) / 2


def turned(frame: Array, w: Array) -> Array:
    """Frames turned by rotation vectors w (3, ...), exactly frames: Cayley's formula."""
    t = w / 2
    factor = 2 / (1 + dot(t, t))
    new = []
    for d in frame:
        first = cross(t, d)
        new.append(d + factor * (first + cross(t, first)))
    d1, d2, d3 = new
    # Rounding of frames must not add up.
    gram = [[dot(a, b) for b in (d1, d2, d3)] for a in (d1, d2, d3)]
    whole = np.stack([d1, d2, d3])
    return np.stack(
        [1.5 * whole[i] - sum(gram[i][j] * whole[j] for j in range(3)) / 2 for i in range(3)]
    )
