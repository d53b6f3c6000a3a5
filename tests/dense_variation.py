"""The second variation as one dense matrix: by states from sensitivities, conditions by a basis."""

import numpy as np

from ribbonopt.checks.chain_form import ChainForm
from ribbonopt.checks.stability import variation_of
from ribbonopt.solution.solution import Solution

Array = np.ndarray


def matrices(form: ChainForm) -> tuple[Array, Array, Array]:
    """Hessian (n, n), conditions (k, n) and metric (n,) of [x_0, all y]."""
    N, nx, m = form.B.shape
    n = nx + N * m
    X = np.zeros((N + 1, nx, n))
    X[0, :, :nx] = np.eye(nx)
    K = np.zeros((n, n))
    for e in range(N):
        own = np.zeros((m, n))
        own[:, nx + e * m : nx + (e + 1) * m] = np.eye(m)
        X[e + 1] = form.A[e] @ X[e] + form.B[e] @ own
        both = np.vstack([X[e], own])
        K += both.T @ form.Q[e] @ both
    ends = np.vstack([X[0], X[-1]])
    metric = np.concatenate([np.ones(nx), np.tile(form.mass, N)])
    return K + ends.T @ form.ends @ ends, form.C @ ends, metric


def on_free(form: ChainForm) -> tuple[Array, Array]:
    """Hessian and metric on an orthonormal basis of what keeps the conditions."""
    K, C, metric = matrices(form)
    basis = np.linalg.svd(C)[2][len(C) :].T
    return basis.T @ K @ basis, basis.T @ (metric[:, None] * basis)


def dense_count(form: ChainForm, shift: float) -> int:
    """Negative directions of the form plus a shift of its metric."""
    K, M = on_free(form)
    return int((np.linalg.eigvalsh(K + shift * M) < 0).sum())


def eigenvalues(solution: Solution) -> Array:
    """Eigenvalues of a solution whose variables all have a mass, increasing."""
    found = variation_of(solution)
    assert not isinstance(found, str), found
    assert found.form.mass.all()
    return np.linalg.eigvalsh(on_free(found.form)[0])
