"""What chains and their factors refuse: every array and object that does not fit."""

from collections.abc import Callable
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from chains import Kind, case_of
from unfit import ERRORS, SETTINGS, UNFIT, locked

from ribbonopt.kernel.programs import program_of

pytestmark = pytest.mark.usefixtures("kernel")
CALLS = ("residuals", "linearize", "factor", "factor only", "newton", "solve")


def call_of(name: str) -> tuple[Callable[..., object], list[Any]]:
    """Return a method of a chain or of its factors, and arguments that fit; of None none is one."""
    case = case_of(Kind(nz=1, nk=1, apart=1, elements=(2, 3)))
    twin, lay = case.chain.twin, case.blocks.layout
    residuals, derivatives = case.linearize()
    stages = np.ascontiguousarray(derivatives.stages.swapaxes(2, 3)).ravel()
    conditions = np.ascontiguousarray(derivatives.conditions.T).ravel()
    widths, r = lay.widths(case.p).copy(), residuals.vector().copy()
    if name == "residuals":
        return twin.residuals, [case.w, case.p, r]
    if name == "linearize":
        return twin.linearize, [case.w, case.p, r, stages, conditions]
    if name == "factor":
        return lambda *a: twin.factor(*a, None), [stages, conditions, widths]
    if name == "factor only":
        return twin.factor, [stages, conditions, widths, r]
    factors = twin.factor(stages, conditions, widths, None)
    assert factors is not None
    if name == "solve":
        return factors.solve, [r, case.w]
    relaxed = np.zeros(lay.conditions)
    return lambda w, p, b, r: twin.newton(w, p, b, factors, r, SETTINGS), [
        case.w,
        case.p,
        relaxed,
        r,
    ]


WRITTEN = {
    "residuals": (2,),
    "linearize": (2, 3, 4),
    "factor": (),
    "factor only": (),
    "newton": (0, 3),
    "solve": (1,),
}


@pytest.mark.parametrize("name", CALLS)
@pytest.mark.parametrize("unfit", UNFIT)
def test_chains_refuse_arrays_that_do_not_fit(name: str, unfit: str) -> None:
    call, arrays = call_of(name)
    call(*arrays)
    for at, array in enumerate(arrays):
        if unfit == "nothing" and (name, at) in (("newton", 2), ("factor only", 3)):
            continue  # may be left out
        with pytest.raises(ERRORS):
            call(*arrays[:at], UNFIT[unfit](array), *arrays[at + 1 :])


@pytest.mark.parametrize("name", CALLS)
def test_chains_write_to_no_locked_array(name: str) -> None:
    for at in range(5):
        call, arrays = call_of(name)
        if at < len(arrays):
            locked(arrays[at])
            if at in WRITTEN[name]:
                with pytest.raises(ERRORS):
                    call(*arrays)
            else:
                call(*arrays)


def test_newton_refuses_what_is_not_its_factors(kernel: ModuleType) -> None:
    kind = Kind(nx=2, nc=1, elements=(2, 3))
    case = case_of(kind)
    residuals, derivatives = case.linearize()
    p, r = case.p, np.zeros(case.nlp.unknowns)
    others = [
        Kind(nx=2, nc=1, elements=(3, 2)),
        Kind(nx=2, nc=1, elements=(5,)),
        Kind(nx=2, nc=1, elements=(2, 3), degree=4),
        Kind(nx=2, nc=1, elements=(2, 3), scheme="radau"),
        Kind(nx=2, nc=1, elements=(2, 3), apart=1),
        Kind(nx=2, nc=2, elements=(2, 3)),
        Kind(nx=1, nz=1, nc=1, elements=(2, 3)),
        Kind(nx=3, nc=1, elements=(2, 3)),
    ]
    for other in map(case_of, others):
        foreign = other.chain.factor(other.linearize()[1], other.p).factors
        with pytest.raises(ValueError, match="as large"):
            case.chain.twin.newton(case.w.copy(), p, None, foreign, r, SETTINGS)
    only = case.chain.factor(derivatives, p, residuals).factors
    for unfit in (only, 1, "factors", case.chain, case.chain.twin, kernel, object()):
        with pytest.raises(ValueError, match="as large"):
            case.chain.twin.newton(case.w.copy(), p, None, unfit, r, SETTINGS)
    same = case_of(kind)
    theirs = same.chain.factor(derivatives, p).factors
    case.chain.twin.newton(case.w.copy(), p, None, theirs, r, SETTINGS)


@pytest.mark.parametrize(
    "settings",
    [(), SETTINGS[:5], (*SETTINGS, 1), None, 1, ("a", *SETTINGS[1:]), (*SETTINGS[:5], 1e3)],
)
def test_newton_refuses_other_settings(settings: Any) -> None:
    case = case_of(Kind())
    r = np.zeros(case.nlp.unknowns)
    with pytest.raises(TypeError):
        case.chain.twin.newton(case.w, case.p, None, None, r, settings)


def test_arrays_are_let_go_after_errors_too() -> None:
    """An array that something holds cannot be resized."""
    x, held = ca.SX.sym("x"), bytearray(8 * 7)
    program = program_of(ca.Function("f", [x], []))
    with pytest.raises(ERRORS):
        program.map(5, 0, held)
    held += b"more"
    call, arrays = call_of("solve")
    arrays[0] = arrays[0].copy()
    with pytest.raises(ERRORS):
        call(arrays[0], arrays[1][:-1])
    arrays[0].resize(3, refcheck=True)
