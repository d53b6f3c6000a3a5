"""Calls of CasADi functions on numpy arrays, at the price of the arithmetic."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

SHARED = (1, 2)  # inputs of a stage function that all stages have in common
LARGEST = 64  # stages of a block


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
    return function.map(f"{function.name()}_map", "serial", count, list(SHARED), [])


class Mapped:
    """A stage function over any number of stages that share constants and parameters.

    Called in blocks of 1, 2, 4 ... stages, straight on the arrays given: what is built serves every
    mesh, so that neither memory nor time to build grows with the number of meshes.
    """

    def __init__(self, function: ca.Function) -> None:
        self._function = function
        self._inputs = [function.numel_in(i) for i in range(function.n_in())]
        self._outputs = [function.numel_out(i) for i in range(function.n_out())]
        if self._outputs != [function.nnz_out(i) for i in range(function.n_out())]:
            raise ValueError(f"{function.name()} is expected to have dense outputs")
        self._blocks: dict[int, tuple[Any, Any]] = {}

    def __call__(self, *values: Array) -> list[Array]:
        """Evaluate at all stages: one flat array for each output."""
        arguments = [np.ascontiguousarray(value, dtype=float).ravel() for value in values]
        count = len(arguments[0]) // self._inputs[0]
        for i, (argument, size) in enumerate(zip(arguments, self._inputs, strict=True)):
            wanted = size if i in SHARED else count * size
            if len(argument) != wanted:  # CasADi would read beyond it
                raise ValueError(f"argument {i} is expected to have {wanted} numbers")
        results = [np.empty(count * size) for size in self._outputs]
        varying = [i for i in range(len(arguments)) if i not in SHARED]
        for at, block in _plan(count):
            buffer, evaluate = self._block(block)
            for i in SHARED:
                buffer.set_arg(i, arguments[i].data)
            for i in varying:
                size = self._inputs[i]
                buffer.set_arg(i, arguments[i].data[at * size : (at + block) * size])
            for i, size in enumerate(self._outputs):
                buffer.set_res(i, results[i].data[at * size : (at + block) * size])
            evaluate()
        return results

    def _block(self, count: int) -> tuple[Any, Any]:
        """Buffer and evaluation of a block of stages, built once."""
        if count not in self._blocks:
            self._blocks[count] = shared_map(self._function, count).buffer()
        return self._blocks[count]


@lru_cache(maxsize=1024)
def _plan(count: int) -> tuple[tuple[int, int], ...]:
    """First stage and size of every block; the last may do some stages once more."""
    whole, rest = divmod(count, LARGEST)
    plan = [(i * LARGEST, LARGEST) for i in range(whole)]
    if rest:
        block = 1 << (rest.bit_length() - 1)
        plan.append((count - rest, block))
        if left := rest - block:
            block = 1 << (left - 1).bit_length()
            plan.append((count - block, block))
    return tuple(plan)


@lru_cache(maxsize=64)
def buffered(function: ca.Function) -> Buffered:
    """Return a function with its buffers, made once."""
    return Buffered(function)


@lru_cache(maxsize=64)
def mapped(function: ca.Function) -> Mapped:
    """Return a stage function to be called over stages, made once."""
    return Mapped(function)
