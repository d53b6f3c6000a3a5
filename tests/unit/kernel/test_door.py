"""What the kernel refuses: every array and number that does not fit is an error of Python."""

import copy
import pickle
from collections.abc import Callable
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from chains import Kind, case_of

from ribbonopt.arrays import Array
from ribbonopt.kernel.programs import program_of

pytestmark = pytest.mark.usefixtures("kernel")
X = ca.SX.sym("x", 3)
FUNCTION = ca.Function("f", [X, ca.SX.sym("y")], [ca.sin(X[:2]), X[0] * X[2]])
COUNT = 5
Change = Callable[[Array], Any]


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
each_unfit = pytest.mark.parametrize("name", UNFIT)


def map_arrays() -> list[Array]:
    """Return inputs and outputs of FUNCTION at COUNT points."""
    return [np.zeros(COUNT * size) for size in (3, 1, 2, 1)]


@each_unfit
@pytest.mark.parametrize("at", range(4))
def test_map_refuses_arrays_that_do_not_fit(at: int, name: str) -> None:
    program, arrays = program_of(FUNCTION), map_arrays()
    program.map(COUNT, 0, *arrays)
    with pytest.raises(ERRORS):
        program.map(COUNT, 0, *arrays[:at], UNFIT[name](arrays[at]), *arrays[at + 1 :])


@pytest.mark.parametrize("at", [2, 3])
def test_map_writes_to_no_locked_array(at: int) -> None:
    arrays = map_arrays()
    locked(arrays[at])
    with pytest.raises(ERRORS):
        program_of(FUNCTION).map(COUNT, 0, *arrays)


@pytest.mark.parametrize("count", [-1, COUNT - 1, COUNT + 1, 2**31, 2**60, 2**61, 2**62, 2**63 - 1])
def test_map_refuses_other_counts(count: int) -> None:
    """Products with a size may be 0 in 64 bits."""
    for arrays in (map_arrays(), [np.zeros(0)] * 4):
        with pytest.raises(ValueError):
            program_of(FUNCTION).map(count, 0, *arrays)


@pytest.mark.parametrize("count", [2**63, -(2**64), 1.5, "1", None, 10**400])
def test_map_refuses_what_is_no_count(count: object) -> None:
    with pytest.raises((OverflowError, TypeError)):
        program_of(FUNCTION).map(count, 0, *map_arrays())


def test_map_refuses_another_number_of_arrays() -> None:
    program, arrays = program_of(FUNCTION), map_arrays()
    for given in (arrays[:-1], [*arrays, arrays[0]], []):
        with pytest.raises(TypeError, match="2 inputs and 2 outputs"):
            program.map(COUNT, 0, *given)
    with pytest.raises(TypeError):
        program.map()


