"""Meshes that share the error evenly: where nodes go, and how many elements a tolerance needs.

With the local error e_i of element i of width h_i growing as h^(p + 1), the density of nodes that
makes all errors equal is e_i^(1 / (p + 1)) / h_i.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array

SIZES = tuple(sorted({2 * round(5 * 2 ** (k / 4)) for k in range(-4, 29)}))  # even
FLOOR = 1e-17  # local errors below are rounding
EVEN = 0.02  # share of the mean density that every element has at least
STEEPEST = 8.0  # most that a mesh becomes finer, or coarser, at a place in one step


def redistributed(widths: Array, local: Array, order: int, count: int) -> Array:
    """Return relative widths (count,) that share the local errors (n,) of a mesh (n,) evenly."""
    parts = np.maximum(local, FLOOR) ** (1 / (order + 1))
    density = parts / widths
    density = np.maximum(density, EVEN * parts.sum())
    density = np.clip(density * widths / parts.mean(), 1 / STEEPEST, STEEPEST) / widths
    # Neighbours alike: one element that knows of an error warns those beside it.
    padded = np.pad(density, 1, mode="edge")
    density = np.maximum(density, 0.5 * np.maximum(padded[:-2], padded[2:]))
    nodes = np.concatenate([[0.0], np.cumsum(widths)])
    share = np.concatenate([[0.0], np.cumsum(density * widths)])
    wanted = np.interp(np.linspace(0, share[-1], count + 1), share, nodes / nodes[-1])
    wanted[0], wanted[-1] = 0.0, 1.0
    return np.asarray(np.diff(wanted))


def elements_for(local: Array, order: int, reduction: float) -> int:
    """Return the number of elements, evenly loaded, that reduce the sum of local errors so far."""
    local = np.maximum(local, FLOOR)
    parts = (local ** (1 / (order + 1))).sum()
    # n elements of error (parts / n)^(order + 1) each.
    count = (parts ** (order + 1) / (local.sum() * reduction)) ** (1 / order)
    return int(np.ceil(count))


def size_for(count: int) -> int:
    """Return the number of elements that is built for a number wanted: few sizes serve all."""
    return next((size for size in SIZES if size >= count), SIZES[-1])
