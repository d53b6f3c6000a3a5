"""Programs and chains of random arguments, some hostile: an error of Python, or numbers.

Under the address sanitizer (`scripts/sanitize`) nothing is read or written beyond what there is.
"""

from functools import cache
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from chains import Kind, case_of
from hypothesis import given
from hypothesis import strategies as st
from unfit import SETTINGS

from ribbonopt.transcription.collocation import compiled as seam

ERRORS = TypeError, ValueError, BufferError, OverflowError, MemoryError
WILD = st.sampled_from((-(2**31), -1, 0, 1, 2, 3, 7, 10**4, 10**8, 2**31 - 1, 2**31, 2**40))
CODE = st.one_of(st.integers(-1, 6).map(float), st.sampled_from((0.5, 1e8, 1e9, np.inf, np.nan)))
NUMBERS = st.sampled_from((0.0, -0.0, 1.0, -2.5, 1e-320, 1e300, np.inf, -np.inf, np.nan))


@given(st.data())
def test_programs_of_any_code(kernel: ModuleType, data: st.DataObject) -> None:
    ops = list(kernel.OPERATIONS.values())
    sizes_in = data.draw(st.lists(st.integers(0, 3), max_size=3))
    sizes_out = data.draw(st.lists(st.integers(0, 3), max_size=3))
    work = data.draw(st.integers(1, 6))
    rows = data.draw(
        st.lists(
            st.tuples(st.sampled_from(ops), *[st.integers(0, work - 1)] * 3, NUMBERS), max_size=12
        )
    )
    code = np.array(rows, dtype=float).reshape(-1, 5)
    for _ in range(data.draw(st.integers(0, 1)) if len(code) else 0):
        code[data.draw(st.integers(0, len(code) - 1)), data.draw(st.integers(0, 3))] = data.draw(
            CODE
        )
    try:
        program = kernel.Program(code, len(code), work, sizes_in, sizes_out)
    except ERRORS:
        return
    count, mask = data.draw(st.integers(0, 40)), data.draw(st.integers(0, 7))
    draw = np.random.default_rng(count).normal
    shared = [1 if mask >> i & 1 else count for i in range(len(sizes_in))]
    inputs = [draw(size=n * size) for n, size in zip(shared, sizes_in, strict=True)]
    program.map(count, mask, *inputs, *(np.empty(count * size) for size in sizes_out))


KINDS = (
    Kind(nx=2, nz=1, nc=1, nk=1, apart=1, degree=2, elements=(2, 3)),
    Kind(nx=1, nc=0, degree=1, elements=(1,)),
    Kind(nx=3, nz=0, nc=2, apart=3, degree=3, elements=(1, 1, 4)),
)


@cache
def arguments_of(kind: Kind) -> tuple[Any, ...]:
    """Return what the chain of a kind is made with."""
    blocks, module = case_of(kind).blocks, SimpleNamespace(Chain=lambda *arguments: arguments)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(seam, "COMPILED", module)
        chain = seam.compiled_chain(blocks.layout, blocks.tableau, blocks.phases, blocks.conditions)
    assert chain is not None
    return chain.twin  # type: ignore[return-value]


def spoilt(data: st.DataObject, arguments: tuple[Any, ...]) -> list[Any]:
    """Return the arguments of a chain, one of them with another number in it."""
    ends, sizes, tableau, q, r, programs = arguments
    parts: list[Any] = [list(ends), list(sizes), tableau.copy(), list(q), list(r), list(programs)]
    at = data.draw(st.integers(0, 5))
    part = parts[at]
    if at == 2:
        parts[2] = tableau[: data.draw(st.integers(0, len(tableau)))].copy()
    elif at == 5:
        i, j = (data.draw(st.integers(0, len(part) - 1)) for _ in range(2))
        part[i] = data.draw(st.sampled_from((part[j], None, 1)))
    elif part:
        part[data.draw(st.integers(0, len(part) - 1))] = data.draw(WILD)
    more = data.draw(st.integers(0, 5))
    if more in (0, 3, 4) and data.draw(st.booleans()):
        parts[more] = parts[more][:-1] if data.draw(st.booleans()) else [*parts[more], 1]
    return [parts[0], tuple(parts[1]), *parts[2:5], tuple(parts[5])]


@given(st.sampled_from(KINDS), st.data())
def test_chains_of_any_arguments(kernel: ModuleType, kind: Kind, data: st.DataObject) -> None:
    given_ = spoilt(data, arguments_of(kind))
    try:
        chain = kernel.Chain(*given_)
    except ERRORS:
        return
    use(chain, given_[0], given_[1])


@given(st.sampled_from(KINDS), st.data())
def test_chains_only_to_be_eliminated(kernel: ModuleType, kind: Kind, data: st.DataObject) -> None:
    ends, sizes, tableau, q, r, _ = arguments_of(kind)
    ends = sorted(data.draw(st.sets(st.integers(1, 9), min_size=1, max_size=4)))
    nc = data.draw(st.integers(0, 4))
    sizes = (*sizes[:3], nc, sizes[1] + nc, *sizes[5:])
    chain = kernel.Chain([0, *ends], sizes, tableau, q, r, ())
    use(chain, [0, *ends], sizes)


def use(chain: Any, ends: list[int], sizes: tuple[int, ...]) -> None:
    """Evaluate, factor and iterate with arrays of the sizes that a chain says it has."""
    K, nx, nz, nc, nb, nk, nt = sizes
    N, nv, last = ends[-1], nx + nz, len(ends) * nx + nc
    unknowns = N * (nx + K * nv) + nx + nc
    rng = np.random.default_rng(N)
    w, p, r = rng.normal(size=unknowns), rng.random(nt + nk * (len(ends) + K * N) + N), np.empty(0)
    r = np.empty(unknowns)
    stages, conditions = rng.normal(size=N * K * nv * (nv + nc)), rng.normal(size=nb * last)
    for only in (None, rng.normal(size=unknowns)):
        factors = chain.factor(stages, conditions, p[-N:].copy(), only)
        if factors is not None:
            factors.solve(w, r)
            assert len(factors.determinant) == 2
    try:
        chain.residuals(w, p, r)
    except ValueError:  # no programs
        return
    chain.linearize(w, p, r, stages, conditions)
    factors = chain.factor(stages, conditions, p[-N:].copy(), None)
    for given_ in (None, factors):
        found = chain.newton(w.copy(), p, rng.normal(size=nb), given_, r, SETTINGS)
        assert 0 <= found[0] < 5
