"""CasADi functions as programs of the kernel: the instruction list of an SX function, checked."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from . import COMPILED

if TYPE_CHECKING:
    from ._compiled import Program


def program_of(function: ca.Function) -> Program | None:
    """Return a function with dense inputs and outputs as a program, or None where that cannot be.

    That is: without the kernel, for functions that are no SX expressions, and for instructions that
    the kernel does not know.
    """
    if COMPILED is None or not function.is_a("SXFunction") or not _dense(function):
        return None
    known = operations()
    rows: list[tuple[float, ...]] = []
    number_of, read_by, written_by = _readers(function)
    for k in range(function.n_instructions()):
        name = known.get(number_of(function, k))
        if name is None:
            return None
        read, written = read_by(function, k), written_by(function, k)
        number = COMPILED.OPERATIONS[name]
        if name == "OP_INPUT":
            rows.append((number, written[0], read[1], read[0], 0.0))
        elif name == "OP_OUTPUT":
            rows.append((number, written[1], read[0], written[0], 0.0))
        elif name == "OP_CONST":
            rows.append((number, written[0], 0, 0, function.instruction_constant(k)))
        else:
            rows.append((number, written[0], read[0], read[-1], 0.0))
    code = np.array(rows, dtype=float).reshape(-1, 5)
    inputs = [function.numel_in(i) for i in range(function.n_in())]
    outputs = [function.numel_out(i) for i in range(function.n_out())]
    try:
        program: Program = COMPILED.Program(
            code, len(code), max(1, function.sz_w()), inputs, outputs
        )
        return program
    except ValueError:  # more inputs or outputs than the kernel takes
        return None


def _readers(function: ca.Function) -> tuple[Callable[..., Any], ...]:
    """Return what reads the number, the inputs and the outputs of instruction k of a function.

    Methods of `ca.Function` only pass these calls on, which costs as much again as the calls, and
    a stage function has thousands of instructions.
    """
    kind = type(function)
    direct = getattr(ca.casadi, "_casadi", None) if kind is ca.Function else None
    methods = ("instruction_id", "instruction_input", "instruction_output")
    return tuple(getattr(direct, f"Function_{x}", getattr(kind, x)) for x in methods)


def _dense(function: ca.Function) -> bool:
    """Whether all numbers of inputs and outputs have a place: instructions count those only."""
    inputs = (function.nnz_in(i) == function.numel_in(i) for i in range(function.n_in()))
    return all(inputs) and all(
        function.nnz_out(i) == function.numel_out(i) for i in range(function.n_out())
    )


def operations() -> dict[int, str]:
    """Return the names of CasADi's operations that the kernel knows, by their numbers."""
    assert COMPILED is not None
    return {getattr(ca, name): name for name in COMPILED.OPERATIONS if hasattr(ca, name)}
