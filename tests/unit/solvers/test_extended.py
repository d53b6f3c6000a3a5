"""Problems along a line of parameters: slopes, tangents, determinants, and Bratu's fold.

Truth: u'' + l e^u = 0, u(0) = u(1) = 0 is solved by u = 2 log(cosh(t/4) / cosh((s - 1/2) t/2)) with
l = t^2 / (2 cosh^2(t/4)), which is largest where (t/4) tanh(t/4) = 1; automatic differentiation and
dense linear algebra.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np
import pytest
from analytic import bvp
from generic import nonlinear, of_first_node, random_data
from scipy.optimize import brentq

from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers import NewtonSolver, Status
from ribbonopt.solvers.extended import ExtendedSystem, Line, ScalarCondition
from ribbonopt.solvers.local import Local, local
from ribbonopt.transcription import NLP, CollocationMethod, Mesh, MultipleShooting

Array = np.ndarray
Scheme = CollocationMethod | MultipleShooting

FOLD_T = 4 * brentq(lambda x: x * math.tanh(x) - 1, 1, 2, xtol=1e-15)
FOLD = FOLD_T**2 / (2 * math.cosh(FOLD_T / 4) ** 2)

ACCURATE: dict[str, Scheme] = {
    "gauss 6": CollocationMethod.named("gauss", 6),
    "rk8": MultipleShooting.named("rk8", steps=3),
    "shot gauss 4": MultipleShooting.named("gauss", 4, 2),
}
ROUGH: dict[str, Scheme] = {
    "gauss 1": CollocationMethod.named("gauss", 1),
    "gauss 3": CollocationMethod.named("gauss", 3),
    "radau 2": CollocationMethod.named("radau", 2),
    "shot gauss 1": MultipleShooting.named("gauss", 1, 1),
    "shot gauss 3": MultipleShooting.named("gauss", 3, 2),
}
# nodes are reduced where a phase has more than 25 elements (of three states) or 39 (of two)
MESHES = [(7,), (3, 6), (5, 3, 27)]
FINE = [(1,), (5,), (2, 3, 1), (45, 2)]
each_mesh = pytest.mark.parametrize("elements", MESHES, ids=str)
each_accurate = pytest.mark.parametrize("scheme", ACCURATE)
each_rough = pytest.mark.parametrize("scheme", ROUGH)
each_fine = pytest.mark.parametrize("elements", FINE, ids=str)


def bratu(phases: int) -> BoundaryValueProblem:
    """Return Bratu's problem in equal phases; a constant c stands for the integral of u' s."""
    x, c, theta = ca.SX.sym("x", 3), ca.SX.sym("c"), ca.SX.sym("theta")
    s = ca.SX.sym("s")
    f = ca.vertcat(x[1], -theta * ca.exp(x[0]), x[1] * s)
    phase = Phase(f, ca.SX(1) / phases, {})

    def conditions(*points: ca.SX) -> dict[str, ca.SX]:
        a, b = points[0], points[-1]
        return {"left": a[0], "right": b[0], "none": a[2], "c": b[2] - c}

    return bvp(x, (phase,) * phases, conditions, c=c, theta=theta, s=s)


def swinging() -> BoundaryValueProblem:
    """u'' + l sin u = 0, u(0) = u(1) = 0: u = 0 is a branch, others cross it at l = (k pi)^2."""
    x, theta = ca.SX.sym("x", 2), ca.SX.sym("theta")
    phase = Phase(ca.vertcat(x[1], -theta * ca.sin(x[0])), ca.SX(1), {})
    return bvp(x, (phase,), lambda a, b: {"left": a[0], "right": b[0]}, theta=theta)


def loaded(t: float) -> float:
    """Return l of Bratu's solution t."""
    return t**2 / (2 * math.cosh(t / 4) ** 2)


def along(nlp: NLP, elements: tuple[int, ...], step: float = 1e-5) -> Line:
    """Return the line on which l is the only parameter, on a uniform mesh."""
    widths = Mesh.uniform(*elements).widths
    return Line(nlp.blocks, lambda position: np.concatenate([[position], widths]), step)


def transcribed(
    elements: tuple[int, ...], scheme: str, step: float = 1e-5
) -> tuple[NLP, Line, Array]:
    """Return Bratu's problem, its line, and its lower solution at l = 1."""
    nlp = ACCURATE[scheme].transcribe(bratu(len(elements)), elements)
    line = along(nlp, elements, step)
    report = NewtonSolver(nlp).solve(np.zeros(nlp.unknowns), line.parameters(1.0))
    assert report.status is Status.CONVERGED
    return nlp, line, report.w


