"""Newton steps of condensed systems against the whole Jacobian by differentiation, solved dense.

The problems are random: states that follow by integration are found in some, in others not.
"""

import casadi as ca
import numpy as np
import pytest
from analytic import bvp, layers, transcribed

from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.transcription import NLP
from ribbonopt.transcription.collocation.splitting import independent
from ribbonopt.transcription.residuals import Residuals

Array = np.ndarray

# Which state's derivative contains which state; what of them follows by integration.
PATTERNS = {
    "none": ([[1, 1, 0], [0, 1, 1], [1, 0, 1]], []),
    "first": ([[0, 1, 1], [1, 1, 1], [1, 1, 1]], [0]),
    "apart": ([[0, 1, 0, 1], [1, 1, 1, 0], [0, 1, 0, 1], [1, 1, 1, 1]], [0, 2]),
    "all": ([[0, 0], [0, 0]], [0, 1]),
    "rod": ([[0] * 3 + [1] * 4] * 3 + [[1] * 7] * 4, [0, 1, 2]),
    "chain": ([[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [1, 0, 0, 0]], [0, 2]),
}


def random_problem(
    contains: list[list[int]], algebraic: int, constants: int, phases: int
) -> BoundaryValueProblem:
    """Return a problem of quadratic equations with random coefficients."""
    random = np.random.default_rng(7)
    mask = np.array(contains)
    count = len(mask)
    x, z, c = ca.SX.sym("x", count), ca.SX.sym("z", algebraic), ca.SX.sym("c", constants)
    others = ca.vertcat(z, c)

    def phase(length: float) -> Phase:
        linear = ca.DM(mask * random.normal(size=mask.shape)) @ x
        square = ca.DM(mask * random.normal(size=mask.shape)) @ x**2
        rest = ca.DM(random.normal(size=(count, algebraic + constants))) @ (others + others**2)
        held = z + z**3 + ca.DM(random.normal(size=(algebraic, count))) @ ca.sin(x)
        held += ca.DM(random.normal(size=(algebraic, constants))) @ c
        return Phase(linear + square + rest, ca.SX(length), {}, algebraic=held)

    def conditions(*points: ca.SX) -> dict[str, ca.SX]:
        ends = ca.vertcat(points[0], points[-1], c)
        rows = ca.DM(random.normal(size=(count + constants, ends.numel()))) @ ends
        return {f"b{i}": rows[i] for i in range(count + constants)}

    lengths = np.linspace(0.4, 0.7, phases)
    return bvp(x, tuple(phase(length) for length in lengths), conditions, z=z, c=c)


def jacobian_of(nlp: NLP, w: Array, p: Array) -> Array:
    """Dense Jacobian of the program's constraints, by automatic differentiation of them."""
    at, numbers = ca.MX.sym("w", len(w)), ca.MX.sym("p", len(p))
    values = nlp.functions.constraints(at, numbers)
    return np.array(ca.Function("J", [at, numbers], [ca.jacobian(values, at)])(w, p))


def random_residuals(nlp: NLP) -> Residuals:
    lay, random = nlp.layout, np.random.default_rng(3)
    return Residuals(
        random.normal(size=(lay.element_count, lay.stages, lay.stage_equations)),
        random.normal(size=(lay.element_count, lay.nx)),
        random.normal(size=lay.conditions),
    )


@pytest.mark.parametrize("scheme", ["gauss", "radau", "lobatto"])
@pytest.mark.parametrize("algebraic", [0, 2])
@pytest.mark.parametrize("name", PATTERNS)
def test_steps_are_those_of_the_whole_jacobian(name: str, algebraic: int, scheme: str) -> None:
    contains, integrated = PATTERNS[name]
    nlp, p = transcribed(random_problem(contains, algebraic, 2, 2), scheme, 3, 3, 2)
    own = slice(0, len(contains))
    assert independent(nlp.blocks.phases[0].contains[own, own]).tolist() == integrated
    w = np.random.default_rng(5).normal(size=nlp.unknowns) / 2
    _, derivatives = nlp.blocks.linearize(w, p)
    jacobian, residuals = jacobian_of(nlp, w, p), random_residuals(nlp)
    truth = np.linalg.solve(jacobian, -residuals.vector())
    allowed = 1e-15 * np.linalg.cond(jacobian) * np.abs(truth).max()
    for only in (None, residuals):
        factors = CondensedSystem(nlp.blocks, derivatives, p, only)
        for _ in range(2):  # factors serve again
            assert np.abs(factors.solve(residuals) - truth).max() < allowed


@pytest.mark.parametrize("rate", [1.0, 1e3, 1e5])
def test_steps_are_right_where_elements_step_over_layers(rate: float) -> None:
    nlp, p = transcribed(layers(rate), "gauss", 4, 5)
    w = np.zeros(nlp.unknowns)
    _, derivatives = nlp.blocks.linearize(w, p)
    residuals = random_residuals(nlp)
    truth = np.linalg.solve(jacobian_of(nlp, w, p), -residuals.vector())
    found = CondensedSystem(nlp.blocks, derivatives, p).solve(residuals)
    assert np.abs(found - truth).max() < 1e-11 * np.abs(truth).max()


def test_factors_for_one_right_hand_side_refuse_others() -> None:
    nlp, p = transcribed(layers(1.0), "gauss", 2, 3)
    residuals, derivatives = nlp.blocks.linearize(np.zeros(nlp.unknowns), p)
    factors = CondensedSystem(nlp.blocks, derivatives, p, residuals)
    with pytest.raises(ValueError, match="other residuals"):
        factors.solve(random_residuals(nlp))
