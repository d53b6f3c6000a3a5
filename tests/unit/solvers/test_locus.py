"""Equations with black-box conditions, against the dense Jacobian of all unknowns.

Following the locus of a fold is in `tests/unit/studies/test_walk_locus.py`.
"""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from generic import nonlinear, of_first_node, random_data

from ribbonopt.solvers.extended import Line
from ribbonopt.solvers.locus import LocusSystem
from ribbonopt.transcription import NLP, CollocationMethod, MultipleShooting

Array = np.ndarray
SCHEMES = {
    "gauss 3": CollocationMethod.named("gauss", 3),
    "shot gauss 3": MultipleShooting.named("gauss", 3, 2),
}


class Case:
    """A problem by k positions, and conditions that contain every unknown."""

    def __init__(self, scheme: str, elements: tuple[int, ...], count: int) -> None:
        rng = np.random.default_rng(11)
        self.nlp: NLP = SCHEMES[scheme].transcribe(nonlinear(len(elements)), elements)
        w, start = random_data(self.nlp, elements)
        self.slopes = np.zeros((len(start), count))
        self.slopes[:2] = rng.uniform(-1, 1, (2, count))
        parameters = lambda *where: start + self.slopes @ np.array(where)  # noqa: E731
        self.line = Line(self.nlp.blocks, parameters, 1e-5, count)
        self.z = np.append(w, np.linspace(0.01, 0.03, count))
        self.weights = rng.uniform(-1, 1, (count, len(self.z)))
        row = rng.uniform(-1, 1, len(self.line.reduced(self.z)))
        row[len(row) - count + 1 :] = 0.0
        self.system = LocusSystem(self.line, row, lambda z: np.sin(self.weights @ z))
        self.p = self.line.parameters(*self.z[-count:])

    def dense(self) -> Array:
        count = self.line.count
        w, p = ca.MX.sym("w", self.nlp.unknowns), ca.MX.sym("p", self.nlp.parameters)
        g = self.nlp.functions.constraints(w, p)
        both = ca.Function("J", [w, p], [ca.jacobian(g, w), ca.jacobian(g, p)])
        J, by_p = (np.array(part) for part in both(self.z[:-count], self.p))
        rows = np.cos(self.weights @ self.z)[:, None] * self.weights
        return np.vstack([np.column_stack([J, by_p @ self.slopes]), rows])


each_case = pytest.mark.parametrize(
    ("scheme", "elements", "count"),
    [(scheme, e, k) for scheme in SCHEMES for e in ((5,), (2, 3, 1)) for k in (1, 2, 3)],
    ids=str,
)


@each_case
def test_tangent_and_kernel_are_those_of_the_dense_jacobian(
    scheme: str, elements: tuple[int, ...], count: int
) -> None:
    case = Case(scheme, elements, count)
    factors = case.system.factor(case.system.linearize(case.z, case.p)[1], case.p)
    dense, right = case.dense(), np.zeros(len(case.z))
    for found, wanted in (
        (factors.direction, np.eye(count)[-1]),
        (factors.kernel(), np.append(np.ones(count - 1), 0.0)),
    ):
        right[-count:] = wanted
        size = max(np.abs(found).max(), 1)
        np.testing.assert_allclose(dense @ found, right, rtol=0, atol=1e-6 * size)


@each_case
def test_step_is_that_of_the_dense_jacobian_where_conditions_are_linear(
    scheme: str, elements: tuple[int, ...], count: int
) -> None:
    case = Case(scheme, elements, count)
    linear = replace(case.system, conditions=lambda z: case.weights @ z - 0.3)
    dense = case.dense()
    dense[-count:] = case.weights
    residuals, derivatives = linear.linearize(case.z, case.p)
    step = linear.factor(derivatives, case.p).solve(residuals)
    size = max(np.abs(step).max(), 1)
    off = linear.vector(case.z, case.p)
    np.testing.assert_allclose(dense @ step, -off, rtol=0, atol=1e-6 * size)


def test_determinants_are_dense_ones_without_all_nodes_but_the_first() -> None:
    signs, logs = [], []
    case = Case("gauss 3", (5,), 2)
    for seed in range(5):
        rng = np.random.default_rng(seed)
        case.z = case.z + 0.1 * rng.uniform(-1, 1, len(case.z))
        case.p = case.line.parameters(*case.z[-2:])
        factors = case.system.factor(case.system.linearize(case.z, case.p)[1], case.p)
        layout = case.nlp.layout
        J = of_first_node(case.dense(), layout.nx, layout.conditions_at)
        sign, log = np.linalg.slogdet(J)
        signs.append(factors.sign * sign)
        logs.append(factors.log - log)
    assert signs == [signs[0]] * len(signs)
    np.testing.assert_allclose(logs, logs[0], rtol=0, atol=1e-5)
