"""Chains of relations, reduced level by level, against the whole matrix solved dense."""

import numpy as np
import pytest

from ribbonopt.solvers.chain import GROWTH, Chain, schedule

Array = np.ndarray
NX, NC = 4, 3
PHASES = [(1,), (2,), (17,), (64,), (30, 1, 23), (1, 40, 2, 9)]


def relations(phases: tuple[int, ...], size: float) -> tuple[Array, Array, Array]:
    """Random A of entries up to about `size`, identities, random C."""
    random, count = np.random.default_rng(sum(phases)), sum(phases)
    A = -size * (np.eye(NX) + 0.3 * random.normal(size=(count, NX, NX)))
    if size > GROWTH:  # grows one way, decays the other: only turning is stable
        decay = np.diag([1.0, 1.0, 1e-3, 1e-3])
        turn, _ = np.linalg.qr(random.normal(size=(NX, NX)))
        A = A @ (turn @ decay @ turn.T)
    return A, np.broadcast_to(np.eye(NX), A.shape), random.normal(size=(count, NX, NC))


def whole(A: Array, B: Array, C: Array) -> Array:
    """Matrix of all relations, columns: all nodes, constants."""
    count = len(A)
    rows = np.zeros((count, NX, (count + 1) * NX + NC))
    for e in range(count):
        rows[e, :, e * NX : (e + 1) * NX] = A[e]
        rows[e, :, (e + 1) * NX : (e + 2) * NX] = B[e]
    rows[:, :, -NC:] = C
    return rows.reshape(count * NX, -1)


def conditions(phases: tuple[int, ...]) -> Array:
    """Random conditions of the first and the last node and the constants."""
    random = np.random.default_rng(1)
    found = np.zeros((NX + NC, (sum(phases) + 1) * NX + NC))
    found[:, :NX] = random.normal(size=(NX + NC, NX))
    found[:, -NX - NC :] = random.normal(size=(NX + NC, NX + NC))
    return found


def determinant(matrix: Array) -> tuple[float, float]:
    """Sign and logarithm, the first node's columns behind those of all others."""
    order = [*range(NX, matrix.shape[1] - NC), *range(NX), *range(-NC, 0)]
    sign, log = np.linalg.slogdet(matrix[:, order])
    return float(sign), float(log)


@pytest.mark.parametrize("size", [0.5, 1.0, 2 * GROWTH])
@pytest.mark.parametrize("phases", PHASES, ids=str)
def test_nodes_are_those_of_the_whole_matrix(phases: tuple[int, ...], size: float) -> None:
    A, B, C = relations(phases, size)
    chain, ends = Chain(A, B, C, phases), conditions(phases)
    d = np.random.default_rng(2).normal(size=(len(A), NX))
    truth = np.linalg.solve(np.vstack([whole(A, B, C), ends]), np.append(d.ravel(), np.ones(7)))
    reduced = chain.reduce(d)
    left = chain.schedule
    columns = [*(left.nodes[:, None] * NX + np.arange(NX)).ravel(), *range(-NC, 0)]
    small = np.vstack([whole(*chain.relations), ends[:, columns]])
    found = np.linalg.solve(small, np.append(reduced[left.elements].ravel(), np.ones(7)))
    nodes, c = found[:-NC].reshape(-1, NX), found[-NC:]
    got = np.append(chain.expand(nodes, c, reduced).ravel(), c)
    assert np.abs(got - truth).max() < 1e-11 * np.abs(truth).max()
    if left.levels:
        assert (chain.levels[0].turned is None) == (size < GROWTH)


@pytest.mark.parametrize("size", [0.5, 2 * GROWTH])
@pytest.mark.parametrize("phases", PHASES, ids=str)
def test_determinants_are_those_of_the_whole_matrix(phases: tuple[int, ...], size: float) -> None:
    A, B, C = relations(phases, size)
    chain, ends = Chain(A, B, C, phases), conditions(phases)
    left = chain.schedule
    columns = [*(left.nodes[:, None] * NX + np.arange(NX)).ravel(), *range(-NC, 0)]
    truth = determinant(np.vstack([whole(A, B, C), ends]))
    sign, log = determinant(np.vstack([whole(*chain.relations), ends[:, columns]]))
    for level in chain.levels:
        sign, log = sign * level.determinant[0], log + level.determinant[1]
    assert sign == truth[0]
    assert log == pytest.approx(truth[1], abs=1e-8)


@pytest.mark.parametrize("phases", PHASES, ids=str)
def test_nodes_where_phases_meet_remain(phases: tuple[int, ...]) -> None:
    found = schedule(phases, NX)
    assert set(np.cumsum([0, *phases]).tolist()) <= set(found.nodes.tolist())
    gone = np.concatenate([np.zeros(0, int), *(pairs.first + 1 for pairs in found.levels)])
    assert sorted([*gone.tolist(), *found.nodes.tolist()]) == list(range(sum(phases) + 1))
