"""Nothing that the kernel takes is kept: neither after a call nor after an error."""

import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from chains import Kind, case_of
from unfit import ERRORS, SETTINGS

from ribbonopt.kernel import COMPILED
from ribbonopt.kernel.programs import program_of

MANY = 10_000
SHORT = (*SETTINGS[:5], 2)
STATM = Path("/proc/self/statm")


def calls(kernel: ModuleType) -> dict[str, Callable[[], object]]:
    """Return calls of all kinds, and such as fail at each place where something is held."""
    x = ca.SX.sym("x", 2)
    program = program_of(ca.Function("f", [x], [ca.sin(x)]))
    case = case_of(Kind(nx=2, nz=1, degree=1, apart=1, elements=(1, 2)))
    twin, lay = case.chain.twin, case.blocks.layout
    residuals, derivatives = case.linearize()
    stages = np.ascontiguousarray(derivatives.stages.swapaxes(2, 3))
    conditions = np.ascontiguousarray(derivatives.conditions.T)
    widths, r, short = lay.widths(case.p).copy(), residuals.vector().copy(), np.zeros(1)
    factors, w = twin.factor(stages, conditions, widths, None), case.w.copy()
    a, b = np.zeros(2), np.zeros(2)
    code = np.zeros((1, 5))
    ends, sizes = [0, 1, 3], (1, 2, 1, 1, 3, 0, 2)
    numbers, nothing = np.array([0.5, 1.0, 0.5]), np.full(len(w), np.nan)
    newton = w, case.p, None, None, r, SHORT
    return {
        "map": lambda: program.map(1, 0, a, b),
        "map, no input": lambda: program.map(1, 0, short, b),
        "map, no output": lambda: program.map(1, 0, a, short),
        "map, fewer": lambda: program.map(1, 0, a),
        "program": lambda: kernel.Program(code, 1, 1, [1], [1]),
        "program, sizes": lambda: kernel.Program(code, 1, 1, [1], [-1]),
        "program, no code": lambda: kernel.Program(short, 1, 1, [1], [1]),
        "program, wild": lambda: kernel.Program(code + 99, 1, 1, [1], [1]),
        "program, text": lambda: kernel.Program(code, 1, 1, [1], ["1"]),
        "chain": lambda: kernel.Chain(ends, sizes, numbers, [1, 2], [0], ()),
        "chain, order": lambda: kernel.Chain(ends, sizes, numbers, [1, 1], [0], ()),
        "chain, tableau": lambda: kernel.Chain(ends, sizes, short, [1, 2], [0], ()),
        "chain, programs": lambda: kernel.Chain(ends, sizes, numbers, [1, 2], [0], (program,) * 6),
        "chain, numbers": lambda: kernel.Chain(ends, sizes, numbers, [1, 2], [0], (1,) * 6),
        "residuals": lambda: twin.residuals(w, case.p, r),
        "residuals, none": lambda: twin.residuals(w, case.p, short),
        "linearize": lambda: twin.linearize(w, case.p, r, stages, conditions),
        "linearize, none": lambda: twin.linearize(w, case.p, r, stages, short),
        "factor": lambda: twin.factor(stages, conditions, widths, None),
        "factor only": lambda: twin.factor(stages, conditions, widths, r),
        "factor, singular": lambda: twin.factor(0 * stages, 0 * conditions, widths, None),
        "factor, none": lambda: twin.factor(stages, conditions, widths, short),
        "solve": lambda: factors.solve(r, w.copy()),
        "solve, none": lambda: factors.solve(r, short),
        "determinant": lambda: factors.determinant,
        "newton": lambda: twin.newton(w.copy(), *newton[1:]),
        "newton, inherits": lambda: twin.newton(w.copy(), case.p, None, factors, r, SHORT),
        "newton, none": lambda: twin.newton(short, *newton[1:]),
        "newton, NaN": lambda: twin.newton(nothing.copy(), *newton[1:]),
        "newton, foreign": lambda: twin.newton(w, case.p, None, 1, r, SHORT),
        "writhe": lambda: kernel.writhe(4, np.arange(12.0)),
        "writhe, none": lambda: kernel.writhe(4, short),
    }


NAMES = () if COMPILED is None else tuple(calls(COMPILED))


def pages() -> int:
    """Return the pages of memory that this process has."""
    return int(STATM.read_text().split()[1])


@pytest.mark.skipif(not STATM.exists(), reason="the system does not say what memory is taken")
@pytest.mark.parametrize("name", NAMES)
def test_no_memory_is_kept(kernel: ModuleType, name: str) -> None:
    call: Callable[[], Any] = calls(kernel)[name]

    def often() -> None:
        for _ in range(MANY):
            with suppress(*ERRORS):
                call()

    often()
    before = pages()
    often()
    assert (pages() - before) * 4096 < 16 * MANY  # no object, and no block, is as small


@pytest.mark.parametrize("name", NAMES)
def test_no_reference_is_kept(kernel: ModuleType, name: str) -> None:
    """Also of objects that every call shares, which memory does not tell."""
    call = calls(kernel)[name]
    shared = [cell.cell_contents for cell in call.__closure__ or ()]
    shared = [*shared, None, *(part for value in shared if type(value) is tuple for part in value)]
    with suppress(*ERRORS):
        call()
    before = [sys.getrefcount(value) for value in shared]
    for _ in range(100):
        with suppress(*ERRORS):
            call()
    moved = [sys.getrefcount(value) - b for value, b in zip(shared, before, strict=True)]
    assert max(map(abs, moved)) < 50