@lru_cache(maxsize=1)
def whole_derivatives(nlp: NLP) -> ca.Function:
    """Return the function (w, p) of the derivatives of all constraints by both."""
    w, p = ca.MX.sym("w", nlp.unknowns), ca.MX.sym("p", nlp.parameters)
    g = nlp.functions.constraints(w, p)
    return ca.Function("J", [w, p], [ca.jacobian(g, w), ca.jacobian(g, p)])


def dense_jacobian(nlp: NLP, w: Array, p: Array, slope: Array, row: Array) -> Array:
    """Return the extended Jacobian from whole derivatives; `slope` is dp/dl."""
    J, by_parameters = (np.array(part) for part in whole_derivatives(nlp)(w, p))
    last = np.zeros(len(w) + 1)
    last[nlp.blocks.layout.condition_columns] = row[:-1]
    last[-1] = row[-1]
    return np.vstack([np.column_stack([J, by_parameters @ slope]), last])


def random_line(
    scheme: str, elements: tuple[int, ...]
) -> tuple[NLP, Line, Callable[[float], tuple[Array, Array]]]:
    """Return a curved line of a problem that uses the whole contract; its p and dp/dl."""
    nlp = ROUGH[scheme].transcribe(nonlinear(len(elements)), elements)
    _, start = random_data(nlp, elements)

    def parameters(position: float) -> tuple[Array, Array]:
        p, slope = start.copy(), np.zeros_like(start)
        p[:2] = 0.3 + math.sin(position), 0.8 + 0.2 * position**2
        slope[:2] = math.cos(position), 0.4 * position
        return p, slope

    return nlp, Line(nlp.blocks, lambda position: parameters(position)[0], 1e-5), parameters


def random_row(line: Line, w: Array, seed: int) -> Array:
    return np.random.default_rng(seed).uniform(-1, 1, len(line.at_points(w)) + 1)


# slopes


@each_mesh
@each_accurate
def test_slope_where_equations_are_linear_in_the_parameter(
    elements: tuple[int, ...], scheme: str
) -> None:
    nlp = ACCURATE[scheme].transcribe(bratu(len(elements)), elements)
    line = along(nlp, elements, 0.5)  # no error at all, however far
    w = np.random.default_rng(3).uniform(-1, 1, nlp.unknowns)
    stages, conditions = line.slope(w, 2.0)
    if isinstance(ACCURATE[scheme], CollocationMethod):
        one, none = (nlp.blocks.values(w, line.parameters(position))[0] for position in (1.0, 0.0))
        np.testing.assert_allclose(stages, one - none, rtol=0, atol=1e-13)
        # of three equations of a stage, only the second contains l
        assert np.abs(stages[..., 1]).min() > 1e-4
        np.testing.assert_array_equal(stages[..., [0, 2]], 0)
    np.testing.assert_array_equal(conditions, 0)


@each_fine
@each_rough
def test_slope_is_that_of_automatic_differentiation(elements: tuple[int, ...], scheme: str) -> None:
    nlp, line, parameters = random_line(scheme, elements)
    w, _ = random_data(nlp, elements)
    p, slope = parameters(0.4)
    exact = dense_jacobian(nlp, w, p, slope, random_row(line, w, 0))[:-1, -1]
    stages, conditions = line.slope(w, 0.4)
    np.testing.assert_allclose(conditions, exact[len(exact) - len(conditions) :], atol=1e-9)
    assert np.abs(conditions).max() > 0.1
    if isinstance(ROUGH[scheme], MultipleShooting):
        inside = exact[: len(exact) - len(conditions)]
        np.testing.assert_allclose(-stages.ravel(), inside, atol=1e-9)


def test_slope_is_of_second_order() -> None:
    nlp, line, parameters = random_line("shot gauss 3", (5,))
    w, _ = random_data(nlp, (5,))
    exact = dense_jacobian(nlp, w, *parameters(0.4), random_row(line, w, 0))[:-1, -1]
    errors = []
    for step in (4e-2, 2e-2, 1e-2):
        stages, conditions = replace(line, step=step).slope(w, 0.4)
        errors.append(np.abs(np.append(-stages, conditions) - exact).max())
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2, atol=0.05)


# the extended system


