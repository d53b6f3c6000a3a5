"""Every instruction of CasADi's SX: its own evaluation, bit for bit, or a function left to it."""

from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.arrays import Array
from ribbonopt.kernel import COMPILED
from ribbonopt.kernel.programs import operations, program_of

NAMES = {name: getattr(ca, name) for name in dir(ca) if name.startswith("OP_")}
KNOWN = set() if COMPILED is None else set(COMPILED.OPERATIONS)
#: moves of numbers, which are in every program
MOVES = {"OP_INPUT", "OP_OUTPUT", "OP_CONST"}
#: what SX makes another instruction of, or none: the same written by hand
BY_HAND = {"OP_ASSIGN", "OP_LIFT", "OP_CONSTPOW"}
#: which zero these return of two is left open by the language that CasADi is written in
OPEN_ZERO = {"OP_FMIN", "OP_FMAX"}
UNARY = {"OP_TWICE", "OP_SQ"}
#: what old versions of CasADi write in other words
NEW = {"OP_TWICE"}
COUNTS = (1, 2, 3, 4, 5, 15, 16, 17, 33)
NUMBERS = (
    *(0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 1.5, 2.5, -2.5, 2.0, 3.0, -3.0, 0.1, -0.1, np.pi, 1e-9),
    *(5e-324, -5e-324, 1e-310, -1e-310, 2.2250738585072014e-308, 1e16, 1e300, -1e300, 709.5),
    *(-745.5, 1.7976931348623157e308, np.inf, -np.inf, np.nan),
)


def pairs() -> tuple[Array, Array]:
    """Return all pairs of special numbers, and some that are not special, as (n,) each."""
    rng = np.random.default_rng(0)
    a, b = np.meshgrid(NUMBERS, NUMBERS)
    drawn = rng.normal(size=(2, 200)) * 10.0 ** rng.integers(-3, 3, (2, 200))
    return np.append(a, drawn[0]), np.append(b, drawn[1])


def same(found: Array, expected: Array) -> bool:
    """Whether numbers agree to the last bit, the sign of zero included; all NaN are one."""
    numbers = ~np.isnan(expected)
    bits = found[numbers].view(np.int64), expected[numbers].view(np.int64)
    return bool(np.isnan(found[~numbers]).all() and np.array_equal(*bits))


def by_casadi(function: ca.Function, *inputs: Array) -> list[Array]:
    """Return outputs at all points, by CasADi's own evaluation of one after the other."""
    found = function.map(len(inputs[0]))(*(ca.DM(a.reshape(len(a), -1).T) for a in inputs))
    outputs = [found] if function.n_out() == 1 else found
    return [np.array(output).T.ravel() for output in outputs]


def by_kernel(program: Any, sizes: list[int], count: int, *inputs: Array) -> list[Array]:
    """Return outputs at all points, `count` of them at once."""
    parts = []
    for at in range(0, len(inputs[0]), count):
        given = [np.ascontiguousarray(a[at : at + count]) for a in inputs]
        results = [np.full(size * len(given[0]), 7.0) for size in sizes]
        program.map(len(given[0]), 0, *given, *results)
        parts.append(results)
    return [np.concatenate(part) for part in zip(*parts, strict=True)]


def instructions(function: ca.Function) -> set[str]:
    """Return the names of a function's instructions, but for moves."""
    names = {number: name for name, number in NAMES.items()}
    ids = range(function.n_instructions())
    return {names[function.instruction_id(k)] for k in ids} - MOVES


def of_one(name: str) -> ca.Function:
    """Return a function of (x, y) that is one instruction."""
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    if name in UNARY:
        return ca.Function("f", [x, y], [ca.SX.unary(NAMES[name], x)])
    return ca.Function("f", [x, y], [ca.SX.binary(NAMES[name], x, y)])


def by_hand(kernel: ModuleType, name: str) -> Any:
    """Return a program of (x, y) that is one instruction."""
    op, code = kernel.OPERATIONS, np.zeros((4, 5))
    code[0, :4] = op["OP_INPUT"], 0, 0, 0
    code[1, :4] = op["OP_INPUT"], 1, 0, 1
    code[2, :4] = op[name], 0, 0, 1
    code[3, :4] = op["OP_OUTPUT"], 0, 0, 0
    return kernel.Program(code, 4, 2, [1, 1], [1])


@pytest.mark.parametrize("name", sorted((KNOWN & NAMES.keys()) - MOVES - BY_HAND))
def test_an_instruction_gives_what_casadi_gives(kernel: ModuleType, name: str) -> None:
    function = of_one(name)
    assert instructions(function) == {name} or name in NEW
    expected = by_casadi(function, *pairs())[0]
    for program in (program_of(function), by_hand(kernel, name)):
        one_by_one = by_kernel(program, [1], 1, *pairs())[0]
        if name in OPEN_ZERO:
            assert same(one_by_one + 0.0, expected + 0.0)
        else:
            assert same(one_by_one, expected)
        for count in COUNTS:
            assert same(by_kernel(program, [1], count, *pairs())[0], one_by_one), count


@pytest.mark.parametrize("name", sorted(BY_HAND))
def test_an_instruction_that_sx_does_not_write(kernel: ModuleType, name: str) -> None:
    x, y = pairs()
    expected = by_casadi(of_one("OP_POW"), x, y)[0] if name == "OP_CONSTPOW" else x
    for count in COUNTS:
        assert same(by_kernel(by_hand(kernel, name), [1], count, x, y)[0], expected)


