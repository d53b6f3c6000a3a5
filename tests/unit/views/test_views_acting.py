"""Arrows and symbols are what acts and holds, beside the ribbon and below it."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.patches import Polygon
from matplotlib.quiver import Quiver

from ribbonopt import loads_scene, plot_ribbon, plot_strains, solve
from ribbonopt.mechanics.loads.load import Load
from ribbonopt.scene import Loads
from ribbonopt.solution.solution import Solution
from ribbonopt.views.acting import PLACES, Acting, Site, acting_of
from ribbonopt.views.camera import Camera, place_camera
from ribbonopt.views.marks import LONGEST, ROW, SYMBOL, marks_of
from ribbonopt.views.pieces import Piece, sample_pieces
from ribbonopt.views.subject import subject_of
from ribbonopt.views.surface import sweep

X, Y, Z = np.eye(3)
NONE = np.zeros(3)
FACE_ON = Camera(X, Y, Z)
HALF = 0.1  # half-width of the flat strip

POINTS = """
name: points
law: {type: kirchhoff, B2: 1, B3: 2}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free, force: [-1, 0, 0]}
loads: {points: [{at: 0.5, force: [-2, 0, 0]}, {at: 0.7, moment: {y: 1.5}}]}
"""


@dataclass(frozen=True)
class Wind(Load):
    """A pressure along d1."""

    p: float
    name = "wind"

    def numbers(self):
        return {"wind.p": self.p}

    def force(self, section, theta):
        return theta("wind.p") * section.d1

    def symmetries(self, motions):
        return np.eye(motions.shape[1])


def strip():
    """Return a flat strip along x, 2 long, face to the viewer, its edges at y = -HALF, HALF."""
    s, zero = np.linspace(0, 2, 201), np.zeros(201)
    d1, d2, d3 = (np.tile(v, (201, 1)) for v in (Z, Y, X))
    r = np.stack([s, zero, zero], axis=1)
    return sweep((Piece(s, zero, zero, zero, zero, r, d1, d2, d3),), HALF)


def marks(*sites: Site, **acting: object):
    return marks_of(Acting(sites, **acting), strip(), FACE_ON, 1.0)  # type: ignore[arg-type]


def quivers(figure) -> list[Quiver]:
    return [item for item in figure.axes[0].collections if isinstance(item, Quiver)]


def test_arrows_of_forces_are_to_one_scale_and_begin_beside_the_ribbon() -> None:
    down, up = Site("a", 0.5, -2 * Y, NONE, NONE), Site("b", 1.5, Y + 5 * Z, NONE, NONE)
    first, second = marks(down, up).arrows
    longest = np.sqrt(26)
    np.testing.assert_allclose(first, [[0.5, -HALF], [0, -2 * LONGEST / longest]], atol=1e-12)
    np.testing.assert_allclose(second, [[1.5, HALF], [0, LONGEST / longest]], atol=1e-12)


def test_a_force_that_presses_on_an_end_ends_there() -> None:
    push, pull = (Site("end", 2.0, f * X, NONE, NONE, outward=1) for f in (-1.0, 1.0))
    np.testing.assert_allclose(marks(push).arrows[0], [[2 + LONGEST, 0], [-LONGEST, 0]], atol=1e-12)
    np.testing.assert_allclose(marks(pull).arrows[0], [[2, 0], [LONGEST, 0]], atol=1e-12)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_moment_is_a_ring_around_the_ribbon_that_turns_as_it_does(sign: float) -> None:
    (ring,) = marks(Site("a", 1.0, NONE, 0.3 * sign * Z, NONE)).rings
    arms = ring - [1.0, 0.0]
    assert np.linalg.norm(arms, axis=1).min() > HALF
    turns = arms[:-1, 0] * arms[1:, 1] - arms[:-1, 1] * arms[1:, 0]
    assert (sign * turns > 0).all()


def test_forces_per_length_have_a_scale_of_their_own() -> None:
    s = np.array([0.5, 1.0, 1.5])
    force = -np.outer([1, 2, 3], Y)
    found = marks(Site("a", 1.0, 100 * Y, NONE, NONE), s=s, along=(force,))
    np.testing.assert_allclose(found.rows[:, 1, 1], [-ROW / 3, -2 * ROW / 3, -ROW], atol=1e-12)
    np.testing.assert_allclose(found.rows[:, 0], [[v, -HALF] for v in s], atol=1e-12)


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_support_stands_where_it_pushes_from(sign: float, whole: bool) -> None:
    (corners, _), *others = marks(Site("s", 1.0, NONE, NONE, sign * Y, "y", whole)).polygons
    assert not others
    beside = -sign * corners[:, 1]
    assert beside.min() == pytest.approx(HALF)
    assert beside.max() == pytest.approx(HALF + SYMBOL)
    assert len(corners) == (3 if whole else 25)


def test_a_clamp_is_a_plate_behind_its_end() -> None:
    start = Site("start", 0.0, NONE, NONE, NONE, "xyz", whole=True, clamped=True, outward=-1)
    found = marks(start)
    ((corners, _),) = found.polygons
    assert corners[:, 0].max() == pytest.approx(0)
    assert corners[:, 0].min() == pytest.approx(-SYMBOL)
    assert np.abs(corners[:, 1]).min() > HALF
    assert not found.lines
    slides = replace(start, held="yz", whole=False, guide=X)
    ((line, _),) = marks(slides).lines
    assert line[0, 1] == line[1, 1] == 0


def test_a_heavy_cantilever_is_drawn_with_its_weight_and_its_clamp(
    solved: Callable[..., Solution],
) -> None:
    figure = plot_ribbon(solved("heavy_cantilever"))
    (row,) = quivers(figure)
    assert len(row.U) == PLACES
    np.testing.assert_allclose(row.U, row.U[0], atol=1e-12)
    np.testing.assert_allclose(row.V, row.V[0])
    assert row.V[0] < 0
    (plate,) = figure.axes[0].patches
    surface = next(c for c in figure.axes[0].collections if isinstance(c, PolyCollection))
    assert isinstance(plate, Polygon)
    assert max(plate.get_zorder(), row.get_zorder()) < surface.get_zorder()
    assert "force per length 5" in " ".join(t.get_text() for t in figure.texts)


def test_forces_of_a_scene_are_those_of_its_file() -> None:
    found = acting_of(solve(loads_scene(POINTS)), ends=True)
    forces = {site.path: site.force for site in found.sites if np.any(site.force)}
    assert set(forces) == {"loads.points.0", "boundary.end"}
    np.testing.assert_allclose(forces["loads.points.0"], [-2, 0, 0])
    np.testing.assert_allclose(forces["boundary.end"], [-1, 0, 0])
    clamped = {site.path: (site.clamped, site.whole, site.held) for site in found.sites}
    assert clamped["boundary.start"] == (True, True, "xyz")
    assert clamped["boundary.end"] == (False, False, "")


def test_a_support_of_a_planar_strip_is_whole_in_its_plane(
    solved: Callable[..., Solution],
) -> None:
    sites = {site.path: site for site in acting_of(solved("three_supports"), ends=True).sites}
    # The plane is that of x and z.
    assert sites["boundary.start"].whole
    assert not sites["boundary.end"].whole and sites["boundary.end"].held == "xy"
    assert sites["supports.0"].reaction[0] == pytest.approx(12.910335551573)
    assert sites["boundary.end"].reaction[0] > 0


def test_bands_have_no_ends_to_mark(solved: Callable[..., Solution]) -> None:
    for name in ("moebius_half", "moebius_whole"):
        figure = plot_ribbon(solved(name))
        assert not figure.axes[0].patches and not quivers(figure)


def test_strains_break_where_a_moment_acts_and_places_are_named() -> None:
    found = solve(loads_scene(POINTS))
    cuts = [piece.s[-1] for piece in sample_pieces(found)][:-1]
    assert cuts == pytest.approx([0.5, 0.7], abs=1e-8)
    figure = plot_strains(found)
    top, bottom = figure.axes
    s, u2 = top.lines[0].get_data()
    gap = int(np.flatnonzero(np.isnan(s))[1])
    # Of B2 = 1: u2 is the moment about d2, which falls by that of the load.
    assert u2[gap - 1] - u2[gap + 1] == pytest.approx(1.5, abs=1e-6)
    assert np.nanmax(np.abs(np.diff(u2))) < 0.1
    names = {text.get_text(): text.xy[0] for text in top.texts}
    assert names == {"points.0": 0.5, "points.1": 0.7}
    for axes in (top, bottom):
        upright = [line.get_xdata()[0] for line in axes.lines if list(line.get_ydata()) == [0, 1]]
        assert {0.5, 0.7} <= set(upright)


def test_the_camera_shows_forces_upright(solved: Callable[..., Solution]) -> None:
    subject = subject_of(solved("three_supports"), complete=True)
    line, d1 = (np.concatenate([getattr(p, name) for p in subject.pieces]) for name in ("r", "d1"))
    camera = place_camera(line, d1, subject.acting.ways)
    assert abs(camera.up @ X) > 0.7 and abs(camera.right @ Z) > 0.95


def test_a_load_declared_in_python_is_drawn_along_the_ribbon() -> None:
    scene = loads_scene(POINTS)
    found = solve(replace(scene, loads=Loads(own=(Wind(3.0),))))
    acting = acting_of(found, ends=True)
    (force,) = acting.along
    np.testing.assert_allclose(force, 3 * found.sample(acting.s, "d1"), atol=1e-12)
    assert acting.densest == pytest.approx(3)