@each_fine
@each_rough
def test_step_is_that_of_the_dense_extended_jacobian(
    elements: tuple[int, ...], scheme: str
) -> None:
    nlp, line, parameters = random_line(scheme, elements)
    w, _ = random_data(nlp, elements)
    row = random_row(line, w, 1)
    system = ExtendedSystem(line, row, 0.7)
    y = np.append(w, 0.4)
    p, slope = parameters(0.4)
    residuals, derivatives = system.linearize(y, p)
    J = dense_jacobian(nlp, w, p, slope, row)
    own = np.array(nlp.functions.constraints(w, p)).ravel()
    off = row @ np.append(line.at_points(w), 0.4) - 0.7
    np.testing.assert_allclose(residuals.vector(), np.append(own, off), atol=1e-13)
    np.testing.assert_array_equal(system.vector(y, p), residuals.vector())
    step = system.factor(derivatives, p).solve(residuals)
    expected = np.linalg.solve(J, -residuals.vector())
    size = np.linalg.cond(J) * np.abs(expected).max()
    np.testing.assert_allclose(step, expected, rtol=0, atol=max(1e-15 * size, 1e-9 * size**0.5))
    np.testing.assert_allclose(
        J @ step, -residuals.vector(), rtol=0, atol=1e-8 * np.abs(step).max()
    )


@each_fine
@each_rough
def test_direction_and_solve_are_of_the_dense_jacobian(
    elements: tuple[int, ...], scheme: str
) -> None:
    nlp, line, parameters = random_line(scheme, elements)
    w, _ = random_data(nlp, elements)
    row = random_row(line, w, 2)
    found = local(line, row, w, 0.4)
    J = dense_jacobian(nlp, w, *parameters(0.4), row)
    last = np.zeros(len(J))
    last[-1] = 1
    size = np.abs(found.direction).max()
    np.testing.assert_allclose(J @ found.direction, last, rtol=0, atol=1e-8 * max(size, 1))
    y = np.append(line.at_points(found.direction[:-1]), found.direction[-1])
    assert row @ y == pytest.approx(1, abs=1e-11 * max(size, 1))
    sides = np.random.default_rng(4).uniform(-1, 1, nlp.blocks.layout.conditions + 1)
    solved = found.solve(sides)
    right = np.zeros(len(J))
    right[len(J) - len(sides) :] = sides
    np.testing.assert_allclose(J @ solved, right, rtol=0, atol=1e-8 * max(np.abs(solved).max(), 1))


@each_fine
@each_rough
def test_determinant_is_that_of_the_conditions_by_the_first_node_and_constants(
    elements: tuple[int, ...], scheme: str
) -> None:
    nlp, line, parameters = random_line(scheme, elements)
    layout, found_some = nlp.blocks.layout, 0
    for seed in range(6):
        w, _ = random_data(nlp, elements, seed)
        row, position = random_row(line, w, seed), 0.1 * seed
        if not np.isfinite(nlp.blocks.residuals(w, parameters(position)[0]).vector()).all():
            continue  # steps of shooting, implicit themselves, do not exist for all data
        found = local(line, row, w, position)
        J = dense_jacobian(nlp, w, *parameters(position), row)
        sign, log = np.linalg.slogdet(of_first_node(J, layout.nx, layout.conditions_at))
        assert found.sign == sign
        assert found.log == pytest.approx(log, abs=1e-6)
        found_some += 1
    assert found_some >= 3


def test_both_signs_of_determinants_occur() -> None:
    nlp, line, _ = random_line("gauss 3", (43,))
    found = [random_data(nlp, (43,), seed)[0] for seed in range(8)]
    signs = [local(line, random_row(line, w, i), w, 0.4).sign for i, w in enumerate(found)]
    assert sorted(set(signs)) == [-1.0, 1.0]
    # the other way round the row, the other sign
    other = [local(line, -random_row(line, w, i), w, 0.4).sign for i, w in enumerate(found)]
    assert other == [-sign for sign in signs]


