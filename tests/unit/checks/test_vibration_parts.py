"""Parts of small vibrations: eigenvalues of chains, the closing of bands, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from dense_variation import matrices
from test_elimination import form_of

from ribbonopt.checks.chain_form import ChainForm
from ribbonopt.checks.vibrations.lowest import Pencil, Spectrum
from ribbonopt.checks.vibrations.whole_ends import Clamps, Closing
from ribbonopt.mechanics.rotations import product

Array = np.ndarray


def quaternion(p: Array, q: Array) -> Array:
    return np.array(product(p, q))


def spectrum(form: ChainForm, rows: Array, count: int) -> Spectrum:
    found = Pencil(form, rows, 0.0).lowest(count, 1e-2)
    assert isinstance(found, Spectrum), found
    return found


def dense(form: ChainForm, rows: Array) -> Array:
    """Eigenvalues omega^2 of the same by dense matrices, in order; of what has a mass."""
    N, nx, m = form.B.shape
    K, C, _ = matrices(form)
    n = nx + N * m
    x, M = np.zeros((nx, n)), np.zeros((n, n))
    x[:, :nx] = np.eye(nx)
    for e in range(N):
        own = np.zeros((m, n))
        own[:, nx + e * m : nx + (e + 1) * m] = np.eye(m)
        moved = rows[e] @ np.vstack([x, own])
        M += moved.T @ moved
        x = form.A[e] @ x + form.B[e] @ own
    basis = np.linalg.svd(C)[2][len(C) :].T
    K, M = basis.T @ K @ basis, basis.T @ M @ basis
    shift = 1e4
    mu = scipy.linalg.eigh(M, K + shift * M, eigvals_only=True)[::-1]
    return 1 / mu[mu > 1e-11 * mu[0]] - shift


@pytest.mark.parametrize("N, seed", [(1, 0), (2, 1), (5, 2), (8, 3)])
def test_the_lowest_eigenvalues_are_those_of_the_dense_matrices(N: int, seed: int) -> None:
    """Negative ones as well, and all of them where few move."""
    form = form_of(seed, N)
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(N, 3, form.Q.shape[1]))
    # Positive, but for a multiple of the mass: some eigenvalues are below zero.
    Q = form.Q @ form.Q - 3.0 * rows.swapaxes(1, 2) @ rows
    form = replace(form, Q=Q, ends=form.ends @ form.ends)
    expected = dense(form, rows)
    found = spectrum(form, rows, 4)
    assert found.complete
    count = min(4, len(expected))
    np.testing.assert_allclose(found.squared[:count], expected[:count], rtol=1e-6, atol=1e-6)
    # Modes are of kinetic energy one half, and orthogonal.
    moved = (rows @ found.modes).reshape(-1, found.modes.shape[2])
    np.testing.assert_allclose(moved.T @ moved, np.eye(moved.shape[1]), atol=1e-6)


def test_eigenvalues_that_are_many_times_there_are_all_found() -> None:
    """More often than a block is wide: elements that know nothing of each other, all the same."""
    N, nx, m = 6, 2, 4
    Q = np.zeros((N, nx + m, nx + m))
    Q[:, range(nx, nx + m), range(nx, nx + m)] = [1.0, 2.0, 3.0, 4.0]
    A, B = np.zeros((N, nx, nx)), np.zeros((N, nx, m))
    C = np.hstack([np.eye(nx), np.zeros((nx, nx))])
    form = ChainForm(Q, A, B, np.zeros((2 * nx, 2 * nx)), C, np.ones(m))
    rows = np.zeros((N, m, nx + m))
    rows[:, :, nx:] = np.eye(m)
    found = spectrum(form, rows, 8)
    assert found.complete
    np.testing.assert_allclose(found.squared, [1.0] * 6 + [2.0] * 2, rtol=1e-9)


@pytest.mark.parametrize("turned, planar", [(False, False), (True, False), (False, True)])
def test_the_closing_of_a_band_and_its_derivatives(turned: bool, planar: bool) -> None:
    """By differences of what is said of it in words."""
    rng = np.random.default_rng(4)
    nx = 4 if planar else 8  # one more, which is zero at the start
    ends = rng.normal(size=(2, nx))
    half = np.array([0.0, 0, 0, 1.0]) if turned else np.array([1.0, 0, 0, 0])
    conjugate = np.array([1.0, -1, -1, -1])

    def said(z: Array) -> Array:
        first, last = z.reshape(2, nx)
        if planar:
            return np.concatenate([last[:3] - first[:3], first[3:]])
        q = quaternion(quaternion(conjugate * first[3:7], last[3:7]), conjugate * half)
        length = first[3:7] @ first[3:7] - 1
        return np.concatenate([last[:3] - first[:3], q[1:], [length], first[7:]])

    closing, z = Closing(turned, planar), ends.ravel()
    _, flat = closing.conditions(ends, np.empty(0), np.empty(0))
    jacobian = flat.reshape(2 * nx, -1).T
    steps = 1e-4 * np.eye(2 * nx)
    differences = [(said(z + step) - said(z - step)) / 2e-4 for step in steps]
    np.testing.assert_allclose(jacobian, np.array(differences).T, atol=1e-7)
    weights = rng.normal(size=len(jacobian))
    (bent,) = closing.bent(ends, np.empty(0), np.empty(0), weights)
    rows = []
    for step in steps:
        slopes = [
            closing.conditions((z + sign * step).reshape(2, nx))[1].reshape(2 * nx, -1) @ weights
            for sign in (1, -1)
        ]
        rows.append((slopes[0] - slopes[1]) / 2e-4)
    np.testing.assert_allclose(bent.reshape(2 * nx, 2 * nx), rows, atol=1e-7)


@pytest.mark.parametrize("planar", [False, True])
def test_clamps_leave_nothing_of_their_ends(planar: bool) -> None:
    """What the conditions leave of the states of both ends: the length of q at the end alone."""
    nx = 3 if planar else 7
    ends = np.random.default_rng(1).normal(size=(2, nx))
    _, flat = Clamps(planar).conditions(ends)
    jacobian = flat.reshape(2 * nx, -1).T
    rank = np.linalg.matrix_rank(jacobian)
    assert rank == len(jacobian) == (6 if planar else 13)
    if not planar:
        left = np.linalg.svd(jacobian)[2][-1]
        np.testing.assert_allclose(np.abs(left[10:] @ ends[1, 3:]), np.linalg.norm(ends[1, 3:]))
        (bent,) = Clamps(planar).bent(ends, np.empty(0), np.empty(0), np.arange(13.0))
        assert bent.sum() == 4 * 2 * 6
