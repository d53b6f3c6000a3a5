"""Arrays of numbers out of an archive (`.npz`): its entries are checked before they are read.

numpy believes what an entry says of itself; here an entry must be as long as it says, its numbers
of the kind that is expected, and together no more than the file may hold.
"""

from __future__ import annotations

import io
import math
import os
import zipfile
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.reading import MEGA, Kind, read_bytes

ARCHIVE = Kind("an archive of arrays, as ribbonopt writes it", most=1000 * MEGA)


class Row(NamedTuple):
    """One array that is expected: its name, whether its numbers are whole, how many axes it has."""

    name: str
    whole: bool = False
    optional: bool = False
    axes: int = 1


def arrays_of(path: str | os.PathLike[str], rows: Sequence[Row]) -> dict[str, Array]:
    """Return arrays of an archive by name, (k,) unless a row says more, of floats or whole numbers.

    Raises
    ------
    OutputError
        If it is no file that may be read.
    ValueError
        Says what is wrong with it.
    """
    data = read_bytes(path, ARCHIVE)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as file:
            known = {info.filename: info for info in file.infolist()}
            found = {}
            for row in rows:
                info = known.get(f"{row.name}.npy")
                if info is not None:
                    found[row.name] = _array(row, _entry(file, info, len(data)))
                elif not row.optional:
                    raise _UnsoundError(f"{row.name}: missing")
            return found
    except _UnsoundError:
        raise
    except Exception as error:  # bytes that are no archive raise what they like
        raise _UnsoundError(f"no archive of arrays, {type(error).__name__}") from None


class _UnsoundError(ValueError):
    """An archive that is none of ours."""


def _entry(file: zipfile.ZipFile, info: zipfile.ZipInfo, most: int) -> bytes:
    """Return the bytes of an entry; as ribbonopt packs none, none is larger than the file."""
    if info.file_size > most:
        raise _UnsoundError(f"{info.filename}: is larger than the file; expected it not packed")
    return file.read(info)


def _array(row: Row, data: bytes) -> Array:
    file = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(file)
        if version != (1, 0):
            raise ValueError("version")
        shape, turned, dtype = np.lib.format.read_array_header_1_0(file)
    except Exception:  # what stands there is read as Python, which may be anything
        raise _UnsoundError(f"{row.name}: expected an array") from None
    kinds = "iu" if row.whole else "f"
    # An array of nothing has no kind of its own.
    sound = dtype.kind in kinds or (shape == (0,) and dtype.kind in "iuf")
    if len(shape) != row.axes or not sound or (turned and row.axes > 1):
        numbers = "whole numbers" if row.whole else "numbers"
        expected = f"a row of {numbers}" if row.axes == 1 else f"{numbers} along {row.axes} axes"
        raise _UnsoundError(f"{row.name}: found {_told(shape, dtype)}, expected {expected}")
    rest, count = data[file.tell() :], math.prod(shape)
    if count * dtype.itemsize != len(rest):
        raise _UnsoundError(f"{row.name}: says that it has {count} numbers, has {len(rest)} bytes")
    array = np.frombuffer(rest, dtype=dtype).reshape(shape)
    return array.astype(np.int64 if row.whole else float)


def _told(shape: tuple[int, ...], dtype: np.dtype[Any]) -> str:
    return f"an array {shape} of {dtype.name}"[:80]
