"""The surface as faces: where they are, which way they face, how they are joined."""

from collections import defaultdict
from collections.abc import Callable

import numpy as np
import pytest

from ribbonopt.arrays import Array
from ribbonopt.exports.mesh import FINE, Mesh, mesh_of
from ribbonopt.exports.quantities import values_of
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution
from ribbonopt.views.shape import Shape, shape_of

Solved = Callable[..., Solution]

OPEN = ["helix", "tapered_strip", "three_supports", "ribbon_si", "moebius_kirchhoff"]
RINGS = ["curved_ring", "twisted_ring"]
ONE_SIDED = ["moebius_half"]
ALL = [*OPEN, *RINGS, *ONE_SIDED]
HALF_WIDTH = 0.02


def made(solved: Solved, name: str, across: int = 3) -> tuple[Shape, Mesh]:
    shape = shape_of(solved(name), complete=name not in OPEN)
    return shape, mesh_of(shape, across)


def facing(mesh: Mesh, triangles: Array) -> tuple[Array, Array]:
    """Return unit normals (t, 3) and areas (t,) of triangles."""
    a, b, c = (mesh.points[triangles[:, i]] for i in range(3))
    found = np.cross(b - a, c - a)
    size = np.linalg.norm(found, axis=1)
    return found / size[:, None], size / 2


def edges_of(quads: Array) -> dict[tuple[int, int], list[int]]:
    """Return directions, 1 or -1, in which faces pass each edge (i < j)."""
    passed = defaultdict(list)
    for face in quads.tolist():
        for i, j in zip(face, [*face[1:], face[0]], strict=True):
            passed[min(i, j), max(i, j)].append(1 if i < j else -1)
    return passed


def parts(edges: list[tuple[int, int]]) -> int:
    """Return of how many connected parts some edges are."""
    root: dict[int, int] = {}

    def find(i: int) -> int:
        while root.setdefault(i, i) != i:
            i = root[i]
        return i

    for i, j in edges:
        root[find(i)] = find(j)
    return len({find(i) for i in root})


def topology(quads: Array) -> tuple[int, int, bool]:
    """Return Euler's characteristic, closed curves of the boundary, and whether faces agree."""
    edges = edges_of(quads)
    boundary = [edge for edge, ways in edges.items() if len(ways) == 1]
    agree = all(sorted(ways) == [-1, 1] for ways in edges.values() if len(ways) > 1)
    assert max(map(len, edges.values())) == 2
    return len(np.unique(quads)) - len(edges) + len(quads), parts(boundary), agree


@pytest.mark.parametrize("name", OPEN)
def test_an_open_ribbon_is_a_disc(solved: Solved, name: str) -> None:
    _, mesh = made(solved, name)
    assert topology(mesh.quads) == (1, 1, True)


@pytest.mark.parametrize("name", RINGS)
def test_a_closed_band_is_joined_to_itself(solved: Solved, name: str) -> None:
    shape, mesh = made(solved, name)
    assert shape.closing == 1
    assert topology(mesh.quads) == (0, 2, True)


@pytest.mark.parametrize("name", ONE_SIDED)
def test_a_band_with_one_side_has_a_seam(solved: Solved, name: str) -> None:
    shape, mesh = made(solved, name)
    assert shape.closing == -1
    assert topology(mesh.quads) == (1, 1, True)
    # Both rows of the seam are in one place, from opposite edges; joined, it has one edge and one
    # side.
    first, last = mesh.points[:4], mesh.points[-4:]
    np.testing.assert_allclose(first, last[::-1], atol=1e-7)
    joined = mesh.quads.copy()
    for i in range(4):
        joined[joined == len(mesh.points) - 1 - i] = i
    assert topology(joined) == (0, 1, False)


@pytest.mark.parametrize("name", ALL)
def test_faces_and_normals_are_on_the_side_of_d1(solved: Solved, name: str) -> None:
    shape, mesh = made(solved, name)
    front = mesh.spread(shape.d1)
    normals, _ = facing(mesh, mesh.triangles)
    corners = np.einsum("ij,ikj->ik", normals, front[mesh.triangles])
    assert corners.min() > 0.5
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, rtol=1e-12)
    # What is told as normal is that of the faces around, as fine as rows are.
    told = np.einsum("ij,ikj->ik", normals, mesh.normals[mesh.triangles])
    assert np.median(told) > 0.9999
    assert told.min() > 0.8


