"""Calls of CasADi functions on numpy arrays, at the price of the arithmetic."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array


class Buffered:
    """A CasADi function called through preallocated, contiguous arrays.

    Arguments and results are flat, columns first: the transpose of a C-ordered array.
    """

    def __init__(self, function: ca.Function) -> None:
        self.arguments = [np.zeros(function.numel_in(i)) for i in range(function.n_in())]
        self.results = [np.zeros(function.numel_out(i)) for i in range(function.n_out())]
        # The buffer must outlive every evaluation.
        self._buffer, self._evaluate = function.buffer()
        # The stubs describe the C++ signature, pointer and size, not the Python one.
        set_argument: Any = self._buffer.set_arg
        set_result: Any = self._buffer.set_res
        for i, array in enumerate(self.arguments):
            set_argument(i, array.data)
        for i, array in enumerate(self.results):
            set_result(i, array.data)

    def __call__(self, *values: Array) -> list[Array]:
        """Evaluate: one flat array for each output."""
        for array, value in zip(self.arguments, values, strict=True):
            array[:] = value.ravel()
        self._evaluate()
        return [result.copy() for result in self.results]


def shared_map(function: ca.Function, count: int) -> ca.Function:
    """Map a stage function over `count` stages that share constants and parameters."""
    shared = [1, 2]
    return function.map(f"{function.name()}_map", "serial", count, shared, [])


@lru_cache(maxsize=64)
def buffered(function: ca.Function) -> Buffered:
    """Return a function with its buffers, made once."""
    return Buffered(function)


@lru_cache(maxsize=256)
def buffered_map(function: ca.Function, count: int) -> Buffered:
    """Return `shared_map` with its buffers, made once."""
    return Buffered(shared_map(function, count))
