"""Residuals, factors and determinants of the kernel against whole dense matrices."""

from dataclasses import replace

import numpy as np
import pytest
from chains import KINDS, Case, Kind, case_of
from generic import of_first_node

from ribbonopt.arrays import Array
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.transcription.collocation.splitting import integrated_states
from ribbonopt.transcription.residuals import Derivatives

each_kind = pytest.mark.parametrize("kind", KINDS, ids=str)
pytestmark = pytest.mark.usefixtures("kernel")


def close(found: Array, expected: Array, factor: float = 1.0) -> bool:
    """Whether arrays agree to rounding, relative to the largest, or `factor` times that."""
    return bool(np.abs(found - expected).max() <= 1e-13 * factor * (1 + np.abs(expected).max()))


@each_kind
def test_states_apart_are_those_of_the_problem(kind: Kind) -> None:
    """Otherwise the cases do not test what they say."""
    found = integrated_states(case_of(kind).blocks.phases, kind.nx).tolist()
    assert found == list(range(kind.apart))


@each_kind
def test_residuals_are_those_of_the_sparse_program(kind: Kind) -> None:
    case = case_of(kind)
    expected = case.dense()[0]
    assert close(case.chain.residuals(case.w, case.p).vector(), expected)
    assert close(case.linearize()[0].vector(), expected)


@each_kind
def test_a_step_solves_the_whole_dense_system(kind: Kind) -> None:
    case = case_of(kind)
    values, J = case.dense()
    residuals, derivatives = case.linearize()
    expected = np.linalg.solve(J, -values)
    condition = np.linalg.cond(J)
    assert condition < 1e6, "too near to singular to compare"
    step = case.chain.factor(derivatives, case.p).solve(residuals)
    assert close(step, expected, condition)
    only = case.chain.factor(derivatives, case.p, residuals)
    assert close(only.solve(residuals), expected, condition)


@each_kind
def test_factors_serve_any_residuals(kind: Kind) -> None:
    case = case_of(kind)
    _, J = case.dense()
    factors = case.chain.factor(case.linearize()[1], case.p)
    other = case.chain.residuals(case.w + 0.3, case.p)
    expected = np.linalg.solve(J, -other.vector())
    assert close(factors.solve(other), expected, np.linalg.cond(J))


@each_kind
def test_the_determinant_is_that_of_the_first_node_and_the_constants(kind: Kind) -> None:
    case = case_of(kind)
    lay = case.blocks.layout
    matrix = of_first_node(case.dense()[1], lay.nx, lay.conditions_at)
    sign, log = np.linalg.slogdet(matrix)
    derivatives = case.linearize()[1]
    for factors in (case.chain.factor(derivatives, case.p), case.condensed(derivatives)):
        found = factors.determinant
        assert found[0] == sign
        assert found[1] == pytest.approx(log, rel=1e-9, abs=1e-9)


def of_zeros(kind: Kind) -> tuple[Case, Derivatives]:
    """Return a case whose equations do not depend on stages or constants, nor have conditions."""
    case = case_of(kind)
    _, derivatives = case.linearize()
    return case, Derivatives(0 * derivatives.stages, 0 * derivatives.conditions)


def both_refuse(case: Case, derivatives: Derivatives) -> bool:
    """Whether the kernel and numpy say that there are no factors."""
    for factor in (
        lambda: case.chain.factor(derivatives, case.p),
        lambda: case.chain.factor(derivatives, case.p, case.linearize()[0]),
        lambda: CondensedSystem(case.blocks, derivatives, case.p),
    ):
        with pytest.raises(np.linalg.LinAlgError):
            factor()
    return True


@pytest.mark.parametrize("elements", [(1,), (4,), (2, 3)])
def test_conditions_that_say_nothing_are_singular(elements: tuple[int, ...]) -> None:
    assert both_refuse(*of_zeros(Kind(elements=elements)))


def test_conditions_that_say_the_same_twice_are_singular() -> None:
    case, derivatives = of_zeros(Kind(nc=0, elements=(5,)))
    derivatives.conditions[0, 0] = derivatives.conditions[1, 0] = derivatives.conditions[2, 1] = 1
    assert both_refuse(case, derivatives)


