"""Stage functions over many stages: in blocks, the numbers of one stage after another."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.arrays import Array
from ribbonopt.transcription.buffered import SIZES, Accumulated, Mapped

pytestmark = pytest.mark.usefixtures("each_way")
COUNTS = (1, 2, 3, 31, 63, 64, 65, 127, 200)
NV, NC, NT = 3, 2, 4


def stage_function() -> ca.Function:
    """Return a function of (v, c, theta, sigma) with two outputs, a column and a matrix."""
    v, c, theta, sigma = map(ca.SX.sym, "vcts", (NV, NC, NT, 1))
    first = ca.vertcat(ca.sin(v[0]) * theta[0] + sigma, ca.exp(v[1]) / c[1])
    second = ca.horzcat(sigma * v + c[0], theta[1:] ** 2 / (1 + v**2), ca.cos(v) * theta[3])
    return ca.Function("stage", [v, c, theta, sigma], [first, second])


STAGE = stage_function()


def inputs(count: int, seed: int = 0) -> list[Array]:
    """Return v (count, nv), c, theta and sigma (count,)."""
    rng = np.random.default_rng(seed)
    return [rng.normal(size=shape) for shape in ((count, NV), NC, NT, count)]


def stage_by_stage(v: Array, c: Array, theta: Array, sigma: Array) -> list[Array]:
    """Return both outputs of all stages by calls of CasADi's own, flat, columns first."""
    calls = [STAGE(row, c, theta, s) for row, s in zip(v, sigma, strict=True)]
    return [
        np.concatenate([np.array(call[i]).ravel(order="F") for call in calls]) for i in range(2)
    ]


def same(found: list[Array], expected: list[Array]) -> bool:
    """Whether both outputs agree to the last bit."""
    return [a.tobytes() for a in found] == [a.tobytes() for a in expected]


@pytest.mark.parametrize("count", COUNTS)
def test_stages_are_those_of_single_calls_bit_for_bit(count: int) -> None:
    values = inputs(count)
    found = Mapped(STAGE)(*values)
    assert [a.shape for a in found] == [(2 * count,), (9 * count,)]
    assert same(found, stage_by_stage(*values))


def test_no_stages_give_no_numbers() -> None:
    assert [a.shape for a in Mapped(STAGE)(*inputs(0))] == [(0,), (0,)]


@given(st.integers(1, 300), st.data())
def test_parts_give_the_whole(count: int, data: st.DataObject) -> None:
    v, c, theta, sigma = inputs(count, seed=count)
    at = data.draw(st.integers(0, count))
    call = Mapped(STAGE)
    head, tail = call(v[:at], c, theta, sigma[:at]), call(v[at:], c, theta, sigma[at:])
    joined = [np.concatenate(parts) for parts in zip(head, tail, strict=True)]
    assert same(call(v, c, theta, sigma), joined)


@pytest.mark.parametrize("count", [1, 7, 65])
def test_arrays_of_any_kind_are_taken(count: int) -> None:
    v, c, theta, sigma = inputs(count)
    expected = stage_by_stage(v, c, theta, sigma)
    call = Mapped(STAGE)
    wide = np.full((2 * count, 2 * NV), np.nan)
    wide[::2, ::2] = v
    apart = np.full(3 * count, np.nan)
    apart[::3] = sigma
    strided = [wide[::2, ::2], np.flip(np.flip(c).copy()), np.repeat(theta, 2)[::2], apart[::3]]
    assert not strided[1].flags.c_contiguous
    assert same(call(*strided), expected)
    assert same(call(np.asfortranarray(v), c, theta, sigma), expected)
    assert same(call(v.ravel(), c, theta, sigma[:, None]), expected)
    whole = [np.rint(3 * value) + 0.0 for value in (v, c, theta, sigma)]  # no -0.0
    whole[1] = np.array([2.0, 5.0])
    expected = stage_by_stage(*whole)
    assert same(call(*(value.astype(int) for value in whole)), expected)
    assert same(call(*(value.astype(np.float32) for value in whole)), expected)


def test_arguments_stay_and_may_be_locked() -> None:
    values = inputs(65)
    before = [value.copy() for value in values]
    for value in values:
        value.setflags(write=False)
    Mapped(STAGE)(*values)
    assert same(values, before)


def test_results_are_not_overwritten_by_the_next_call() -> None:
    call = Mapped(STAGE)
    for count in (1, 7, 64, 65):
        first = call(*inputs(count, seed=1))
        kept = [array.copy() for array in first]
        values = inputs(count, seed=2)
        second = call(*values)
        assert same(first, kept) and not same(first, second)
        assert not any(np.shares_memory(a, b) for a in first for b in (*second, *values))


def test_arguments_of_one_call_are_forgotten_by_the_next() -> None:
    call = Mapped(STAGE)
    v, c, theta, sigma = inputs(65)
    call(v, c, theta, sigma)
    for other in ([v + 1, c, theta, sigma], [v, c + 1, theta, sigma], [v, c, theta + 1, sigma]):
        assert same(call(*other), stage_by_stage(*other))
    assert same(call(v, c, theta, sigma + 1), stage_by_stage(v, c, theta, sigma + 1))


@pytest.mark.parametrize(("at", "wanted"), [(1, NC), (2, NT), (3, 7)])
@pytest.mark.parametrize("change", [-1, 1])
def test_a_wrong_number_of_numbers_is_refused(at: int, wanted: int, change: int) -> None:
    values = inputs(7)
    values[at] = np.resize(values[at], wanted + change)
    with pytest.raises(ValueError, match=f"argument {at} is expected to have {wanted} numbers"):
        Mapped(STAGE)(*values)


def test_a_stage_cut_short_is_refused() -> None:
    v, *others = inputs(7)
    with pytest.raises(ValueError, match="argument 0"):
        Mapped(STAGE)(v.ravel()[:-1], *others)


def test_few_blocks_serve_all_counts() -> None:
    call = Mapped(STAGE)
    for count in range(1, 301):
        call(*inputs(count))
    assert set(call._blocks) == (set(SIZES) if call.program is None else set())
    blocks = dict(call._blocks)
    call(*inputs(77))
    assert all(call._blocks[size] is block for size, block in blocks.items())


@pytest.mark.parametrize("count", COUNTS)
def test_steps_follow_one_another(count: int) -> None:
    """As CasADi's own evaluation of one after the other gives them, bit for bit."""
    x, c, own = ca.SX.sym("x", 2), ca.SX.sym("c", 3), ca.SX.sym("own", 2)
    after = ca.vertcat(x[1] + c[0] * own[1], ca.sin(x[0]) * c[2] + own[0])
    step, rng = ca.Function("step", [x, c, own], [after]), np.random.default_rng(count)
    state, shared, each = rng.normal(size=2), rng.normal(size=3), rng.normal(size=(count, 2))
    call = Accumulated(step, 1)
    assert call(state, shared, each[:0]).shape == (0, 2)
    found, expected = call(state, shared, each), []
    for row in each:
        expected.append(np.array(step(expected[-1] if expected else state, shared, row)).ravel())
    assert found.shape == (count, 2) and same([found], [np.array(expected)])
    assert same([call(state, shared, each[: count // 2])], [found[: count // 2]])
