"""Gauss, Radau and Lobatto collocation coefficients, computed in double precision for any degree.

A scheme with K nodes c_j integrates f over a unit step by the polynomial of degree K - 1 through
f(c_j). With shifted Legendre polynomials P_k, the discrete orthogonality of P_k on the nodes (all
families integrate degree 2K - 3 exactly) gives the Lagrange basis, and so its integral, in closed
form:

    l_j(t) = b_j sum_k P_k(c_j) P_k(t) / |P_k|^2,      a_ij = integral of l_j from 0 to c_i,

with the discrete norm |P_k|^2 = sum_j b_j P_k(c_j)^2: 1 / (2k + 1), but for the last k of Lobatto.

`casadi.collocation_coeff` loses digits as the degree grows; these sums do not.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, lru_cache

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import TranscriptionError

MAX_DEGREE = 10


@dataclass(frozen=True, eq=False)
class Inside:
    """Places t (n,) in any element, the Lagrange basis there and its integrals (n, K) from 0."""

    t: Array
    basis: Array
    integrals: Array


@dataclass(frozen=True, eq=False)
class Tableau:
    """One collocation scheme on the unit step.

    Attributes
    ----------
    name : str
        Family and degree, such as "gauss 6".
    nodes, weights : (K,) arrays
        Abscissae c_j in [0, 1] and quadrature weights b_j.
    matrix : (K, K) array
        Butcher matrix a_ij.
    order : int
        Declared order of the values at the ends of the steps.
    symplectic : bool
        Whether quadratic invariants (|q| = 1, orthonormality, n . m) are kept to rounding.
    family : function of int
        The scheme of another degree in the same family.
    """

    name: str
    nodes: Array
    weights: Array
    matrix: Array
    order: int
    symplectic: bool
    family: Callable[[int], Tableau]

    @property
    def degree(self) -> int:
        """Number of nodes K, the degree of the collocation polynomial."""
        return len(self.nodes)

    @property
    def dense_order(self) -> int:
        """Order of the error of the collocation polynomial between the nodes."""
        return min(self.degree + 1, self.order)

    def basis(self, t: Array) -> Array:
        """Lagrange basis l_j(t); t has shape (n,), the result (n, K)."""
        return np.asarray(_shifted_legendre(t, self.degree - 1) @ self.legendre)

    def integrals(self, t: Array) -> Array:
        """Integrals of the l_j from 0 to t; t has shape (n,), the result (n, K)."""
        return np.asarray(_legendre_integrals(t, self.degree - 1) @ self.legendre)

    @cached_property
    def between(self) -> Inside:
        """K + 1 places apart from the nodes, where residuals are looked at."""
        return self.inside((np.arange(self.degree + 1) + 0.5) / (self.degree + 1))

    @cached_property
    def at_better(self) -> Inside:
        """Nodes of the scheme of one degree more in the family."""
        return self.inside(self.family(self.degree + 1).nodes)

    def inside(self, t: Array) -> Inside:
        """Return the basis and its integrals at places t (n,)."""
        return Inside(t, self.basis(t), self.integrals(t))

    @cached_property
    def coefficients(self) -> Array:
        """Butcher matrix, and the weights below it: (K + 1, K)."""
        return np.vstack([self.matrix, self.weights])

    @cached_property
    def legendre(self) -> Array:
        """Coefficients (K, K) of the shifted Legendre polynomials, from values at the nodes."""
        return _scaled(self.nodes, self.weights)


def gauss(degree: int) -> Tableau:
    """Gauss-Legendre collocation, order 2K, symplectic (keeps quadratic invariants)."""
    return _gauss(_checked(degree))


def gauss_of_any(degree: int) -> Tableau:
    """Gauss-Legendre collocation of any degree, for what is read out: nothing is solved on it."""
    return _gauss(degree)


def radau(degree: int) -> Tableau:
    """Radau IIA collocation (last node at the end of the step), order 2K - 1, stiffly accurate."""
    return _radau(_checked(degree))


def lobatto(degree: int) -> Tableau:
    """Lobatto IIIA collocation (both ends are nodes), order 2K - 2, degree 2 or more."""
    return _lobatto(_checked(degree, lowest=2))


def next_tableau(tableau: Tableau) -> tuple[Tableau, int]:
    """Return the next better scheme of a family, and into how many parts to split each element.

    One degree more, or the same degree on halved elements where there is none.
    """
    if tableau.degree == MAX_DEGREE:
        return tableau, 2
    return tableau.family(tableau.degree + 1), 1


def _checked(degree: int, lowest: int = 1) -> int:
    if not lowest <= degree <= MAX_DEGREE:
        raise TranscriptionError(
            f"collocation degree: found {degree}, expected a whole number from {lowest} to "
            f"{MAX_DEGREE}"
        )
    return degree


@lru_cache
def _gauss(degree: int) -> Tableau:
    # Nodes: roots of P_K, from Tricomi's approximation.
    guess = np.cos(np.pi * (4 * np.arange(degree, 0, -1) - 1) / (4 * degree + 2))
    x = _roots(guess, degree, 0.0)
    weights = (1 - x**2) / (degree * _legendre(x, degree)[:, degree - 1]) ** 2
    return _tableau("gauss", (1 + x) / 2, weights, 2 * degree, gauss)


@lru_cache
def _radau(degree: int) -> Tableau:
    # Nodes: x = 1 and the other roots of P_K - P_{K-1}, interlaced with Chebyshev-like angles.
    guess = np.cos(2 * np.pi * np.arange(degree - 1, 0, -1) / (2 * degree - 1))
    x = np.append(_roots(guess, degree, -1.0), 1.0)
    # Weights of the right Radau rule: (1 + x) / (K P_{K-1}(x))^2, up to a factor.
    last = _legendre(x, degree)[:, degree - 1]
    weights = (1 + x) / (degree * last) ** 2
    return _tableau("radau", (1 + x) / 2, weights, 2 * degree - 1, radau)


@lru_cache
def _lobatto(degree: int) -> Tableau:
    # Nodes: +-1 and the roots of P_{K-1}', which are those of x P_{K-1} - P_{K-2} in between.
    x = np.cos(np.pi * np.arange(degree - 1, -1, -1) / (degree - 1))
    for _ in range(20):
        P = _legendre(x, degree - 1)
        x = x - (x * P[:, -1] - P[:, -2]) / (degree * P[:, -1])
    x[0], x[-1] = -1, 1
    weights = 1 / _legendre(x, degree - 1)[:, -1] ** 2
    return _tableau("lobatto", (1 + x) / 2, weights, 2 * degree - 2, lobatto)


def _roots(x: Array, degree: int, share: float) -> Array:
    """Roots in (-1, 1) of P_K + share P_{K-1}, by Newton's method from nearby guesses."""
    for _ in range(20):
        P = _legendre(x, degree)
        below = P[:, degree - 2] if degree > 1 else np.zeros_like(x)
        # (1 - x^2) P_k' = k (P_{k-1} - x P_k)
        slope = degree * (P[:, degree - 1] - x * P[:, degree])
        slope += share * (degree - 1) * (below - x * P[:, degree - 1])
        step = (P[:, degree] + share * P[:, degree - 1]) * (1 - x**2) / slope
        x = x - step
        if np.abs(step).max(initial=0.0) < 1e-15:
            break
    return x


