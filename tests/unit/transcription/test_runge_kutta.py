"""Explicit Runge-Kutta coefficients against the order conditions of all rooted trees."""

from collections.abc import Iterator
from functools import cache
from itertools import combinations_with_replacement

import numpy as np
import pytest

from ribbonopt.transcription.shooting.runge_kutta import RungeKutta, rk4, rk8

#: a rooted tree is the sorted tuple of the subtrees on its root
Tree = tuple["Tree", ...]
#: number of rooted trees of each order
COUNTS = [1, 1, 2, 4, 9, 20, 48, 115]
METHODS = {"rk4": rk4(), "rk8": rk8()}
each_method = pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)


@cache
def trees(order: int) -> tuple[Tree, ...]:
    """Return all rooted trees with `order` vertices."""
    return tuple(sorted(set(forests(order - 1, order - 1))))


def forests(order: int, largest: int) -> Iterator[Tree]:
    """Yield the forests of `order` vertices whose trees have at most `largest`."""
    if order == 0:
        yield ()
    for size in range(1, min(order, largest) + 1):
        for count in range(1, order // size + 1):
            for chosen in combinations_with_replacement(trees(size), count):
                for rest in forests(order - size * count, size - 1):
                    yield tuple(sorted((*chosen, *rest)))


def size(tree: Tree) -> int:
    return 1 + sum(size(t) for t in tree)


def density(tree: Tree) -> int:
    return size(tree) * int(np.prod([density(t) for t in tree], dtype=int))


def weight(method: RungeKutta, tree: Tree) -> np.ndarray:
    """Return the elementary weights (K,) of the stages."""
    factors = [method.matrix @ weight(method, t) for t in tree]
    return np.prod([np.ones(method.degree), *factors], axis=0)


@pytest.mark.parametrize("order", range(1, 9))
def test_all_trees_are_there(order: int) -> None:
    assert len(trees(order)) == COUNTS[order - 1]
    assert all(size(tree) == order for tree in trees(order))


def gaps(method: RungeKutta, order: int) -> list[float]:
    """Return by how much each condition of an order is missed."""
    return [abs(method.weights @ weight(method, t) - 1 / density(t)) for t in trees(order)]


@each_method
def test_order_conditions_hold_to_rounding(method: RungeKutta) -> None:
    worst = max(max(gaps(method, order)) for order in range(1, method.order + 1))
    assert worst < 1e-14


@each_method
def test_the_order_is_not_higher_than_declared(method: RungeKutta) -> None:
    assert max(gaps(method, method.order + 1)) > 1e-6


@each_method
def test_methods_are_explicit(method: RungeKutta) -> None:
    np.testing.assert_array_equal(np.triu(method.matrix), 0)
    assert method.nodes[0] == 0
    np.testing.assert_allclose(method.nodes[-1], 1, atol=1e-14)


def test_names_and_stages() -> None:
    assert [(m.name, m.degree, m.order) for m in METHODS.values()] == [
        ("rk4", 4, 4),
        ("rk8", 12, 8),
    ]
