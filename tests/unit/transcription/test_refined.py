"""Dense output at many places: as exact as that at few, whatever the equations are like.

Truth: solutions in closed form, and a Moebius ribbon whose halves are images of one another.
"""

import casadi as ca
import numpy as np
import pytest
from analytic import bvp, by_newton, layers, layers_exact, rational, rational_exact

from ribbonopt.problem import Phase

SIGMA = np.linspace(0, 1, 401)


@pytest.mark.parametrize("scheme", ["gauss", "radau"])
@pytest.mark.parametrize(("degree", "intervals"), [(1, 8), (2, 8), (3, 8), (4, 8), (6, 4)])
def test_it_is_as_exact_as_substeps(scheme: str, degree: int, intervals: int) -> None:
    _, dense = by_newton(rational(), scheme, degree, intervals)
    exact = rational_exact(SIGMA)
    few, many = (np.abs(read(0, SIGMA) - exact).max() for read in (dense.states, dense.many))
    assert many <= 1.2 * few + 1e-12
    np.testing.assert_allclose(dense.many(0, dense.nodes(0)), dense.at_nodes, atol=1e-12)


def test_the_polynomial_of_the_scheme_alone_would_not_be() -> None:
    _, dense = by_newton(rational(), "gauss", 4, 4)
    exact = rational_exact(SIGMA)
    rough = np.abs(dense.approximate(0, SIGMA) - exact).max()
    assert np.abs(dense.many(0, SIGMA) - exact).max() < 0.05 * rough
    assert dense.polynomials.fit.all()


@pytest.mark.parametrize("rate", [3.0, 30.0, 1000.0])
def test_where_solutions_part_fast_it_is_that_of_few_places(rate: float) -> None:
    _, dense = by_newton(layers(rate), "gauss", 4, 12)
    exact = layers_exact(rate, SIGMA)
    few, many = (np.abs(read(0, SIGMA) - exact).max() for read in (dense.states, dense.many))
    assert many <= 1.2 * few + 1e-9
    assert dense.polynomials.fit.all() == (rate == 3.0)


def test_an_element_with_a_kink_is_left_to_substeps() -> None:
    # x' = |s - a|: what is left of the kink knows nothing of it.
    s, x, a = ca.SX.sym("s"), ca.SX.sym("x"), 0.55
    phase = Phase(ca.fabs(s - a), ca.SX(1), {})
    problem = bvp(x, (phase,), lambda first, _: {"start": first[0]}, s=s)
    _, dense = by_newton(problem, "gauss", 4, 4)
    assert dense.polynomials.fit.tolist() == [True, True, False, True]
    before = SIGMA[SIGMA < a]
    exact = a * before - before**2 / 2
    np.testing.assert_allclose(dense.many(0, before)[:, 0], exact, atol=1e-14)
