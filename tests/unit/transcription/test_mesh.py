"""Meshes with other numbers of elements, graded alike."""

import numpy as np
import pytest

from ribbonopt.transcription import Mesh

NONE = np.empty(0)
GRADED = Mesh((np.geomspace(1, 30, 12) / np.geomspace(1, 30, 12).sum(),))


@pytest.mark.parametrize("mesh", [Mesh.uniform(12), GRADED], ids=["uniform", "graded"])
@pytest.mark.parametrize("count", [6, 12, 24, 31])
def test_a_mesh_is_resampled_to_the_elements_asked_for(mesh: Mesh, count: int) -> None:
    found = mesh.resampled(count, NONE)
    assert found.elements == (count,)
    if count == 12:
        np.testing.assert_allclose(found.widths, mesh.widths, rtol=1e-12)
    # As wide where they are as before, in proportion to the numbers.
    middles, before = (np.cumsum(m.widths) - m.widths / 2 for m in (found, mesh))
    expected = np.interp(middles, before, mesh.widths) * 12 / count
    inside = (middles > before[0]) & (middles < before[-1])
    np.testing.assert_allclose(found.widths[inside], expected[inside], rtol=0.15)


@pytest.mark.parametrize("switches", [[0.5], [0.1, 0.6], [0.02]])
def test_phases_share_the_elements_as_the_mesh_has_them(switches: list[float]) -> None:
    found = GRADED.resampled(40, np.array(switches), least=2)
    assert len(found.phases) == len(switches) + 1
    assert abs(sum(found.elements) - 40) <= len(switches) + 1
    nodes = np.append(0.0, np.cumsum(GRADED.widths))
    for count, a, b in zip(found.elements, [0, *switches], [*switches, 1], strict=True):
        share = np.interp([a, b], nodes, np.arange(13) * 40 / 12)
        assert count == max(2, round(float(np.ptp(share))))


def test_halved_elements_keep_all_nodes() -> None:
    mesh = Mesh((np.array([0.1, 0.6, 0.3]), np.array([1.0])))
    halved = mesh.halved()
    assert halved.elements == (6, 2)
    for whole, half in zip(mesh.phases, halved.phases, strict=True):
        np.testing.assert_allclose(np.cumsum(half)[1::2], np.cumsum(whole), rtol=1e-15)


def test_nodes_are_moved_to_places() -> None:
    moved = Mesh.uniform(10).through(np.array([0.33, 0.76]))
    nodes = np.append(0.0, np.cumsum(moved.widths))
    expected = [0, 0.1, 0.2, 0.33, 0.4, 0.5, 0.6, 0.7, 0.76, 0.9, 1]
    np.testing.assert_allclose(nodes, expected, atol=1e-15)


def test_elements_gather_only_where_they_are_told() -> None:
    mesh = Mesh.uniform(4, 4, 4)
    one, two, three = mesh.gathered(2, 0.1, [False, True]).phases
    assert one == pytest.approx(np.full(4, 0.25))
    assert two == pytest.approx([0.25, 0.25, 0.25, 0.225, 0.0225, 0.0025])
    assert three == pytest.approx(two[::-1])