def test_a_constant_of_no_equation_is_singular() -> None:
    case = case_of(Kind(nc=2))
    _, derivatives = case.linearize()
    derivatives.stages[:, :, :, -1] = 0
    derivatives.conditions[:, -1] = 0
    assert both_refuse(case, derivatives)


def test_algebraic_equations_of_no_unknown_are_singular() -> None:
    case = case_of(Kind(nz=2, apart=1))
    _, derivatives = case.linearize()
    derivatives.stages[2, 1, -1] = 0
    assert both_refuse(case, derivatives)


@pytest.mark.parametrize("apart", [0, 1])
def test_an_element_as_long_as_its_pole_is_singular(apart: int) -> None:
    """1 - h J / 2 = 0: the midpoint rule cannot make that step."""
    case = case_of(Kind(nx=2, degree=1, apart=apart))
    _, derivatives = case.linearize()
    case.p[-4:] = 0.25
    derivatives.stages[3, 0] = 0
    derivatives.stages[3, 0, 1, 1] = 8
    assert both_refuse(case, derivatives)


@pytest.mark.parametrize("part", ["stages", "conditions"])
def test_numbers_that_are_none_make_steps_that_are_none(part: str) -> None:
    case = case_of(Kind(elements=(9,)))
    residuals, derivatives = case.linearize()
    getattr(derivatives, part)[..., 1] = np.nan
    with np.errstate(all="ignore"):
        for factor in (case.chain.factor(derivatives, case.p), case.condensed(derivatives)):
            assert not np.isfinite(factor.solve(residuals)).all()


@pytest.mark.parametrize("part", ["stages", "conditions"])
def test_infinite_numbers_are_singular_or_make_steps_that_are_none(part: str) -> None:
    case = case_of(Kind(elements=(9,)))
    residuals, derivatives = case.linearize()
    getattr(derivatives, part)[..., 1] = np.inf
    try:
        step = case.chain.factor(derivatives, case.p).solve(residuals)
    except np.linalg.LinAlgError:
        return
    assert not np.isfinite(step).all()


def test_nothing_is_written_to_what_is_given() -> None:
    case = case_of(Kind(nz=1, apart=1, elements=(2, 3)))
    residuals, derivatives = case.linearize()
    given = case.w, case.p, residuals.vector(), derivatives.stages, derivatives.conditions
    before = [array.copy() for array in given]
    case.linearize()
    case.chain.factor(derivatives, case.p).solve(residuals)
    case.chain.factor(derivatives, case.p, residuals).solve(residuals)
    assert all(np.array_equal(a, b) for a, b in zip(given, before, strict=True))


def test_factors_of_some_residuals_serve_no_others() -> None:
    case = case_of(Kind())
    residuals, derivatives = case.linearize()
    factors = case.chain.factor(derivatives, case.p, residuals)
    with pytest.raises(ValueError, match="other residuals"):
        factors.solve(case.chain.residuals(case.w, case.p))


def test_a_chain_with_a_border_is_eliminated_and_not_evaluated() -> None:
    """One more constant and one more condition, of which there is no function."""
    case = case_of(Kind(nz=1, apart=1, elements=(2, 6)))
    wider = case.blocks.bordered
    assert wider.compiled is not None
    residuals, derivatives = case.linearize()
    rng = np.random.default_rng(1)
    shape = derivatives.stages.shape
    stages = np.concatenate([derivatives.stages, rng.normal(size=(*shape[:3], 1))], axis=3)
    conditions = rng.normal(size=np.add(derivatives.conditions.shape, 1))
    more = Derivatives(stages, conditions)
    given = replace(residuals, conditions=np.append(residuals.conditions, 0.4))
    found = wider.compiled.factor(more, case.p)
    expected = CondensedSystem(wider, more, case.p)
    assert close(found.solve(given), expected.solve(given), 1e3)
    assert found.determinant == pytest.approx(expected.determinant, rel=1e-9)
    w = np.zeros(wider.layout.unknowns)
    with pytest.raises(ValueError, match="without programs"):
        wider.compiled.residuals(w, case.p)
    with pytest.raises(ValueError, match="without programs"):
        wider.compiled.linearize(w, case.p)
