"""What the kernel refuses: every array and number that does not fit is an error of Python."""

import copy
import pickle
from types import ModuleType

import casadi as ca
import numpy as np
import pytest
from chains import Kind, case_of
from unfit import ERRORS, UNFIT, locked

from ribbonopt.arrays import Array
from ribbonopt.kernel.programs import program_of

pytestmark = pytest.mark.usefixtures("kernel")
X = ca.SX.sym("x", 3)
FUNCTION = ca.Function("f", [X, ca.SX.sym("y")], [ca.sin(X[:2]), X[0] * X[2]])
COUNT = 5


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
@pytest.mark.parametrize("value", [-101, 0.5, 3, 1e9, 1e300, np.nan, np.inf, -np.inf, 2.0**32])
def test_code_beyond_what_there_is(kernel: ModuleType, row: int, column: int, value: float) -> None:
    code = code_of(kernel)
    kernel.Program(code, 4, 2, *SIZES)
    code[row, column] = value + 100 * (column == 0)
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


Y = ca.SX.sym("y", 2)
STEP = ca.Function("step", [Y, ca.SX.sym("c", 2), ca.SX.sym("own", 3)], [ca.cos(Y) + 1])


def step_arrays() -> list[Array]:
    """Return the start, a shared input, own ones of COUNT steps and the states after each."""
    return [np.zeros(size) for size in (2, 2, 3 * COUNT, 2 * COUNT)]


@each_unfit
@pytest.mark.parametrize("at", range(4))
def test_steps_refuse_arrays_that_do_not_fit(at: int, name: str) -> None:
    program, arrays = program_of(STEP), step_arrays()
    program.accumulate(COUNT, 0b010, *arrays)
    with pytest.raises(ERRORS):
        program.accumulate(COUNT, 0b010, *arrays[:at], UNFIT[name](arrays[at]), *arrays[at + 1 :])


def test_steps_of_other_counts_masks_and_programs() -> None:
    program, arrays = program_of(STEP), step_arrays()
    for count in (-1, COUNT - 1, COUNT + 1, 2**31, 2**61, 2**63 - 1):
        with pytest.raises(ValueError):
            program.accumulate(count, 0b010, *arrays)
    for mask in (0b000, 0b100, 0b110):
        with pytest.raises(ValueError):
            program.accumulate(COUNT, mask, *arrays)
    for given in ((), (COUNT, 0b010), (COUNT, 0b010, *arrays, arrays[0])):
        with pytest.raises(TypeError):
            program.accumulate(*given)
    with pytest.raises(ERRORS):
        program.accumulate(COUNT, 0b010, *arrays[:3], locked(arrays[3]))
    with pytest.raises(ValueError, match="puts out"):
        program_of(FUNCTION).accumulate(COUNT, 0, *map_arrays())


@each_unfit
def test_writhe_refuses_arrays_that_do_not_fit(kernel: ModuleType, name: str) -> None:
    points = np.random.default_rng(0).normal(size=12)
    assert kernel.writhe(4, points) == kernel.writhe(4, points.reshape(4, 3)) != 0
    with pytest.raises(ERRORS):
        kernel.writhe(4, UNFIT[name](points))


def test_writhe_of_few_points_and_of_other_counts(kernel: ModuleType) -> None:
    assert [kernel.writhe(n, np.ones(3 * n)) for n in range(4)] == [0.0] * 4
    assert np.isnan(kernel.writhe(5, np.append(np.nan, np.arange(14.0) ** 2)))
    for count in (-1, 3, 5, 2**31, 2**62):
        with pytest.raises(ValueError):
            kernel.writhe(count, np.zeros(12))
    for arguments in ((), (4,), (4, np.zeros(12), 1), (4.0, np.zeros(12)), (2**64, np.zeros(12))):
        with pytest.raises((TypeError, ValueError, OverflowError)):
            kernel.writhe(*arguments)