@pytest.mark.parametrize("count", [1, 6, 47])
@pytest.mark.parametrize("scheme", ["rk8", "shot gauss 4", "gauss 6"])
def test_determinant_vanishes_where_branches_cross(scheme: str, count: int) -> None:
    nlp = ACCURATE[scheme].transcribe(swinging(), (count,))
    line = along(nlp, (count,))
    w = np.zeros(nlp.unknowns)
    row = np.zeros(len(line.at_points(w)) + 1)
    row[-1] = 1

    def at(position: float) -> Local:
        return local(line, row, w, position)

    def determinant(position: float, unit: float) -> float:
        try:
            found = at(position)
        except np.linalg.LinAlgError:  # singular to the last digit
            return 0.0
        return found.sign * math.exp(found.log - unit)

    for k in (1, 2):
        before, after = at((k * math.pi) ** 2 - 0.5), at((k * math.pi) ** 2 + 0.5)
        assert before.sign * after.sign == -1
        crossing = (k * math.pi) ** 2
        root = brentq(determinant, crossing - 0.5, crossing + 0.5, (before.log,), xtol=1e-13)
        # one element alone is as good as its method
        assert root == pytest.approx(crossing, rel=1e-9 if count > 1 else 0.05)
    if scheme != "gauss 6" and count > 1:
        # shooting has no other factors than sin(sqrt l) / sqrt l
        exact = [math.sin(math.sqrt(x)) / math.sqrt(x) for x in (3.0, 17.0)]
        ratio = at(3.0).sign * at(17.0).sign * math.exp(at(3.0).log - at(17.0).log)
        assert ratio == pytest.approx(exact[0] / exact[1], rel=1e-8)


# several positions


class Curved(NamedTuple):
    """The condition sin(row . y) = 1/2."""

    line: Line
    weights: Array

    def value(self, extended: Array) -> float:
        return math.sin(self.weights @ self.line.reduced(extended)) - 0.5

    def row(self, extended: Array) -> Array:
        return math.cos(self.weights @ self.line.reduced(extended)) * self.weights


class Linear(NamedTuple):
    """The condition row . y = value."""

    line: Line
    weights: Array
    wanted: float

    def value(self, extended: Array) -> float:
        return float(self.weights @ self.line.reduced(extended) - self.wanted)

    def row(self, extended: Array) -> Array:
        return self.weights


def surface(nlp: NLP, elements: tuple[int, ...], count: int) -> tuple[Line, Array]:
    """Return a problem whose parameters depend on several positions, and their derivatives."""
    _, start = random_data(nlp, elements)
    slopes = np.zeros((len(start), count))
    slopes[:2] = np.random.default_rng(8).uniform(-1, 1, (2, count))
    at = np.linspace(0.1, 0.3, count)
    return Line(
        nlp.blocks, lambda *where: start + slopes @ (np.array(where) - at), 1e-5, count
    ), slopes


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("scheme", ["gauss 3", "shot gauss 3"])
@each_fine
def test_several_positions_are_those_of_the_dense_jacobian(
    elements: tuple[int, ...], scheme: str, count: int
) -> None:
    nlp = ROUGH[scheme].transcribe(nonlinear(len(elements)), elements)
    line, slopes = surface(nlp, elements, count)
    w, _ = random_data(nlp, elements)
    z = np.append(w, np.linspace(0.1, 0.3, count))
    rng = np.random.default_rng(9)
    rows = rng.uniform(-1, 1, (count, len(line.reduced(z))))
    further: tuple[ScalarCondition, ...] = tuple(Curved(line, row) for row in rows[:-1])
    system, p = ExtendedSystem(line, rows[-1], 0.7, further), line.parameters(*z[-count:])

    J, by_parameters = (np.array(part) for part in whole_derivatives(nlp)(w, p))
    last = np.zeros((count, len(z)))
    columns = [*nlp.blocks.layout.condition_columns, *range(len(w), len(z))]
    last[:, columns] = [*(condition.row(z) for condition in further), rows[-1]]
    dense = np.vstack([np.column_stack([J, by_parameters @ slopes]), last])
    off = [*(condition.value(z) for condition in further), rows[-1] @ line.reduced(z) - 0.7]
    own = np.array(nlp.functions.constraints(w, p)).ravel()

    residuals, derivatives = system.linearize(z, p)
    np.testing.assert_allclose(residuals.vector(), np.append(own, off), atol=1e-13)
    np.testing.assert_array_equal(system.vector(z, p), residuals.vector())
    step = system.factor(derivatives, p).solve(residuals)
    size = max(np.abs(step).max(), 1)
    np.testing.assert_allclose(dense @ step, -residuals.vector(), rtol=0, atol=1e-8 * size)

    found = local(line, rows[-1], w, z[-count:], further)
    unit = np.append(np.zeros(len(z) - 1), 1)
    size = max(np.abs(found.direction).max(), 1)
    np.testing.assert_allclose(dense @ found.direction, unit, rtol=0, atol=1e-8 * size)
    right = np.zeros(len(z))
    right[len(z) - len(residuals.conditions) : -1] = np.cos(
        np.arange(1.0, len(residuals.conditions))
    )
    size = max(np.abs(found.kernel()).max(), 1)
    np.testing.assert_allclose(dense @ found.kernel(), right, rtol=0, atol=1e-8 * size)


