"""Between which numbers quantities along ribbons are: one axis, one scale of colours for all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.views.shape import Shape

STEEPEST = 1.5  # eta, which is beyond any bound where u2 passes zero
HUGE = 1e30  # as in `packing`


def ranges_of(shapes: Sequence[Shape]) -> dict[str, list[float]]:
    """Return the least and the largest of what a page draws, by name; none of what has no numbers.

    Strains, eta (within bounds), energy per length, and along the directors force and moment.
    """
    found: dict[str, list[Array]] = {}
    for shape in shapes:
        for name, values in _drawn(shape).items():
            found.setdefault(name, []).append(values[np.abs(values) < HUGE])
    whole = {name: np.concatenate(parts) for name, parts in found.items()}
    return {name: [float(v.min()), float(v.max())] for name, v in whole.items() if len(v)}


def _drawn(shape: Shape) -> dict[str, Array]:
    frame = np.stack([shape.d1, shape.d2, shape.d3], axis=1)
    loads = {
        f"{name}{k + 1}": along[:, k]
        for name, vectors in (("n", shape.n), ("m", shape.m))
        for along in [np.einsum("kji,ki->kj", frame, vectors)]
        for k in range(3)
    }
    eta = np.clip(shape.eta, -STEEPEST, STEEPEST)
    strains = {"u1": shape.u1, "u2": shape.u2, "u3": shape.u3, "eta": eta}
    return {**strains, "energy": shape.energy, **loads}
