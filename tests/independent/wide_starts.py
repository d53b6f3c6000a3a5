"""Where Newton's method begins for wide ribbons, and meshes that suit where it leads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from .joining import Conditions, closed
from .joints import Joints, graded
from .rod import Array, Law, along, shot
from .wide import ETA, ROWS, D, E, M, N, P, R, Wide, _large, _small

LOCAL = 3e-15  # error of one step that is let be


def g_of(xi: Array) -> Array:
    """Return g (k,) at xi (k,)."""
    a = np.abs(xi)
    large = np.exp(np.minimum(_large(np.maximum(a, 1.0))[0], 200))
    return np.sign(xi) * np.where(a < 1, _small(np.minimum(a, 1.0))[0], large)


def meshed(
    law: Wide,
    states: Callable[[Array], Array],
    ends: Sequence[float],
    inflections: tuple[bool, bool] = (False, False),
) -> Joints:
    """Return joints on graded meshes, with states (22, k) at arclengths (k,) from a function.

    `ends` are those of the phases; `inflections`: whether each end of the ribbon is one, too.
    """
    ends = np.asarray(ends, float)
    count = len(ends) - 1
    fractions, phases = [], []
    for i in range(count):
        ratio = law.width / (ends[i + 1] - ends[i])
        sides = (i > 0 or inflections[0], i < count - 1 or inflections[1])
        widths = np.diff(graded(ratio, *sides))
        fractions.append(widths)
        phases += [i] * len(widths)
    joints = Joints(law, ends, np.concatenate(fractions), np.array(phases), np.empty((ROWS, 0)))
    return replace(joints, y=states(joints.s))


def narrow(
    law: Wide, n: Array, m0: Array, place: Array, frame: Array, length: float, straight: Sequence
) -> Callable[[Array], Array]:
    """States of the ribbon without width under these loads, eta bent to what its rate allows.

    `straight`: arclengths at which eta = 0.
    """
    start = shot(Law("sadowsky"), n, m0, place, frame, length)

    def states(s: Array) -> Array:
        y = np.zeros((ROWS, len(s)))
        fine = np.linspace(0, length, 4001)
        found, xi, u2 = eta_along(fine)
        r, frames = start(np.clip(s, 0, length))
        y[R], y[D] = r.T, np.moveaxis(frames, 0, 2).reshape(9, -1)
        y[N] = n[:, None]
        y[M] = (m0 + np.cross(n, r - place)).T
        y[ETA] = np.interp(s, fine, found)
        xi, u2 = np.interp(s, fine, xi), np.interp(s, fine, u2)
        phi = np.where(np.abs(xi) < 1e-6, 1, xi / np.tanh(np.where(xi == 0, 1, xi)))
        y[P] = law.width / 2 * (u2 * phi * (1 + y[ETA] ** 2)) ** 2 * g_of(xi)
        return y

    def eta_along(s: Array) -> tuple[Array, Array, Array]:
        r, frames = start(s)
        own = along(np.moveaxis(frames, 0, 2), (m0 + np.cross(n, r - place)).T)
        u2, u3 = Law("sadowsky").strains(np.where(own[1] < 0, -1, 1), own, own)
        eta = u3 / u2
        for at in straight:
            eta = eta * (1 - np.exp(-np.sqrt(24) / law.width * np.abs(s - at)))
        most = 1.8 / law.width * (s[1] - s[0])
        # A mean over about the width, and no steeper than developable strips may be.
        half = max(1, int(law.width / 4 / (s[1] - s[0])))
        mean = np.convolve(np.pad(eta, half, "edge"), np.ones(2 * half + 1) / (2 * half + 1))
        steep = mean[2 * half : -2 * half]
        for at in straight:
            steep[int(np.argmin(np.abs(s - at)))] = 0
        for i in range(1, len(s)):
            steep[i] = np.clip(steep[i], steep[i - 1] - most, steep[i - 1] + most)
        rate = np.clip(np.gradient(steep, s) * law.width / 2, -0.95, 0.95)
        return steep, np.arctanh(rate), u2

    return states


def polished(
    joints: Joints, conditions: Conditions, rounds: int = 5, doubled: bool = True
) -> tuple[Joints, Joints]:
    """Return the equilibrium and that on steps twice as long: their difference is its error."""
    joints = closed(joints, conditions)
    for _ in range(rounds):
        parts = wanted_parts(joints)
        if parts.max() == 1:
            break
        joints = closed(joints.split(parts), conditions)
    if not doubled:
        return joints, joints
    return closed(joints.split(np.full(len(joints.h), 2)), conditions), joints


def wanted_parts(joints: Joints) -> Array:
    """Parts (K,) into which steps are to be split, from what halves make of them."""
    whole = joints.steps()
    half = joints.split(np.full(len(joints.h), 2)).steps()
    half[E, 1::2] += half[E, ::2]
    size = np.ones(ROWS)
    for part in (N, M, P, E):
        size[part] = 1 + np.abs(whole[part]).max()
    whole[E + 1], half[E + 1] = 0, 0  # the work of loads is of no concern
    error = (np.abs(whole - half[:, 1::2]) / size[:, None]).max(axis=0)
    parts = np.ceil(np.maximum(error / LOCAL, 1e-9) ** (1 / 9) * 1.1)
    return np.where(error > LOCAL, np.clip(parts, 2, 8), 1).astype(int)
