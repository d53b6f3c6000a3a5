"""Coefficients of Gauss, Radau and Lobatto collocation against exact ones."""

from collections.abc import Callable

import numpy as np
import pytest
from mpmath import mp, mpf

from ribbonopt.errors import TranscriptionError
from ribbonopt.transcription import Tableau, gauss, lobatto, radau
from ribbonopt.transcription.tableaus import MAX_DEGREE, next_tableau

R3, R5, R6, R15 = np.sqrt([3.0, 5.0, 6.0, 15.0])
LOWEST = {gauss: 1, radau: 1, lobatto: 2}
each_family = pytest.mark.parametrize("family", LOWEST)
each_degree = pytest.mark.parametrize("degree", range(1, MAX_DEGREE + 1))
each_scheme = pytest.mark.parametrize(
    ("family", "degree"),
    [(family, k) for family, lowest in LOWEST.items() for k in range(lowest, MAX_DEGREE + 1)],
)

TEXTBOOK = [
    (gauss(1), [[1 / 2]], [1], [1 / 2]),
    (
        gauss(2),
        [[1 / 4, 1 / 4 - R3 / 6], [1 / 4 + R3 / 6, 1 / 4]],
        [1 / 2, 1 / 2],
        [1 / 2 - R3 / 6, 1 / 2 + R3 / 6],
    ),
    (
        gauss(3),
        [
            [5 / 36, 2 / 9 - R15 / 15, 5 / 36 - R15 / 30],
            [5 / 36 + R15 / 24, 2 / 9, 5 / 36 - R15 / 24],
            [5 / 36 + R15 / 30, 2 / 9 + R15 / 15, 5 / 36],
        ],
        [5 / 18, 4 / 9, 5 / 18],
        [1 / 2 - R15 / 10, 1 / 2, 1 / 2 + R15 / 10],
    ),
    (radau(1), [[1]], [1], [1]),
    (radau(2), [[5 / 12, -1 / 12], [3 / 4, 1 / 4]], [3 / 4, 1 / 4], [1 / 3, 1]),
    (
        radau(3),
        [
            [(88 - 7 * R6) / 360, (296 - 169 * R6) / 1800, (-2 + 3 * R6) / 225],
            [(296 + 169 * R6) / 1800, (88 + 7 * R6) / 360, (-2 - 3 * R6) / 225],
            [(16 - R6) / 36, (16 + R6) / 36, 1 / 9],
        ],
        [(16 - R6) / 36, (16 + R6) / 36, 1 / 9],
        [(4 - R6) / 10, (4 + R6) / 10, 1],
    ),
    (lobatto(2), [[0, 0], [1 / 2, 1 / 2]], [1 / 2, 1 / 2], [0, 1]),
    (
        lobatto(3),
        [[0, 0, 0], [5 / 24, 1 / 3, -1 / 24], [1 / 6, 2 / 3, 1 / 6]],
        [1 / 6, 2 / 3, 1 / 6],
        [0, 1 / 2, 1],
    ),
    (
        lobatto(4),
        [
            [0, 0, 0, 0],
            [
                *((11 + R5) / 120, (25 - R5) / 120),
                *((25 - 13 * R5) / 120, (-1 + R5) / 120),
            ],
            [
                *((11 - R5) / 120, (25 + 13 * R5) / 120),
                *((25 + R5) / 120, (-1 - R5) / 120),
            ],
            [1 / 12, 5 / 12, 5 / 12, 1 / 12],
        ],
        [1 / 12, 5 / 12, 5 / 12, 1 / 12],
        [0, (5 - R5) / 10, (5 + R5) / 10, 1],
    ),
]


@pytest.mark.parametrize(("found", "matrix", "weights", "nodes"), TEXTBOOK, ids=lambda x: None)
def test_small_tableaus_are_those_of_the_textbooks(
    found: Tableau, matrix: list[list[float]], weights: list[float], nodes: list[float]
) -> None:
    np.testing.assert_allclose(found.matrix, matrix, atol=4e-16)
    np.testing.assert_allclose(found.weights, weights, atol=4e-16)
    np.testing.assert_allclose(found.nodes, nodes, atol=4e-16)


