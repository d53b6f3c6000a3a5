"""A ribbon as steps that are to meet, and Newton's method that makes them meet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from .rod import Array, Law, along, cross, dot, step

DIFFERENCE = 1e-8  # relative, of difference quotients: Newton's method needs no more
MOST = 25
STALLED = 1e-7  # size of a step that may be rounding


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
            self.law, self.kind, self.n[:, None], self.moments[:, :-1], self.frames[:, :, :-1], self.h
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
        return np.minimum(
            *(self.law.distance(self.kind, own[:, e], force[:, e]) for e in ends)
        )


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
    return np.stack([1.5 * whole[i] - sum(gram[i][j] * whole[j] for j in range(3)) / 2 for i in range(3)])


def converged(path: Path, conditions: Callable[..., Array]) -> Path:
    """Return the path with all gaps closed; ArithmeticError if they cannot be."""
    least, stalls = np.inf, 0
    for _ in range(MOST):
        path, size = newton_step(path, conditions)
        stalls = stalls + 1 if size > least / 4 else 0
        least = min(least, size)
        # Where steps do not shrink any more they are rounding: how much of it, `coarse` tells.
        if size < 1e-14 or (size < STALLED and stalls > (size > 1e-10)):
            return path
    raise ArithmeticError(f"Newton's method did not converge: last step {size:.1e}")


def newton_step(path: Path, conditions: Callable[..., Array]) -> tuple[Path, float]:
    """Take one step; its size is the largest change, loads relative to themselves."""
    K, J = len(path.kind), len(path.switches)
    residual, matrix = linearised(path, conditions)
    scale = np.ones(6 * K + 6 + J)
    scale[6 * K : 6 * K + 3] = 1 + np.abs(path.n).max()
    scale[6 * K + 3 : 6 * K + 6] = 1 + np.abs(path.m0).max()
    if not np.isfinite(residual).all() or not np.isfinite(matrix.data).all():
        raise ArithmeticError("Newton's method met numbers that are not finite")
    try:
        change = splu(csc_matrix(matrix.multiply(scale))).solve(-residual)
    except RuntimeError as error:
        raise ArithmeticError("the linearised equations are singular") from error
    size = float(np.abs(change).max())
    change = change * scale * min(1.0, 0.3 / size)
    joints = change[: 6 * K].reshape(K, 6).T
    r, frames = path.r.copy(), path.frames.copy()
    r[:, 1:] += joints[:3]
    frames[:, :, 1:] = turned(frames[:, :, 1:], joints[3:])
    switches = path.switches + change[6 * K + 6 :]
    if (np.diff(np.concatenate([[0], switches, [path.length]])) <= 0).any():
        raise ArithmeticError("a phase vanishes")
    n, m0 = path.n + change[6 * K : 6 * K + 3], path.m0 + change[6 * K + 3 : 6 * K + 6]
    return replace(path, n=n, m0=m0, r=r, frames=frames, switches=switches), size


def linearised(path: Path, conditions: Callable[..., Array]) -> tuple[Array, csc_matrix]:
    """Residual of all equations and its Jacobian.

    Unknowns: changes (r, turn) of joints 1 ... K, of n, of m0, of the switches.
    """
    K, J = len(path.kind), len(path.switches)
    way, frame, R = propagated(path)  # R (6, K, 9): of turn, m, n at the step's start
    gaps = np.concatenate([path.r[:, :-1] + way - path.r[:, 1:], rotation(frame, path.frames[:, :, 1:])])
    rows, cols, values = [], [], []

    def put(row: Array, col: Array, value: Array) -> None:
        row, col, value = np.broadcast_arrays(row, col, value)
        rows.append(row.ravel())
        cols.append(col.ravel())
        values.append(value.ravel())

    n = skew(path.n)
    arms = skew(path.r - path.r[:, :1])  # m_k = m0 + n x arm
    k, i, j = np.ogrid[:K, :6, :3]
    own = np.moveaxis(R, 1, 0)  # (K, 6, 9)
    of_m = own[:, :, 3:6]
    of_r = of_m @ n + np.vstack([np.eye(3), np.zeros((3, 3))])
    of_n = own[:, :, 6:] - of_m @ np.moveaxis(arms, 2, 0)[:-1]
    put(6 * k[1:] + i, 6 * (k[1:] - 1) + j, of_r[1:])
    put(6 * k[1:] + i, 6 * (k[1:] - 1) + 3 + j, own[1:, :, :3])
    put(6 * k + i, 6 * K + j, of_n)
    put(6 * k + i, 6 * K + 3 + j, of_m)
    put(np.arange(6 * K), np.arange(6 * K), -np.ones(6 * K))
    ends = along(frame, path.moments[:, :-1] + cross(path.n[:, None], way))
    u2, u3 = path.law.strains(path.kind, ends, along(frame, path.n[:, None] + 0 * path.h))
    rate = np.concatenate([frame[2], u2 * frame[1] + u3 * frame[2]]) * path.fractions
    later, earlier = path.phases < J, path.phases > 0
    k, i = np.ogrid[:K, :6]
    put(6 * k[later] + i, 6 * K + 6 + path.phases[later][:, None], rate.T[later])
    put(6 * k[earlier] + i, 6 * K + 5 + path.phases[earlier][:, None], -rate.T[earlier])
    residual = [gaps.T.ravel()]
    row = 6 * K
    for g, slopes, at in switch_conditions(path, n, arms):
        # slopes (12,): of r, turn at the joint, of n, of m0
        put(row, 6 * (at - 1) + np.arange(6), slopes[:6])
        put(row, 6 * K + np.arange(6), slopes[6:])
        residual.append(np.array([g]))
        row += 1
    value, slopes = end_conditions(path, conditions)
    put(row + np.arange(6)[:, None], np.r_[6 * (K - 1) : 6 * K + 6][None], slopes)
    residual.append(value)
    size = 6 * K + 6 + J
    if row + 6 != size:
        raise ArithmeticError("the phases do not follow each other")
    triple = (np.concatenate(values), (np.concatenate(rows), np.concatenate(cols)))
    return np.concatenate(residual), csc_matrix(triple, shape=(size, size))


def propagated(path: Path) -> tuple[Array, Array, Array]:
    """Ways, frames, and derivatives (6, K, 9) of both with respect to turn, m, n at the start."""
    K = len(path.kind)
    m, d = path.moments[:, :-1], path.frames[:, :, :-1]
    eta = DIFFERENCE * np.repeat([1, 1 + np.abs(path.moments).max(), 1 + np.abs(path.n).max()], 3)
    ms, ds = np.repeat(m[:, None], 10, axis=1), np.repeat(d[:, :, None], 10, axis=2)
    ns = np.repeat(np.repeat(path.n[:, None, None], 10, axis=1), K, axis=2)
    for i in range(3):
        w = np.zeros((3, K))
        w[i] = eta[i]
        ds[:, :, 1 + i] = turned(d, w)
        ms[i, 4 + i] += eta[3 + i]
        ns[i, 7 + i] += eta[6 + i]
    way, frame, _ = step(path.law, path.kind, ns, ms, ds, path.h)
    base_way, base = way[:, 0], frame[:, :, 0]
    of_way = way[:, 1:] - way[:, :1]
    of_frame = rotation(frame[:, :, 1:], np.broadcast_to(base[:, :, None], frame[:, :, 1:].shape))
    slopes = np.concatenate([of_way, of_frame]) / eta[None, :, None]
    return base_way, base, np.moveaxis(slopes, 1, 2)


def switch_conditions(path: Path, n: Array, arms: Array) -> list[tuple[float, Array, int]]:
    """Values and slopes of what holds where phases meet, with the joint."""
    found = []
    joints = np.flatnonzero(np.diff(path.phases)) + 1
    for i, at in enumerate(joints):
        before, after = path.kinds[i : i + 2]
        d, m = path.frames[:, :, at], path.moments[:, at]

        def component(a: int, vector: Array, of_m: bool) -> tuple[float, Array]:
            slopes = np.zeros(12)
            slopes[3:6] = np.cross(d[a], vector)
            if of_m:
                slopes[:3] = d[a] @ n
                slopes[6:9], slopes[9:] = -d[a] @ arms[:, :, at], d[a]
            else:
                slopes[6:9] = d[a]
            return float(d[a] @ vector), slopes

        (m1, of1), (m2, of2), (m3, of3) = (component(a, m, True) for a in range(3))
        if before != 0:
            found.append((m2, of2, int(at)))
        if after == 0:
            n1, of = component(0, path.n, False)
            found.append((n1 + m1 * m3 / 4, of + (m1 * of3 + m3 * of1) / 4, int(at)))
    return found


def end_conditions(path: Path, conditions: Callable[..., Array]) -> tuple[Array, Array]:
    """Values (6,) and slopes (6, 12): of r, turn at the far end, of n, of m0."""
    r, d = path.r[:, -1], path.frames[:, :, -1]
    value = conditions(r, d, path.n, path.m0)
    slopes = np.empty((6, 12))
    eta = DIFFERENCE * np.repeat([1, 1, 1 + np.abs(path.n).max(), 1 + np.abs(path.m0).max()], 3)
    for i in range(12):
        e = np.zeros(12)
        e[i] = eta[i]
        moved = conditions(r + e[:3], turned(d, e[3:6]), path.n + e[6:9], path.m0 + e[9:])
        slopes[:, i] = (moved - value) / eta[i]
    return value, slopes


def skew(v: Array) -> Array:
    """Matrices (3, 3, ...) of v x."""
    zero = 0 * v[0]
    return np.array([[zero, -v[2], v[1]], [v[2], zero, -v[0]], [-v[1], v[0], zero]])