@pytest.mark.parametrize("value", NUMBERS)
def test_a_constant_is_itself(kernel: ModuleType, value: float) -> None:
    x = ca.SX.sym("x")
    function = ca.Function("f", [x], [ca.vertcat(value, x)])
    points = np.arange(5.0)
    found = by_kernel(program_of(function), [2], 5, points)[0]
    assert same(found, by_casadi(function, points)[0])
    assert np.array_equal(found[::2], np.full(5, value), equal_nan=True)  # CasADi's -0 is 0


class Other:
    """Stands for a function of one instruction, which the kernel is not to know."""

    def __init__(self, number: int) -> None:
        self.number = number

    def is_a(self, kind: str) -> bool:
        return kind == "SXFunction"

    def n_in(self) -> int:
        return 0

    n_out = n_in

    def n_instructions(self) -> int:
        return 1

    def sz_w(self) -> int:
        return 1

    def instruction_id(self, k: int) -> int:
        return self.number

    def instruction_input(self, k: int) -> list[int]:
        return [0]

    instruction_output = instruction_input


@pytest.mark.parametrize("name", sorted(NAMES.keys() - KNOWN))
def test_another_instruction_is_left_to_casadi(kernel: ModuleType, name: str) -> None:
    assert program_of(Other(NAMES[name])) is None
    assert isinstance(program_of(Other(ca.OP_ASSIGN)), kernel.Program)


def test_every_number_has_one_name(kernel: ModuleType) -> None:
    """CasADi's numbers change from version to version: names are what is compared."""
    assert set(operations().values()) == KNOWN & NAMES.keys()
    assert sorted(kernel.OPERATIONS.values()) == list(range(len(KNOWN)))


def left_to_casadi() -> dict[str, ca.Function]:
    """Return functions that no program can stand for."""
    x, m = ca.SX.sym("x", 2), ca.MX.sym("m", 2)
    own = ca.Function("own", [x], [ca.sin(x)], {"never_inline": True})
    sparse = ca.SX(ca.Sparsity.lower(2), x[0])
    held = ca.SX.sym("h", ca.Sparsity.lower(2))
    many = [ca.SX.sym(f"x{i}") for i in range(9)]
    call = ca.Function("f", [x], [own(x)])
    return (
        ({"calls": call} if "OP_CALL" in instructions(call) else {})
        | {  # not by old versions
            "erfinv": ca.Function("f", [x], [ca.erfinv(x)]),
            "printed": ca.Function("f", [x], [x.printme(3)]),
            "matrices": ca.Function("f", [m], [ca.sin(m)]),
            "outside": ca.Function("f", [x], [ca.sin(x)]).map(3),
            "sparse output": ca.Function("f", [x], [sparse]),
            "sparse input": ca.Function("f", [held], [ca.SX(held)[0, 0] + 1]),
            "inputs": ca.Function("f", many, [sum(many)]),
            "outputs": ca.Function("f", many[:1], [many[0] + i for i in range(9)]),
        }
    )


@pytest.mark.parametrize("name", sorted(left_to_casadi()))
def test_a_function_without_a_program(kernel: ModuleType, name: str) -> None:
    assert program_of(left_to_casadi()[name]) is None


def test_inputs_may_be_shared_and_outputs_many(kernel: ModuleType) -> None:
    x, c, t = (ca.SX.sym(name, size) for name, size in (("x", 3), ("c", 2), ("t", 1)))
    outputs = [ca.vertcat(x[2] - c[0], t), ca.horzcat(x, ca.vertcat(c, t)), ca.SX.ones(2)]
    function = ca.Function("f", [x, c, t], outputs)
    program, rng = program_of(function), np.random.default_rng(3)
    for count in COUNTS:
        a, b, s = rng.normal(size=(count, 3)), rng.normal(size=2), rng.normal(size=count)
        results = [np.full(count * size, 7.0) for size in (2, 6, 2)]
        program.map(count, 0b010, a, b, s, *results)
        expected = by_casadi(function, a, np.tile(b, (count, 1)), s)
        assert all(same(x, y) for x, y in zip(results, expected, strict=True))


@st.composite
def expressions(draw: st.DrawFn) -> ca.Function:
    """Return a function of (x, y) of many instructions, which share places to work."""
    x, y = ca.SX.sym("x", 2), ca.SX.sym("y")
    made = [x[0], x[1], y, ca.SX(0.7)]
    choice = sorted(KNOWN & NAMES.keys() - MOVES - BY_HAND - OPEN_ZERO)
    for name in draw(st.lists(st.sampled_from(choice), min_size=1, max_size=40)):
        a, b = (made[draw(st.integers(0, len(made) - 1))] for _ in range(2))
        made.append(ca.SX.binary(NAMES[name], a, b) if name not in UNARY else a + a)
    return ca.Function("f", [x, y], [ca.vertcat(*made[-3:]), made[len(made) // 2]])


@given(expressions(), st.sampled_from(COUNTS), st.integers(0, 100))
def test_expressions_give_what_casadi_gives(
    kernel: ModuleType, function: ca.Function, count: int, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    x, y = rng.normal(size=(40, 2)), rng.choice(NUMBERS, 40)
    found = by_kernel(program_of(function), [3, 1], count, x, y)
    assert all(same(a, b) for a, b in zip(found, by_casadi(function, x, y), strict=True))
