"""Figures hold the numbers of the solution, and pictures are written."""

import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from matplotlib.text import Text

from ribbonopt.checks.flip import find_flip
from ribbonopt.errors import ModelError, OutputError
from ribbonopt.output.declared import PICTURES
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.named import Each
from ribbonopt.solution.solution import Solution
from ribbonopt.views import plot_plane, plot_ribbon, plot_strains, save_figures
from ribbonopt.views.camera import place_camera
from ribbonopt.views.generatrices import ETA_BOUND, LEAP_SLOPE
from ribbonopt.views.pieces import sample_pieces
from ribbonopt.views.subject import subject_of
from ribbonopt.views.surface import sweep

CONFIGS = Path(__file__).parents[3] / "configs"
SCENES = ("moebius_half", "moebius_kirchhoff", "moebius_regularized", "elastica_clamped", "helix")

HALF_RING = (
    "boundary.start={position: [0, 0, 0], directors: identity, force: {d1: 0}}",
    "boundary.end={position: {y: 0, z: 0}, directors: {d1: [-1, 0, 0], d3: [0, 0, -1]}}",
    "guess={force: [0, 0, 0], moment: [0, 6, 0]}",
)


@cache
def solved(name: str, *overrides: str) -> Solution:
    return solve(load_scene(CONFIGS / f"{name}.yaml", list(overrides)))


def text_of(figure):
    return "\n".join(t.get_text() for t in figure.findobj(Text))


def test_matplotlib_is_imported_when_a_figure_is_drawn_and_pyplot_never():
    code = f"""if True:
        import sys, ribbonopt.views
        from ribbonopt.scene import load_scene
        from ribbonopt import solve
        solution = solve(load_scene({str(CONFIGS / "helix.yaml")!r}))
        assert "matplotlib" not in sys.modules
        ribbonopt.views.plot_ribbon(solution)
        assert "matplotlib.figure" in sys.modules
        assert "matplotlib.pyplot" not in sys.modules
    """
    subprocess.run([sys.executable, "-c", code], check=True)


@pytest.mark.parametrize("name", SCENES)
def test_strain_lines_are_the_solution(name):
    solution = solved(name)
    top, bottom = plot_strains(solution, complete=False).axes
    for line, quantity in zip(top.lines, ("u2", "u3"), strict=False):
        s, values = line.get_data()
        known = np.isfinite(s)
        expected = solution.sample(s[known], quantity)
        np.testing.assert_allclose(values[known], expected, rtol=1e-9, atol=1e-9)
    s, eta = bottom.lines[0].get_data()
    known = np.isfinite(s) & (np.abs(eta) < 1e3)
    expected = solution.sample(s[known], "eta")
    np.testing.assert_allclose(eta[known], expected, rtol=1e-6, atol=1e-6)


def test_strain_lines_reach_the_ends_and_show_the_second_half_by_symmetry():
    top, _ = plot_strains(solved("moebius_half")).axes
    assert top.get_xlim() == (0, 1)
    u2, u2_mirrored = (line.get_ydata()[:-1] for line in top.lines[:2])
    np.testing.assert_array_equal(u2_mirrored, -u2[::-1])
    assert "by symmetry" in text_of(top)


def test_a_jump_of_bending_is_not_joined():
    solution = solved("moebius_regularized", "law={type: sadowsky}")
    before, after = sample_pieces(solution)
    assert before.s[-1] < 0.5 < after.s[0]
    assert after.s[0] - before.s[-1] < 1e-8
    assert before.u2[-1] - after.u2[0] > 9
    top, _ = plot_strains(solution).axes
    u2 = top.lines[0].get_ydata()
    assert np.isnan(u2[len(before.s)])
    assert np.nanmax(np.abs(np.diff(u2))) < 1


