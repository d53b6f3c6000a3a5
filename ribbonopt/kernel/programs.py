"""CasADi functions as programs of the kernel: the instruction list of an SX function, checked."""

from __future__ import annotations

from typing import TYPE_CHECKING

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
    if COMPILED is None or not function.is_a("SXFunction"):
        return None
    code = np.zeros((function.n_instructions(), 5))
    known = operations()
    for k, row in enumerate(code):
        name = known.get(function.instruction_id(k))
        if name is None:
            return None
        read, written = function.instruction_input(k), function.instruction_output(k)
        row[0] = COMPILED.OPERATIONS[name]
        if name == "OP_INPUT":
            row[1:4] = written[0], read[1], read[0]
        elif name == "OP_OUTPUT":
            row[1:4] = written[1], read[0], written[0]
        elif name == "OP_CONST":
            row[1], row[4] = written[0], function.instruction_constant(k)
        else:
            row[1:4] = written[0], read[0], read[-1]
    inputs = [function.numel_in(i) for i in range(function.n_in())]
    outputs = [function.numel_out(i) for i in range(function.n_out())]
    try:
        program: Program = COMPILED.Program(
            code, len(code), max(1, function.sz_w()), inputs, outputs
        )
        return program
    except ValueError:  # more inputs or outputs than the kernel takes
        return None


def operations() -> dict[int, str]:
    """Return the names of CasADi's operations that the kernel knows, by their numbers."""
    assert COMPILED is not None
    return {getattr(ca, name): name for name in COMPILED.OPERATIONS if hasattr(ca, name)}