def test_normals_of_a_developable_ribbon_are_d1_from_edge_to_edge(solved: Solved) -> None:
    shape, mesh = made(solved, "helix")
    np.testing.assert_allclose(mesh.normals, mesh.spread(shape.d1), atol=1e-12)


def test_normals_of_a_twisted_strip_are_those_of_a_helicoid() -> None:
    """Of (v cos k z, v sin k z, z) the normal is along (sin k z, -cos k z, k v)."""
    k, s = 5.0, np.linspace(0, 1, 41)
    zero, one = np.zeros(41), np.ones(41)
    d2 = np.stack([np.cos(k * s), np.sin(k * s), zero], axis=1)
    d1 = np.stack([np.sin(k * s), -np.cos(k * s), zero], axis=1)
    r, d3 = (np.stack([zero, zero, z], axis=1) for z in (s, one))
    shape = Shape(
        name="helicoid",
        units=Units(),
        **{"s": s, "r": r, "d1": d1, "d2": d2, "d3": d3, "b": d2},
        **{"half_widths": 0.3 * one, "u1": zero, "u2": zero, "u3": k * one, "eta": zero},
        **{"n": r, "m": r, "energy": zero, "mirrored": zero > 0},
        **{"starts": (0,), "closing": 0, "half_width": 0.3, "own": False, "rod": True},
    )
    mesh = mesh_of(shape, across=2)
    for j, v in enumerate((-0.3, 0.0, 0.3)):
        normal = np.stack([np.sin(k * s), -np.cos(k * s), k * v * one], axis=1)
        normal /= np.hypot(1, k * v)
        np.testing.assert_allclose(mesh.normals[j::3], normal[mesh.rows], atol=1e-12)


@pytest.mark.parametrize(
    ("name", "width"),
    [
        ("helix", lambda s: np.ones_like(s)),
        ("tapered_strip", lambda s: 1 - 0.7 * s),
        ("curved_ring", lambda s: np.ones_like(s)),
    ],
)
def test_the_area_is_that_of_the_flat_ribbon(
    solved: Solved, name: str, width: Callable[[Array], Array]
) -> None:
    """By r' = d3 and b' = eta' d3, dA = (1 + v eta') dv ds, which over |v| < w is 2 w ds."""
    shape = shape_of(solved(name), HALF_WIDTH)
    mesh = mesh_of(shape)
    s = np.linspace(shape.s[0], shape.s[-1], 2001)
    flat = float(np.sum((width(s)[1:] + width(s)[:-1]) / 2 * np.diff(s))) * 2 * HALF_WIDTH
    _, areas = facing(mesh, mesh.triangles)
    assert areas.sum() == pytest.approx(flat, rel=1e-4)
    assert areas.sum() != pytest.approx(flat * 1.01, rel=1e-4)


@pytest.mark.parametrize("name", ALL)
def test_rows_keep_apart_and_pieces_end_where_they_end(solved: Solved, name: str) -> None:
    shape, mesh = made(solved, name)
    gaps = np.diff(shape.s[mesh.rows]) / (shape.s[-1] - shape.s[0])
    assert gaps.min() >= FINE * (1 - 1e-9)
    for start in shape.starts:
        assert np.abs(shape.s[mesh.rows] - shape.s[start]).min() < 1e-8 * np.abs(shape.s).max()


def test_points_are_on_the_generatrices(solved: Solved) -> None:
    shape, mesh = made(solved, "helix", across=5)
    assert len(mesh.points) == 6 * len(mesh.rows)
    np.testing.assert_allclose(mesh.points[5::6], shape.points(1.0)[mesh.rows], atol=0)
    np.testing.assert_allclose(mesh.points[1::6], shape.points(-0.6)[mesh.rows], atol=1e-15)


@pytest.mark.parametrize("name", ["three_supports", "moebius_half"])
def test_components_are_those_along_the_directors(solved: Solved, name: str) -> None:
    solution = solved(name)
    shape = shape_of(solution, complete=False)
    told = solution.outputs(shape.s)
    for quantity in ("n1", "n3", "m2", "m3", "u3"):
        np.testing.assert_allclose(
            values_of(shape, quantity), told[quantity], atol=1e-9 * max(1, abs(told["n3"]).max())
        )
