"""Shapes as a few kilobytes of text: columns of whole numbers of 16 bits, deflated, in base64.

A column of a shape is stored as offset + step q with q from -32767 to 32767, so that a number is
known to 2e-5 of the column's range, and what is no number has a sign of its own. Of q the second
differences are kept, which are small along a smooth curve: their high bytes are nearly all zero and
cost nothing. `page/data.js` reads what is written here.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.mechanics.rotations import quaternions_from
from ribbonopt.views.shape import Shape

#: of every row: arclength, centre line, quaternion of the directors, slope of the generatrix and
#: half-width as drawn, strains, the angle whose tangent is eta, force and moment in the lab frame,
#: energy per length
COLUMNS = (
    *("s", "x", "y", "z", "q0", "q1", "q2", "q3", "slant", "width", "u1", "u2", "u3", "angle"),
    *("nx", "ny", "nz", "mx", "my", "mz", "energy"),
)
LARGEST, NONE = 32767, -32768  # of the whole numbers, and what stands for none
HUGE = 1e30  # what is larger is no number that a page could draw
LEVEL = 9  # of deflate


def packed(shapes: Sequence[Shape]) -> str:
    """Return all rows of some shapes as text in base64."""
    return packed_tables([columns_of(shape) for shape in shapes])


def packed_tables(tables: Sequence[Array]) -> str:
    """Return tables of columns, (columns, k) each, as text in base64.

    It is, deflated: offset and step of every column of every table (float32), then the high bytes
    of all second differences, then the low bytes; of one table after the other, column by column.
    """
    scales, wholes = zip(*map(_whole, tables), strict=True)
    folded = np.concatenate([_folded(whole).ravel() for whole in wholes])
    high, low = (folded >> 8).astype(np.uint8), (folded & 255).astype(np.uint8)
    raw = np.concatenate(scales).astype("<f4").tobytes() + high.tobytes() + low.tobytes()
    return deflated(raw)


def deflated(raw: bytes) -> str:
    """Return bytes as text: deflated (zlib), in base64."""
    return base64.b64encode(zlib.compress(raw, LEVEL)).decode("ascii")


def columns_of(shape: Shape) -> Array:
    """Return the rows of a shape as columns, (len(COLUMNS), k)."""
    slant = np.einsum("ki,ki->k", shape.b, shape.d3)
    with np.errstate(invalid="ignore"):  # of failed results, which may hold anything
        turned = quaternions_from(np.stack([shape.d1, shape.d2, shape.d3], axis=2))
    parts = (
        *(shape.s, *shape.r.T, *turned.T, slant, shape.half_widths),
        *(shape.u1, shape.u2, shape.u3, np.arctan(shape.eta)),
        *(*shape.n.T, *shape.m.T, shape.energy),
    )
    return np.array(parts, dtype=float)


def _whole(table: Array) -> tuple[Array, NDArray[np.int64]]:
    """Return offsets and steps (columns, 2), and the columns as whole numbers."""
    known = np.abs(table) < HUGE
    low = np.where(known, table, np.inf).min(axis=1)
    high = np.where(known, table, -np.inf).max(axis=1)
    none = ~known.any(axis=1)
    low[none], high[none] = 0.0, 0.0
    offset = np.float32((low + high) / 2).astype(float)
    reach = np.maximum(high - offset, offset - low)
    # A column that is constant but for rounding is constant.
    reach[reach <= 1e-7 * np.maximum(np.abs(low), np.abs(high))] = 0.0
    step = np.nextafter(np.float32(reach / LARGEST), np.float32(np.inf)).astype(float)
    step[reach == 0] = 0.0
    even = np.where(step == 0, 1.0, step)[:, None]
    places = np.where(known, (table - offset[:, None]) / even, NONE)
    whole = np.where(known & (step[:, None] == 0), 0, np.rint(places)).astype(np.int64)
    return np.column_stack([offset, step]), whole


def _folded(whole: NDArray[np.int64]) -> NDArray[np.uint16]:
    """Return second differences along rows, modulo 2^16, small ones of either sign as small."""
    differences = np.diff(whole, n=2, axis=1, prepend=np.zeros((len(whole), 2), np.int64))
    short = differences.astype(np.uint16).astype(np.int16).astype(np.int64)
    return ((short << 1) ^ (short >> 63)).astype(np.uint16)