def _tableau(
    name: str, nodes: Array, weights: Array, order: int, family: Callable[[int], Tableau]
) -> Tableau:
    """Tableau of nodes and of weights up to a factor."""
    degree, weights = len(nodes), weights / weights.sum()
    matrix = _legendre_integrals(nodes, degree - 1) @ _scaled(nodes, weights)
    symplectic = order == 2 * degree  # collocation keeps quadratic invariants at Gauss nodes only
    return Tableau(f"{name} {degree}", nodes, weights, matrix, order, symplectic, family)


def _scaled(nodes: Array, weights: Array) -> Array:
    """(K, K) array P_k(c_j) b_j / |P_k|^2: Legendre coefficients of the Lagrange basis."""
    weighted = _shifted_legendre(nodes, len(nodes) - 1) * weights[:, None]
    norms = (weighted * _shifted_legendre(nodes, len(nodes) - 1)).sum(axis=0)
    return np.asarray((weighted / norms).T)


def _legendre(x: Array, degree: int) -> Array:
    """Values P_0 ... P_degree at x (n,), an array (n, degree + 1), by the three-term recurrence."""
    P = np.ones((degree + 1, len(x)))
    if degree > 0:
        P[1] = x
    for k in range(1, degree):
        P[k + 1] = ((2 * k + 1) * x * P[k] - k * P[k - 1]) / (k + 1)
    return np.asarray(P.T)


def _shifted_legendre(t: Array, degree: int) -> Array:
    return _legendre(2 * t - 1, degree)


def _legendre_integrals(t: Array, degree: int) -> Array:
    # The integral of P_k from 0 to t is (P_{k+1} - P_{k-1}) / (2 (2k + 1)) for k >= 1.
    values = _shifted_legendre(t, degree + 1)
    k = np.arange(1, degree + 1)
    result = np.empty((len(values), degree + 1))
    result[:, 0] = t
    result[:, 1:] = (values[:, 2:] - values[:, :-2]) / (2 * (2 * k + 1))
    return result