def exact(family: Callable[[int], Tableau], degree: int) -> tuple[list[mpf], list[list[mpf]]]:
    """Nodes and Butcher matrix at high precision: roots, then integrals of Lagrange polynomials."""

    def defining(x: mpf) -> mpf:
        value, below = mp.legendre(degree, x), mp.legendre(degree - 1, x)
        if family is lobatto:  # zero where P_{K-1}' is, and at both ends
            return below * x - value
        return value if family is gauss else value - below

    starts = [mpf(float(2 * c - 1)) for c in family(degree).nodes]
    roots = [mpf(round(x)) if abs(x) == 1 else mp.findroot(defining, x) for x in starts]
    nodes = [(1 + x) / 2 for x in roots]
    moments = mp.matrix([[c**k for c in nodes] for k in range(degree)])
    rows = []
    for c in nodes:
        integrals = mp.matrix([c ** (k + 1) / (k + 1) for k in range(degree)])
        rows.append(list(mp.lu_solve(moments, integrals)))
    return nodes, rows


@each_scheme
def test_coefficients_are_right_to_rounding(family: Callable[[int], Tableau], degree: int) -> None:
    with mp.workdps(60):
        nodes, rows = exact(family, degree)
        found = family(degree)
        np.testing.assert_allclose(found.nodes, [float(c) for c in nodes], atol=4e-16)
        matrix = [[float(a) for a in row] for row in rows]
    np.testing.assert_allclose(found.matrix, matrix, atol=2e-15)


@each_scheme
def test_quadrature_is_exact_up_to_the_order_and_no_further(
    family: Callable[[int], Tableau], degree: int
) -> None:
    found = family(degree)
    k = np.arange(found.order)
    np.testing.assert_allclose(found.weights @ found.nodes[:, None] ** k, 1 / (k + 1), atol=1e-15)
    beyond = found.weights @ found.nodes**found.order - 1 / (found.order + 1)
    assert abs(beyond) > 1e-14 or degree > 8  # the error constant itself falls below rounding


@each_scheme
def test_stages_integrate_polynomials_below_the_degree(
    family: Callable[[int], Tableau], degree: int
) -> None:
    found = family(degree)
    for k in range(degree):
        expected = found.nodes ** (k + 1) / (k + 1)
        np.testing.assert_allclose(found.matrix @ found.nodes**k, expected, atol=1e-15)


@each_degree
def test_declared_orders(degree: int) -> None:
    assert (gauss(degree).order, radau(degree).order) == (2 * degree, 2 * degree - 1)
    if degree > 1:
        assert lobatto(degree).order == 2 * degree - 2


@each_scheme
def test_symplectic_means_that_quadratic_invariants_are_kept(
    family: Callable[[int], Tableau], degree: int
) -> None:
    t = family(degree)
    weighted = t.weights[:, None] * t.matrix
    defect = np.abs(weighted + weighted.T - np.outer(t.weights, t.weights)).max()
    assert (defect < 1e-15) == t.symplectic == (family is gauss)


@each_degree
def test_radau_ends_on_the_node(degree: int) -> None:
    found = radau(degree)
    assert found.nodes[-1] == 1
    np.testing.assert_allclose(found.matrix[-1], found.weights, atol=1e-15)


@each_scheme
def test_basis_is_one_at_its_node_and_zero_at_the_others(
    family: Callable[[int], Tableau], degree: int
) -> None:
    found = family(degree)
    np.testing.assert_allclose(found.basis(found.nodes), np.eye(degree), atol=2e-14)
    np.testing.assert_allclose(found.integrals(found.nodes), found.matrix, atol=1e-15)
    np.testing.assert_allclose(found.integrals(np.array([1.0]))[0], found.weights, atol=1e-15)


@each_family
@pytest.mark.parametrize("degree", [0, 11, -1])
def test_other_degrees_are_refused(family: Callable[[int], Tableau], degree: int) -> None:
    expected = f"found {degree}, expected .* from {LOWEST[family]} to 10"
    with pytest.raises(TranscriptionError, match=expected):
        family(degree)


def test_lobatto_needs_both_ends() -> None:
    with pytest.raises(TranscriptionError, match="found 1, expected a whole number from 2 to 10"):
        lobatto(1)


@pytest.mark.parametrize("degree", range(2, MAX_DEGREE + 1))
def test_lobatto_starts_and_ends_on_the_nodes(degree: int) -> None:
    found = lobatto(degree)
    assert (found.nodes[0], found.nodes[-1]) == (0, 1)
    np.testing.assert_allclose(found.matrix[0], 0, atol=1e-15)
    np.testing.assert_allclose(found.matrix[-1], found.weights, atol=1e-15)


@each_family
def test_next_tableau_has_one_degree_more_or_splits(family: Callable[[int], Tableau]) -> None:
    following, parts = next_tableau(family(3))
    assert (following.name, parts) == (family(4).name, 1)
    following, parts = next_tableau(family(MAX_DEGREE))
    assert (following.name, parts) == (family(MAX_DEGREE).name, 2)