def test_plane_line_start_end_and_regions():
    solution = solved("moebius_half")
    axes = plot_plane(solution, complete=False).axes[0]
    (piece,) = sample_pieces(solution)
    paths = [line.get_xydata() for line in axes.lines]
    assert any(np.array_equal(p, np.column_stack([piece.u2, piece.u3])) for p in paths)
    marks = [p[0] for p in paths if len(p) == 1]
    np.testing.assert_allclose(marks, [solution.u0[1:], [4.93488, 4.93488]], rtol=1e-5)
    assert len(axes.patches) == 4
    for patch in axes.patches:
        x, y = patch.get_xy()[1:3].mean(axis=0)
        red, green, *_ = patch.get_facecolor()
        assert (green > red) == (abs(y) < abs(x))
    assert axes.get_aspect() == 1


@pytest.mark.parametrize("name", SCENES)
def test_the_surface_is_swept_by_the_generatrices(name):
    solution = solved(name)
    surface = sweep(subject_of(solution, complete=False).pieces)
    w = surface.half_width
    reach = ETA_BOUND * w / LEAP_SLOPE if surface.leaps else 0
    assert not surface.crossing
    for sheet in surface.sheets:
        s = sheet.piece.s
        rows = np.abs(s - 0.5) >= reach
        o = solution.outputs(s[rows])
        eta = np.clip(np.nan_to_num(o["eta"]), -ETA_BOUND, ETA_BOUND)[:, None]
        for side in (-1, 0, 1):
            expected = o["r"] + side * w * (o["d2"] + eta * o["d3"])
            np.testing.assert_allclose(sheet.points(side)[rows], expected, atol=1e-9)


def test_half_width_by_default_keeps_generatrices_apart():
    piece = sample_pieces(solved("helix"))[0]
    steep = replace(piece, eta=np.sin(40 * piece.s))
    surface = sweep((steep,))
    assert surface.half_width == pytest.approx(0.8 / 40, rel=1e-2)
    assert not surface.crossing
    assert sweep((steep,), half_width=0.05).crossing
    assert sweep((piece,)).half_width == pytest.approx(1 / 20)


@pytest.mark.parametrize("half_width", [0.0, -1.0, float("nan")])
def test_half_width_must_be_positive(half_width):
    with pytest.raises(ModelError, match="positive"):
        plot_ribbon(solved("helix"), half_width)


@pytest.mark.parametrize("name", ["moebius_half", "moebius_kirchhoff", "moebius_variational"])
def test_the_mirrored_half_joins_the_first_smoothly(name):
    subject = subject_of(solved(name), complete=True)
    assert subject.end == 1
    first, second = subject.solved[-1], subject.mirrored[0]
    for quantity in ("r", "d1", "d2", "d3", "u3"):
        a, b = getattr(first, quantity)[-1], getattr(second, quantity)[0]
        np.testing.assert_allclose(a, b, atol=1e-6)
    first, second = subject.solved[0], subject.mirrored[-1]
    for quantity, sign in {"r": 1, "d1": -1, "d2": -1, "d3": 1, "u3": 1, "u2": -1}.items():
        a, b = getattr(first, quantity)[0], getattr(second, quantity)[-1]
        np.testing.assert_allclose(a, sign * b, atol=1e-6)
    surface = sweep(subject.pieces)
    assert surface.one_sided
    for side in (-1, 1):
        edge, mirrored = (sheet.points(side) for sheet in surface.sheets)
        np.testing.assert_allclose(mirrored[0], edge[-1], atol=1e-6)
        turned_over = surface.sheets[0].points(-side)[0]
        np.testing.assert_allclose(mirrored[-1], turned_over, atol=1e-6)


def test_the_mirrored_half_agrees_with_the_whole_solved():
    subject = subject_of(solved("moebius_half"), complete=True)
    whole = solved("moebius_regularized", "law={type: sadowsky}")
    o = whole.outputs(subject.mirrored[0].s)
    for quantity in ("r", "d1", "d2", "d3", "u2", "u3"):
        np.testing.assert_allclose(getattr(subject.mirrored[0], quantity), o[quantity], atol=1e-6)


