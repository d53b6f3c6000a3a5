"""Inertia and solutions of forms along a chain, against dense matrices; singular pivots too."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from dense_variation import dense_count, matrices, on_free

from ribbonopt.checks.chain_form import ChainForm
from ribbonopt.checks.elimination import SINGULAR, Elimination, factored


def form_of(seed: int, N: int, nx: int = 3, m: int = 4, conditions: int = 4) -> ChainForm:
    """Return a form whose elements are convex in their own variables for most seeds."""
    rng = np.random.default_rng(seed)
    Q = rng.normal(size=(N, nx + m, nx + m))
    Q = (Q + Q.swapaxes(1, 2)) / 2
    Q[:, nx:, nx:] += 3 * np.eye(m) * (seed % 3 > 0)
    A = np.eye(nx) + 0.3 * rng.normal(size=(N, nx, nx))
    ends = rng.normal(size=(2 * nx, 2 * nx))
    mass = np.ones(m)
    mass[-1] = seed % 2
    C = rng.normal(size=(conditions, 2 * nx))
    return ChainForm(Q, A, rng.normal(size=(N, nx, m)), ends + ends.T, C, mass)


@pytest.mark.parametrize("N", [1, 2, 3, 5, 8, 13])
@pytest.mark.parametrize("seed", range(6))
def test_the_inertia_is_that_of_the_dense_matrix(N: int, seed: int) -> None:
    form = form_of(seed, N)
    for shift in (0.0, 0.3, 2.0, 10.0, -1.0):
        counts = {Elimination(form.gauged(g), shift).negative for g in (0.0, 2.0, -5.0)}
        assert counts == {dense_count(form, shift)}


@pytest.mark.parametrize("N", [1, 2, 5, 8])
def test_it_solves_what_is_stationary_under_the_conditions(N: int) -> None:
    form, shift = form_of(7, N), 0.7
    nx, m = form.A.shape[1], form.B.shape[2]
    K, C, metric = matrices(form)
    f = np.random.default_rng(1).normal(size=len(K))
    whole = np.block([[K + shift * np.diag(metric), C.T], [C, np.zeros((len(C), len(C)))]])
    exact = np.linalg.solve(whole, np.concatenate([f, np.zeros(len(C))]))[: len(K)]
    x0, own = Elimination(form.gauged(0.5), shift).solve(f[:nx], f[nx:].reshape(N, m))
    np.testing.assert_allclose(np.concatenate([x0, own.ravel()]), exact, rtol=1e-8, atol=1e-10)


def test_products_are_those_of_the_dense_matrix() -> None:
    form = form_of(4, 6)
    K = matrices(form)[0]
    v = np.random.default_rng(2).normal(size=len(K))
    start, own = form.times(v[:3], v[3:].reshape(6, 4))
    np.testing.assert_allclose(np.concatenate([start, own.ravel()]), K @ v, atol=1e-9)


def oscillators(N: int, angle: float) -> ChainForm:
    """Return y^2 - x^2 with x' = y on N elements of that angle, x held at both ends.

    Held at one end and free at the other a stretch is critical at pi / 2, held at both at pi.
    """
    c, s = np.cos(angle), np.sin(angle)
    # The exact function of a stretch: P = -tan, A = 1 / cos, Y = tan, made of one own variable.
    Q = np.array([[-s / c, 0.0], [0.0, 1.0]])
    B = np.sqrt(s / c)
    ends = np.zeros((2, 2))
    one = np.ones((N, 1, 1))
    return ChainForm(one * Q, one / c, one * B, ends, np.eye(2), np.zeros(1))


@pytest.mark.parametrize("N", [4, 6, 8, 12, 16])
def test_where_a_part_is_critical_others_are_joined(N: int) -> None:
    """Two elements together have an angle of pi / 2, so that the first pivots are singular."""
    form = oscillators(N, np.pi / 4)
    assert Elimination(form, 0.0).least < SINGULAR
    for change in (0.0,) * (N % 4 > 0) + (1e-9, -1e-9):
        bent = replace(form, Q=form.Q - change * np.array([[1.0, 0.0], [0.0, 0.0]]))
        found = factored(bent, 0.0)
        assert found.least > SINGULAR
        # The whole is critical at every four elements: a little less, and it is not yet.
        assert found.negative == (N // 4 if N % 4 or change > 0 else N // 4 - 1)


def test_an_enclosure_of_eigenvalues_by_counts() -> None:
    form = replace(form_of(5, 7), mass=np.ones(4))
    values = np.linalg.eigvalsh(on_free(form)[0])
    for k, (a, b) in enumerate(pairwise(values)):
        assert factored(form, -(a + b) / 2).negative == k + 1
