"""Full grids are drawn as cells, each the number of its row."""

import numpy as np
import pytest
from matplotlib.collections import QuadMesh

from ribbonopt.views import Style, plot_batch
from ribbonopt.views.heat import edges_of, grid_of

INPUTS = ("a", "b")
A, B = (0.1, 0.2, 0.4, 0.5), (1.0, 10.0, 100.0)


def rows(*failed: int):
    """Return a grid, shuffled; energy is a + 1000 b."""
    found = []
    for i, (a, b) in enumerate([(a, b) for b in B for a in A]):
        good = {"verified": True, "status": "converged", "energy": a + 1000 * b, "u2": -a}
        bad = {"verified": False, "status": "crashed"}
        found.append({"number": i, "a": a, "b": b} | (bad if i in failed else good))
    return [found[i] for i in np.random.default_rng(1).permutation(len(found))]


def mesh_of(figure):
    return next((c for c in figure.axes[0].collections if isinstance(c, QuadMesh)), None)


@pytest.mark.parametrize("column", ["energy", "u2"])
def test_cells_are_the_numbers_of_rows_and_failed_ones_are_marked(column):
    figure = plot_batch(rows(2, 7), "a", "b", inputs=INPUTS, style=Style(color=column))
    mesh = mesh_of(figure)
    corners = mesh.get_coordinates()
    assert corners.shape == (4, 5, 2)
    # Older matplotlib keeps the cells in one row.
    values = np.ma.filled(mesh.get_array().astype(float), np.nan).reshape(3, 4)
    assert np.isnan(values).sum() == 2
    by_place = {(r["a"], r["b"]): r for r in rows(2, 7)}
    for (j, i), value in np.ndenumerate(values):
        # The row whose place lies in the cell is the one that it shows.
        (x0, y0), (x1, y1) = corners[j, i], corners[j + 1, i + 1]
        inside = [r for (a, b), r in by_place.items() if x0 < a < x1 and y0 < b < y1]
        assert len(inside) == 1
        if inside[0]["verified"]:
            assert value == inside[0][column]
        else:
            assert np.isnan(value)
    axes = figure.axes[0]
    crosses = axes.collections[-1].get_offsets()
    assert sorted(map(tuple, crosses)) == [(0.4, 1.0), (0.5, 10.0)]
    assert axes.get_title(loc="right") == "2 failed"
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")


def test_what_is_no_full_grid_is_no_heat_map():
    assert grid_of(rows()[1:], INPUTS, INPUTS) is None  # one is missing
    assert grid_of([*rows(), rows()[0]], INPUTS, INPUTS) is None  # one is there twice
    assert grid_of(rows(), ("a", "energy"), INPUTS) is None
    assert grid_of(rows(), ("a", "a"), INPUTS) is None
    assert grid_of([r for r in rows() if r["b"] == 1], INPUTS, INPUTS) is None
    assert grid_of([r | {"a": "x"} for r in rows()], INPUTS, INPUTS) is None
    assert grid_of([], INPUTS, INPUTS) is None
    figure = plot_batch(rows()[1:], "a", "b", inputs=INPUTS)
    assert mesh_of(figure) is None and len(figure.axes[0].collections[0].get_offsets()) == 11


def test_all_that_failed_are_marked():
    figure = plot_batch(rows(*range(12)), "a", "b", inputs=INPUTS)
    assert figure.axes[0].get_title(loc="right") == "12 failed"


def test_edges_are_halfway():
    np.testing.assert_allclose(edges_of(np.array([1.0, 2.0, 4.0])), [0.5, 1.5, 3, 5])
    np.testing.assert_allclose(
        edges_of(np.array([1.0, 10, 100])), 10 ** np.array([-0.5, 0.5, 1.5, 2.5])
    )


def test_labels_name_axes_and_colours():
    figure = plot_batch(rows(), "a", "b", inputs=INPUTS, labels={"a": "$\\alpha$", "energy": "$W$"})
    assert figure.axes[0].get_xlabel() == "$\\alpha$"
    assert figure.axes[1].get_ylabel() == "$W$"
    styled = Style(labels={"a": "other"})
    figure = plot_batch(rows(), "a", "b", inputs=INPUTS, labels={"a": "one"}, style=styled)
    assert figure.axes[0].get_xlabel() == "other"
