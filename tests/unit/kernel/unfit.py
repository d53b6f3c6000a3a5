"""Arrays that do not fit, each in its own way."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ribbonopt.arrays import Array

Change = Callable[[Array], Any]
SETTINGS = 1e-13, 0.1, 0.3, 1e-4, 1e-13, 20


def locked(array: Array) -> Array:
    """Return an array that must not be written to."""
    array.setflags(write=False)
    return array


def apart(array: Array) -> Array:
    """Return the same numbers with gaps between them."""
    return np.repeat(array, 2)[::2]


UNFIT: dict[str, Change] = {
    "one less": lambda a: a[:-1].copy(),
    "one more": lambda a: np.append(a, 0.0),
    "none": lambda a: a[:0].copy(),
    "single precision": lambda a: a.astype(np.float32),
    "single precision, as many bytes": lambda a: np.zeros(2 * a.size, np.float32),
    "whole": lambda a: a.astype(np.int64),
    "complex": lambda a: a.astype(complex),
    "other byte order": lambda a: a.astype(">f8"),
    "extended": lambda a: a.astype(np.longdouble),
    "objects": lambda a: a.astype(object),
    "gaps": apart,
    "backwards": lambda a: a.copy()[::-1],
    "list": lambda a: a.tolist(),
    "bytes": lambda a: a.tobytes(),
    "nothing": lambda a: None,
    "number": lambda a: 1.0,
    "text": lambda a: "numbers",
}
ERRORS = TypeError, ValueError, BufferError
