"""Places of unknowns and equations, and meshes."""

import numpy as np
import pytest

from ribbonopt.errors import TranscriptionError
from ribbonopt.transcription import Layout, Mesh

LAYOUTS = [
    Layout(nx=3, nz=0, nc=2, ng=0, nh=0, stages=2, elements=(4,), conditions=5),
    Layout(nx=2, nz=3, nc=0, ng=2, nh=1, stages=1, elements=(1,), conditions=2),
    Layout(nx=2, nz=1, nc=3, ng=1, nh=2, stages=3, elements=(2, 1, 3), conditions=6),
]
each_layout = pytest.mark.parametrize("layout", LAYOUTS, ids=lambda lay: str(lay.elements))


@each_layout
def test_packing_loses_nothing(layout: Layout) -> None:
    w = np.arange(float(layout.unknowns))
    np.testing.assert_array_equal(layout.pack(*layout.unpack(w)), w)


@each_layout
def test_every_unknown_has_its_own_place(layout: Layout) -> None:
    nodes, stages, constants = layout.unpack(np.arange(float(layout.unknowns)))
    count = layout.element_count
    assert nodes.shape == (count + 1, layout.nx)
    assert stages.shape == (count, layout.stages, layout.nx + layout.nz)
    places = np.concatenate([nodes.ravel(), stages.ravel(), constants])
    assert sorted(places) == list(range(layout.unknowns))


@each_layout
def test_the_order_of_unknowns_is_as_documented(layout: Layout) -> None:
    nodes, stages, constants = layout.unpack(np.arange(float(layout.unknowns)))
    assert nodes[0, 0] == 0
    assert stages[0, 0, 0] == layout.nx
    assert nodes[1, 0] == layout.nx + layout.stages * (layout.nx + layout.nz)
    assert list(constants) == list(range(layout.constants_at, layout.unknowns))


@each_layout
def test_phases_share_the_elements_out(layout: Layout) -> None:
    slices = layout.phase_slices
    assert [s.stop - s.start for s in slices] == list(layout.elements)
    assert [s.start for s in slices] + [slices[-1].stop] == list(layout.point_elements)


@each_layout
def test_inequalities_are_the_last_rows_of_every_stage(layout: Layout) -> None:
    mask = layout.is_inequality()
    assert mask.sum() == layout.element_count * layout.stages * layout.nh
    assert not mask[layout.conditions_at :].any()
    if layout.nh:
        first = layout.nx + layout.ng
        assert list(np.flatnonzero(mask)[: layout.nh]) == list(range(first, first + layout.nh))


def test_square_counts() -> None:
    layout = LAYOUTS[0]
    assert layout.unknowns == layout.equations == 4 * (3 + 2 * 3) + 3 + 2


def test_uniform_mesh() -> None:
    mesh = Mesh.uniform(4, 2)
    assert mesh.elements == (4, 2)
    np.testing.assert_array_equal(mesh.widths, [0.25] * 4 + [0.5] * 2)


@pytest.mark.parametrize(
    ("widths", "message"),
    [
        ([0.5, 0.6], "add up to 1.1"),
        ([1.5, -0.5], "must be positive"),
        ([1.0, 0.0], "must be positive"),
        ([], "must be positive"),
        ([np.nan, 1.0], "must be positive"),
    ],
)
def test_meshes_that_do_not_fill_their_phase_are_refused(widths: list[float], message: str) -> None:
    with pytest.raises(TranscriptionError, match=message):
        Mesh((np.array(widths),))


@pytest.mark.parametrize("counts", [(0,), (3, 0), (-1,)])
def test_meshes_without_elements_are_refused(counts: tuple[int, ...]) -> None:
    with pytest.raises(TranscriptionError, match="expected >= 1"):
        Mesh.uniform(*counts)


@pytest.mark.parametrize("count", [1, 7, 10_000])
def test_nodes_of_many_elements_are_where_their_numbers_say(count: int) -> None:
    layout = Layout(nx=1, nz=0, nc=0, ng=0, nh=0, stages=1, elements=(count,), conditions=1)
    widths, exact = Mesh.uniform(count).widths, np.arange(count + 1) / count
    # Where there are no longer numbers than double ones, their sums are off by more.
    rounding = 1e-15 if np.finfo(np.longdouble).eps < np.finfo(float).eps else 1e-12
    assert np.abs(layout.phase_nodes(widths, 0) - exact).max() < rounding
    assert np.abs(layout.starts(widths) - exact[:-1]).max() < rounding