def test_conditions_and_positions_are_counted() -> None:
    nlp = ROUGH["gauss 3"].transcribe(nonlinear(1), (5,))
    line, _ = surface(nlp, (5,), 2)
    with pytest.raises(ValueError, match=r"found 0 conditions, expected 1"):
        ExtendedSystem(line, np.zeros(1), 0.0)


def raised() -> BoundaryValueProblem:
    """u'' + l1 e^u = 0, u(0) = u(1) = l2: Bratu's problem for l1 exp(l2), raised by l2."""
    x, theta = ca.SX.sym("x", 2), ca.SX.sym("theta", 2)
    phase = Phase(ca.vertcat(x[1], -theta[0] * ca.exp(x[0])), ca.SX(1), {})

    def conditions(a: ca.SX, b: ca.SX) -> dict[str, ca.SX]:
        return {"left": a[0] - theta[1], "right": b[0] - theta[1]}

    return bvp(x, (phase,), conditions, theta=theta)


@pytest.mark.parametrize("scheme", ACCURATE)
def test_locus_of_the_fold_by_two_positions(scheme: str) -> None:
    nlp = ACCURATE[scheme].transcribe(raised(), (12,))
    widths = Mesh.uniform(12).widths
    line = Line(nlp.blocks, lambda a, b: np.concatenate([[a, b], widths]), 1e-5, 2)
    # the fold is where u'(0) is that of Bratu's: there l1 alone does not tell the solution
    weights = np.zeros(line.blocks.layout.nx * 2 + 2)
    weights[1] = 1.0
    tells = (Linear(line, weights, FOLD_T * math.tanh(FOLD_T / 4)),)
    row = np.zeros_like(weights)
    row[-1] = 1.0
    w = NewtonSolver(nlp).solve(np.zeros(nlp.unknowns), line.parameters(3.3, 0.0)).w
    z = np.append(w, [3.3, 0.0])
    for second in (0.0, 0.4, 0.8, -0.5):
        system = ExtendedSystem(line, row, second, tells)
        report = NewtonSolver(nlp).solve(z, line.parameters(*z[-2:]), system=system)
        assert report.status is Status.CONVERGED
        z = report.w
        assert z[-1] == pytest.approx(second, abs=1e-14)
        assert z[-2] == pytest.approx(FOLD * math.exp(-second), rel=2e-9)
        # along the locus, d l1 / d l2 = -l1
        found = local(line, row, z[:-2], z[-2:], tells)
        assert found.direction[-2] == pytest.approx(-z[-2], rel=1e-8)


# Bratu's branch


@each_mesh
@each_accurate
def test_tangent_is_that_of_finite_differences(elements: tuple[int, ...], scheme: str) -> None:
    nlp, line, w = transcribed(elements, scheme)
    h = 1e-4
    found = local(line, random_row(line, w, 5), w, 1.0)
    ahead, behind = (
        NewtonSolver(nlp).solve(w, line.parameters(1.0 + sign * h)).w for sign in (1.0, -1.0)
    )
    expected = np.append((ahead - behind) / (2 * h), 1)
    np.testing.assert_allclose(found.direction / found.direction[-1], expected, rtol=0, atol=1e-7)


def test_tangent_is_that_of_the_formula() -> None:
    _, line, w = transcribed((7,), "gauss 6")
    t = brentq(lambda t: loaded(t) - 1, 0.5, FOLD_T, xtol=1e-15)
    h = 1e-5
    # u'(0) = t tanh(t/4)
    slope = ((t + h) * math.tanh((t + h) / 4) - (t - h) * math.tanh((t - h) / 4)) / (2 * h)
    slope /= (loaded(t + h) - loaded(t - h)) / (2 * h)
    found = local(line, random_row(line, w, 6), w, 1.0)
    assert found.direction[1] / found.direction[-1] == pytest.approx(slope, rel=1e-8)


