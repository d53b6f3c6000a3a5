"""Calls of CasADi functions on numpy arrays, at the price of the arithmetic."""

from __future__ import annotations

from bisect import bisect_left
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.kernel.programs import program_of

SHARED = (1, 2)  # inputs of a stage function that all stages have in common
SHARED_MASK = sum(1 << i for i in SHARED)
SIZES = (1, 2, *range(4, 65, 4))  # stages of blocks
LARGEST = SIZES[-1]


class Buffered:
    """A CasADi function called through preallocated, contiguous arrays.

    Arguments and results are flat, columns first: the transpose of a C-ordered array.
    """

    def __init__(self, function: ca.Function) -> None:
        self.program = program_of(function)
        self._sizes = [function.numel_out(i) for i in range(function.n_out())]
        if self.program is None:
            self._allocate(function)

    def _allocate(self, function: ca.Function) -> None:
        self.arguments = [np.zeros(function.numel_in(i)) for i in range(function.n_in())]
        self.results = [np.zeros(function.numel_out(i)) for i in range(function.n_out())]
        # The buffer must outlive every evaluation.
        self._buffer, self.evaluate = function.buffer()
        # The stubs describe the C++ signature, pointer and size, not the Python one.
        set_argument: Any = self._buffer.set_arg
        set_result: Any = self._buffer.set_res
        for i, array in enumerate(self.arguments):
            set_argument(i, array.data)
        for i, array in enumerate(self.results):
            set_result(i, array.data)

    def __call__(self, *values: Array) -> list[Array]:
        """Evaluate: one flat array for each output."""
        if self.program is not None:
            results = [np.empty(size) for size in self._sizes]
            self.program.map(1, 0, *map(plain, values), *results)
            return results
        for array, value in zip(self.arguments, values, strict=True):
            array[:] = value.ravel()
        self.evaluate()
        return [result.copy() for result in self.results]


def plain(values: Array) -> Array:
    """Return numbers in double precision, without gaps: as compiled code reads them."""
    return np.ascontiguousarray(values, dtype=float)


class Accumulated:
    """States after each of many steps (x, shared .., varying ..) -> x, one from the other.

    `shared` inputs follow the state, then those that each step has of its own. Without the kernel
    steps are taken in blocks of few sizes, the last filled up with steps whose own inputs are zero.
    """

    def __init__(self, step: ca.Function, shared: int) -> None:
        self._step, self._shared = step, shared
        self._mask = sum(1 << i for i in range(1, 1 + shared))
        self._sizes = [step.numel_in(i) for i in range(step.n_in())]
        self._blocks: dict[int, Buffered] = {}
        self.program = program_of(step)

    def __call__(self, state: Array, *values: Array) -> Array:
        """Return the states (k, nx) after each of k steps from a state (nx,)."""
        arguments = [plain(value) for value in (state, *values)]
        count = arguments[-1].size // self._sizes[-1]
        states = np.empty((count, self._sizes[0]))
        if self.program is not None:
            self.program.accumulate(count, self._mask, *arguments, states)
            return states
        for at in range(0, count, LARGEST):
            taken = min(count - at, LARGEST)
            size = SIZES[bisect_left(SIZES, taken)]
            if size not in self._blocks:
                self._blocks[size] = Buffered(self._step.mapaccum("steps", size))
            block = [state]
            for i, (value, width) in enumerate(zip(arguments, self._sizes, strict=True)):
                if 0 < i <= self._shared:
                    block.append(np.tile(value.ravel(), size))
                elif i:
                    own = np.zeros((size, width))
                    own[:taken] = value.reshape(-1, width)[at : at + taken]
                    block.append(own)
            (after,) = self._blocks[size](*block)
            states[at : at + taken] = after.reshape(size, -1)[:taken]
            state = states[at + taken - 1]
        return states


def shared_map(function: ca.Function, count: int) -> ca.Function:
    """Map a stage function over `count` stages that share constants and parameters."""
    return function.map(f"{function.name()}_map", "serial", count, list(SHARED), [])


class Mapped:
    """A stage function over any number of stages that share constants and parameters.

    Called in blocks of few sizes, the last one filled up with stages of no meaning: what is built
    serves every mesh, so that neither memory nor time to build grows with the number of meshes.
    """

    def __init__(self, function: ca.Function) -> None:
        self._function = function
        self._inputs = [function.numel_in(i) for i in range(function.n_in())]
        self._outputs = [function.numel_out(i) for i in range(function.n_out())]
        if self._outputs != [function.nnz_out(i) for i in range(function.n_out())]:
            raise ValueError(f"{function.name()} is expected to have dense outputs")
        self._varying = [i for i in range(function.n_in()) if i not in SHARED]
        self._blocks: dict[int, Buffered] = {}
        self.program = program_of(function)

    def __call__(self, *values: Array) -> list[Array]:
        """Evaluate at all stages: one flat array for each output."""
        if self.program is not None:
            return self._compiled(values)
        arguments = [value.ravel() for value in values]
        count = len(arguments[0]) // self._inputs[0]
        for i, (argument, size) in enumerate(zip(arguments, self._inputs, strict=True)):
            wanted = size if i in SHARED else count * size
            if len(argument) != wanted:
                raise ValueError(f"argument {i} is expected to have {wanted} numbers")
        results = [np.empty(count * size) for size in self._outputs]
        for at in range(0, count, LARGEST):
            end = min(at + LARGEST, count)
            block = self._block(end - at)
            for i in SHARED:
                block.arguments[i][:] = arguments[i]
            for i in self._varying:
                size = self._inputs[i]
                block.arguments[i][: (end - at) * size] = arguments[i][at * size : end * size]
            block.evaluate()
            for result, found, size in zip(results, block.results, self._outputs, strict=True):
                result[at * size : end * size] = found[: (end - at) * size]
        return results

    def _compiled(self, values: tuple[Array, ...]) -> list[Array]:
        arguments = [plain(value) for value in values]
        count = arguments[0].size // self._inputs[0]
        results = [np.empty(count * size) for size in self._outputs]
        assert self.program is not None
        self.program.map(count, SHARED_MASK, *arguments, *results)
        return results

    def _block(self, count: int) -> Buffered:
        """Return the smallest block that holds a number of stages, built once."""
        size = SIZES[bisect_left(SIZES, count)]
        if size not in self._blocks:
            self._blocks[size] = Buffered(shared_map(self._function, size))
        return self._blocks[size]