@pytest.mark.parametrize("mask", [-1, 0b11, 0b111111, 2**40])
def test_a_mask_tells_of_inputs_only(mask: int) -> None:
    arrays = map_arrays()
    shared = [a[: len(a) // COUNT].copy() if mask >> i & 1 else a for i, a in enumerate(arrays[:2])]
    program_of(FUNCTION).map(COUNT, mask, *shared, *arrays[2:])


def code_of(kernel: ModuleType) -> Array:
    """Return x + y as code (4, 5)."""
    op = kernel.OPERATIONS
    rows = [(op["OP_INPUT"], 0, 0, 0), (op["OP_INPUT"], 1, 1, 1), (op["OP_ADD"], 1, 0, 1)]
    return np.array([(*row, 0.0) for row in (*rows, (op["OP_OUTPUT"], 2, 1, 0))])


SIZES = [1, 2], [3]


@pytest.mark.parametrize("row", range(4))
@pytest.mark.parametrize("column", range(4))
@pytest.mark.parametrize("value", [-1, 0.5, 3, 1e9, 1e300, np.nan, np.inf, -np.inf, 2.0**32])
def test_code_beyond_what_there_is(
    kernel: ModuleType, row: int, column: int, value: float
) -> None:
    code = code_of(kernel)
    kernel.Program(code, 4, 2, *SIZES)
    code[row, column] = value + 100 * (column == 0 and value == 3)
    unread = row == 3 and column == 1 and value == 3
    assert not unread or SIZES[1] == [3]
    with pytest.raises(ValueError, match="beyond"):
        kernel.Program(code, 4, 2, *SIZES)


@pytest.mark.parametrize(
    ("count", "work", "sizes"),
    [
        (5, 2, SIZES),
        (3, 2, SIZES),
        (-1, 2, SIZES),
        (2**62, 2, SIZES),
        (4, 1, SIZES),
        (4, 0, SIZES),
        (4, -1, SIZES),
        (4, 2, ([1], [3])),
        (4, 2, ([1, 1], [3])),
        (4, 2, ([1, 2], [2])),
        (4, 2, ([1, 2], [])),
        (4, 2, ([1, -2], [3])),
        (4, 2, ([1, 10**9], [3])),
        (4, 2, ([1, 2] * 5, [3])),
        (4, 2, ([1, 2], [3] * 9)),
    ],
)
def test_programs_of_other_sizes(
    kernel: ModuleType, count: int, work: int, sizes: tuple[list[int], list[int]]
) -> None:
    with pytest.raises(ValueError):
        kernel.Program(code_of(kernel), count, work, *sizes)


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        (None, 4, 2, *SIZES),
        (4, 2, *SIZES),
        ("code", 4.0, 2, *SIZES),
        ("code", 4, 2, 1, [3]),
        ("code", 4, 2, [1, 2.5], [3]),
        ("code", 4, 2, [1, None], [3]),
        ("code", 4, 2, [1, 2], None),
        ("code", 2**70, 2, *SIZES),
        ("code", 4, 2**40, *SIZES),
        ("code", 4, 2, [1, 2**70], [3]),
    ],
)
def test_what_is_no_program(kernel: ModuleType, arguments: tuple[object, ...]) -> None:
    given = [code_of(kernel) if a == "code" else a for a in arguments]
    with pytest.raises((TypeError, OverflowError)):
        kernel.Program(*given)


def test_a_list_may_empty_itself_while_it_is_read(kernel: ModuleType) -> None:
    class Hostile:
        def __index__(self) -> int:
            sizes.clear()
            return 1

    sizes: list[object] = [Hostile(), 2]
    sizes += [Hostile()] * 4
    with pytest.raises(ValueError, match="beyond"):
        kernel.Program(np.full((4, 5), 99.0), 4, 2, sizes, [3])


def test_kernel_objects_are_made_in_one_way_only(kernel: ModuleType) -> None:
    case = case_of(Kind())
    factors = case.chain.factor(case.linearize()[1], case.p).factors
    program = program_of(FUNCTION)
    for value in (factors, case.chain.twin, program):
        with pytest.raises(TypeError):
            type(value)()
        with pytest.raises(TypeError):
            copy.copy(value)
        with pytest.raises(TypeError):
            pickle.dumps(value)
        with pytest.raises(TypeError):
            type("Own", (type(value),), {})
        with pytest.raises(AttributeError):
            value.own = 1


SETTINGS = 1e-13, 0.1, 0.3, 1e-4, 1e-13, 20
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
    return lambda w, p, b, r: twin.newton(w, p, b, factors, r, SETTINGS), [case.w, case.p, relaxed, r]


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
    held = bytearray(8 * 7)
    with pytest.raises(ERRORS):
        program_of(FUNCTION).map(COUNT, 0, held, *map_arrays()[1:])
    held += b"more"
    call, arrays = call_of("solve")
    arrays[0] = arrays[0].copy()
    with pytest.raises(ERRORS):
        call(arrays[0], arrays[1][:-1])
    arrays[0].resize(3, refcheck=True)