def test_half_a_ring_becomes_a_two_sided_ring():
    solution = solved("moebius_half", *HALF_RING)
    flip = find_flip(solution)
    assert flip is not None
    assert not flip.along_d2
    subject = subject_of(solution, complete=True)
    surface = sweep(subject.pieces)
    assert (surface.closed, surface.one_sided) == (True, False)
    radius = [np.hypot(p.r[:, 0] - 1 / (2 * np.pi), p.r[:, 2]) for p in subject.pieces]
    np.testing.assert_allclose(np.concatenate(radius), 1 / (2 * np.pi), rtol=1e-9)
    d1, d2, d3 = (getattr(subject.mirrored[0], k) for k in ("d1", "d2", "d3"))
    np.testing.assert_allclose(np.cross(d1, d2), d3, atol=1e-9)


@pytest.mark.parametrize("name", ["moebius_regularized", "elastica_clamped", "cantilever", "helix"])
def test_what_is_whole_has_no_second_half(name):
    assert find_flip(solved(name)) is None


def test_a_loaded_half_has_no_second_half():
    solution = solved("moebius_half")
    assert find_flip(solution) is not None

    class Pulled:
        scene = solution.scene

        def __init__(self, force):
            more = {"n": np.array([force, 0, 0])}
            self.at_nodes = Each(solution.at_nodes, lambda name, v: v + more.get(name, 0.0))

    assert find_flip(Pulled(0.0)) is not None
    assert find_flip(Pulled(1.0)) is None


@pytest.mark.parametrize("name", SCENES)
def test_the_camera_is_a_right_handed_frame_that_shows_the_face(name):
    piece = sample_pieces(solved(name))[0]
    camera = place_camera(piece.r, piece.d1)
    axes = np.stack([camera.right, camera.up, np.cross(camera.right, camera.up)])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(axes[2], camera.towards, atol=1e-12)
    assert np.abs(piece.d1 @ camera.towards).mean() > 0.2


def test_the_ribbon_says_what_it_shows():
    text = text_of(plot_ribbon(solved("moebius_half"), half_width=0.03))
    assert all(part in text for part in ("moebius-half", "half-width 0.03", "by symmetry"))
    assert "at most" not in text
    assert "by symmetry" not in text_of(plot_ribbon(solved("moebius_half"), complete=False))
    assert "at most 1" in text_of(plot_ribbon(solved("moebius_kirchhoff")))
    assert "generatrices cross" in text_of(plot_ribbon(solved("moebius_half"), half_width=0.5))


@pytest.mark.parametrize("name", SCENES)
def test_pictures_are_written(name, tmp_path):
    paths = save_figures(solved(name), tmp_path)
    assert {p.name for p in paths} == {name for name in PICTURES if name.endswith(".png")}
    for path in paths:
        pixels = imread(path)
        assert min(pixels.shape[:2]) > 300
        assert pixels[..., :3].var() > 1e-3


@pytest.mark.parametrize("complete", [True, False])
@pytest.mark.parametrize("plot", [plot_strains, plot_plane, plot_ribbon])
@pytest.mark.parametrize("name", ["moebius_half", "cantilever"])
def test_nothing_is_cut_off(name, plot, complete):
    figure = plot(solved(name), complete=complete)
    figure.canvas.draw()
    box = figure.get_tightbbox()
    assert (box.min >= 0).all() and (box.max <= figure.get_size_inches()).all()


def test_a_straight_ribbon_can_be_drawn(tmp_path):
    assert len(save_figures(solved("cantilever", "parameters.load=0"), tmp_path)) == 3


def test_a_folder_that_is_missing_is_refused(tmp_path):
    with pytest.raises(OutputError, match=r"strains\.png"):
        save_figures(solved("helix"), tmp_path / "missing")
