"""The order of ribbons in a study: neighbours follow, however many there are."""

import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.studies.batch import chain as chains
from ribbonopt.studies.batch.chain import chain

SIZE = 25


def gaps(points: Array, order: list[int]) -> Array:
    """Distances from each point to the next, by the ranges of the coordinates."""
    spans = np.ptp(points, axis=0)
    steps = np.diff(points[order], axis=0) / np.where(spans > 0, spans, 1)
    return np.asarray(np.abs(steps).sum(axis=1))


def inside(points: Array, order: list[int]) -> float:
    """Length of the way without the steps between two chunks, which no ribbon takes."""
    steps = gaps(points, order)
    steps[SIZE - 1 :: SIZE] = 0
    return float(steps.sum())


def lattice(*counts: int) -> Array:
    axes = np.meshgrid(*(np.linspace(0, 1, count) for count in counts), indexing="ij")
    return np.stack(axes, axis=-1).reshape(-1, len(counts))


def drawn(count: int, dimensions: int) -> Array:
    return np.random.default_rng([count, dimensions]).normal(size=(count, dimensions))


CLOUDS = {
    "line": drawn(1500, 1),
    "plane": drawn(1500, 2),
    "space": drawn(1500, 3),
    "six": drawn(1500, 6),
    "square": lattice(38, 38),
    "rows": lattice(300, 5),
    "columns": lattice(5, 300),
    "cube": lattice(11, 12, 13),
    "one": np.ones((1200, 2)),
    "few": np.random.default_rng(0).integers(0, 3, size=(1200, 3)).astype(float),
    "powers": 10.0 ** -np.random.default_rng(0).uniform(0, 300, size=(1200, 2)),
}


@pytest.mark.parametrize("name", CLOUDS)
def test_cells_cost_little(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Walked in cells, the way inside the chunks is nearly as short as in one."""
    points = CLOUDS[name]
    whole = chain(points, SIZE)
    monkeypatch.setattr(chains, "MOST", 400)
    order = chain(points, SIZE)
    assert sorted(order) == list(range(len(points)))
    # Each cell may cost a step from one end to the other, which matters where the way is short.
    assert inside(points, order) <= 1.12 * inside(points, whole) + 4 * points.shape[1]
    shuffled = np.random.default_rng(5).permutation(len(points))
    again = chain(points[shuffled], SIZE)
    assert np.array_equal(points[shuffled][again], points[order])


@pytest.mark.parametrize("name", ["rows", "columns"])
def test_rows_of_a_grid_are_kept_whole(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setattr(chains, "MOST", 400)
    points = CLOUDS[name]
    steps = gaps(points, chain(points, SIZE))
    # From one row to the next four times; a row that is cut costs a step there and one back.
    assert np.count_nonzero(steps > 1.5 / 299) <= 4 + 2 * 3


def test_no_cell_is_larger_than_the_largest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chains, "MOST", 400)
    for count in (401, 799, 801, 1500, 3333):
        points = drawn(count, 2)
        cells = list(chains._cells(points, np.arange(count), SIZE))
        assert max(map(len, cells)) <= 400 + SIZE
        assert np.array_equal(np.sort(np.concatenate(cells)), np.arange(count))
        # A chunk never spans two cells.
        assert all(len(cell) % SIZE == 0 for cell in cells[:-1])


def test_each_of_a_cell_is_the_nearest_of_those_left() -> None:
    points = drawn(700, 3)
    order = chain(points, SIZE)
    steps, spans = gaps(points, order), np.ptp(points, axis=0)
    for i in range(len(order) - 1):
        left = points[order[i + 1 :]] - points[order[i]]
        assert steps[i] == pytest.approx(np.abs(left / spans).sum(axis=1).min(), abs=1e-12)