class Branch:
    """Bratu's branch by pseudo-arclength steps made by hand."""

    def __init__(self, elements: tuple[int, ...], scheme: str) -> None:
        self.nlp, self.line, w = transcribed(elements, scheme)
        row = np.zeros(len(self.line.at_points(w)) + 1)
        row[-1] = 1.0
        self.y = np.append(w, 1.0)
        self.here, self.tangent = self.linearised(row)

    def reduced(self, y: Array) -> Array:
        return np.append(self.line.at_points(y[:-1]), y[-1])

    def linearised(self, row: Array) -> tuple[Local, Array]:
        found = local(self.line, row, self.y[:-1], float(self.y[-1]))
        return found, found.direction / np.linalg.norm(self.reduced(found.direction))

    def corrected(self, arc: float) -> Array:
        """Return [w, l] at an arclength ahead."""
        row = self.reduced(self.tangent)
        system = ExtendedSystem(self.line, row, float(row @ self.reduced(self.y)) + arc)
        p = self.line.parameters(float(self.y[-1]))
        report = NewtonSolver(self.nlp).solve(self.y + arc * self.tangent, p, system=system)
        assert report.status is Status.CONVERGED, report.status
        return report.w

    def step(self, arc: float) -> None:
        self.y = self.corrected(arc)
        self.here, self.tangent = self.linearised(self.reduced(self.tangent))

    @property
    def errors(self) -> Array:
        """Errors of l and c for the u'(0) that was found."""
        nodes, _, c = self.nlp.blocks.layout.unpack(self.y[:-1])
        slope = nodes[0, 1]
        t = brentq(lambda t: t * math.tanh(t / 4) - slope, 0.01, 30, xtol=1e-15, rtol=1e-15)
        # the integral of u' s is minus that of u, as u(1) = 0
        s, weights = np.polynomial.legendre.leggauss(60)
        u = 2 * np.log(math.cosh(t / 4) / np.cosh(s * t / 4))
        return np.abs([self.y[-1] - loaded(t), c[0] + weights @ u / 2, nodes[-1, 1] + slope])


@each_mesh
@each_accurate
def test_steps_of_arclength_go_through_the_fold(elements: tuple[int, ...], scheme: str) -> None:
    branch = Branch(elements, scheme)
    signs, rises, positions = [], [], []
    while branch.y[-1] > 0.9:
        assert branch.errors.max() < 1e-7
        signs.append(branch.here.sign)
        rises.append(bool(branch.tangent[-1] > 0))
        positions.append(branch.y[-1])
        branch.step(0.8)
        assert len(signs) < 50
    # up, over the fold, and down; the determinant knows nothing of it
    turn = rises.index(False)
    assert rises == [True] * turn + [False] * (len(rises) - turn)
    assert turn > 3
    assert len(rises) - turn > 3
    assert signs == [signs[0]] * len(signs)
    assert max(positions) < FOLD + 1e-7


@each_mesh
@each_accurate
def test_fold_is_where_the_tangent_has_no_share_of_the_parameter(
    elements: tuple[int, ...], scheme: str
) -> None:
    assert pytest.approx(3.513830719125162, abs=1e-14) == FOLD
    branch = Branch(elements, scheme)
    while branch.tangent[-1] > 0:
        before = branch.y, branch.tangent
        branch.step(0.5)
    branch.y, branch.tangent = start = before

    def slope(arc: float) -> float:
        branch.y, branch.tangent = start
        branch.step(arc)
        return float(branch.tangent[-1])

    brentq(slope, 0.0, 0.5, xtol=1e-9)
    assert branch.y[-1] == pytest.approx(FOLD, abs=1e-8)
    assert branch.errors.max() < 1e-8
    # the determinant without the row vanishes there, the extended one is as large as before
    assert math.isfinite(branch.here.log)


def test_natural_steps_are_the_row_of_the_position_alone() -> None:
    nlp, line, w = transcribed((3, 6), "gauss 6")
    row = np.zeros(len(line.at_points(w)) + 1)
    row[-1] = 1.0
    system = ExtendedSystem(line, row, 2.5)
    report = NewtonSolver(nlp).solve(np.append(w, 1.0), line.parameters(1.0), system=system)
    assert report.status is Status.CONVERGED
    assert report.w[-1] == pytest.approx(2.5, abs=1e-14)
    other = NewtonSolver(nlp).solve(w, line.parameters(2.5))
    np.testing.assert_allclose(report.w[:-1], other.w, rtol=0, atol=1e-11)


def test_points_beyond_the_fold_are_not_there() -> None:
    nlp, line, w = transcribed((7,), "gauss 6")
    assert NewtonSolver(nlp).solve(w, line.parameters(FOLD + 0.1)).status is not Status.CONVERGED
