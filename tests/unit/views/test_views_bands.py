"""Bands are drawn whole, from whatever piece of them was solved."""

from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text

from ribbonopt.output.declared import PICTURES
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.views import plot_plane, plot_ribbon, plot_strains, save_figures
from ribbonopt.views.generatrices import ETA_BOUND
from ribbonopt.views.pieces import Piece
from ribbonopt.views.subject import Subject, subject_of
from ribbonopt.views.surface import sweep

CONFIGS = Path(__file__).parents[3] / "configs"
SHARE = {"whole": 1, "half": 2}
# Half twists, the piece that is solved, how many of them make the band.
BANDS = [
    (3, "fundamental", 6),
    (-3, "fundamental", 6),
    (2, "fundamental", 4),
    (5, "fundamental", 10),
    (3, "half", 2),
    (2, "half", 2),
    (3, "whole", 1),
    (1, "half", 2),
]
SEAM = 1e-6


@cache
def solved(half_twists: int, piece: str) -> Solution:
    share = SHARE.get(piece, 2 * abs(half_twists))
    overrides = [
        f"boundary.loop={{half_twists: {half_twists}, piece: {piece}}}",
        f"interval=[0, {1 / share!r}]",
        f"transcription.intervals={8 if piece == 'fundamental' else 24}",
    ]
    return solve(load_scene(CONFIGS / "band_three.yaml", overrides))


def whole(half_twists: int, piece: str) -> Subject:
    return subject_of(solved(half_twists, piece), complete=True)


def text_of(figure):
    return "\n".join(t.get_text() for t in figure.findobj(Text))


@pytest.mark.parametrize(("half_twists", "piece", "count"), BANDS)
def test_a_band_is_closed_and_has_no_seams(half_twists, piece, count):
    subject = whole(half_twists, piece)
    assert (subject.count, subject.end) == (count, pytest.approx(1))
    for a, b in pairwise(subject.pieces):
        for quantity in ("s", "r", "d1", "d2", "d3", "u3"):
            gap = getattr(b, quantity)[0] - getattr(a, quantity)[-1]
            assert np.abs(gap).max() < SEAM, quantity
    first, last = subject.pieces[0], subject.pieces[-1]
    turned_over = -1 if half_twists % 2 else 1
    for quantity, sign in {"r": 1, "d1": turned_over, "d2": turned_over, "d3": 1, "u3": 1}.items():
        gap = getattr(last, quantity)[-1] - sign * getattr(first, quantity)[0]
        assert np.abs(gap).max() < SEAM, quantity


@pytest.mark.parametrize(("half_twists", "piece", "count"), BANDS)
def test_the_surface_of_a_band_is_closed_and_has_no_seams(half_twists, piece, count):
    surface = sweep(whole(half_twists, piece).pieces)
    assert surface.closed
    assert surface.one_sided == bool(half_twists % 2)
    for side in (-1, 1):
        edges = [sheet.points(side) for sheet in surface.sheets]
        returned = surface.sheets[0].points(-side if half_twists % 2 else side)
        for a, b in pairwise([*edges, returned]):
            assert np.abs(b[0] - a[-1]).max() < SEAM


@pytest.mark.parametrize(("half_twists", "piece", "count"), BANDS)
def test_generatrices_stay_inside_the_strip(half_twists, piece, count):
    surface = sweep(whole(half_twists, piece).pieces)
    w = surface.half_width
    for sheet in surface.sheets:
        for side in (-1, 1):
            generatrix = sheet.points(side) - sheet.piece.r
            along = [np.sum(generatrix * d, axis=1) for d in (sheet.piece.d1, sheet.piece.d2)]
            np.testing.assert_allclose(
                along, np.broadcast_to([[0], [side * w]], (2, len(generatrix))), atol=1e-8
            )
            assert (
                np.abs(np.sum(generatrix * sheet.piece.d3, axis=1)) <= ETA_BOUND * w + 1e-9
            ).all()


@pytest.mark.parametrize(("half_twists", "piece", "count"), BANDS)
def test_what_follows_is_a_ribbon_of_the_same_strains(half_twists, piece, count):
    for rows in whole(half_twists, piece).pieces:
        np.testing.assert_allclose(np.cross(rows.d1, rows.d2), rows.d3, atol=1e-8)
        np.testing.assert_allclose(rows.eta * rows.u2, rows.u3, atol=1e-6)
        ds = np.diff(rows.s)[:, None]
        rates = {name: np.diff(getattr(rows, name), axis=0) / ds for name in ("r", "d1", "d3")}
        middle = {
            name: (v[1:] + v[:-1]) / 2 for name, v in vars(rows).items() if name != "mirrored"
        }
        even = ds[:, 0] > 1e-4
        np.testing.assert_allclose(rates["r"][even], middle["d3"][even], atol=1e-3)
        u2 = np.sum(rates["d3"] * middle["d1"], axis=1)
        u3 = np.sum(rates["d1"] * middle["d2"], axis=1)
        np.testing.assert_allclose(u2[even], middle["u2"][even], atol=0.3)
        np.testing.assert_allclose(u3[even], middle["u3"][even], atol=0.1)


def test_the_unfolded_piece_agrees_with_the_whole_solved():
    complete = whole(3, "fundamental")
    solution = solved(3, "whole")
    sign = np.sign(solution.u0[1] * complete.pieces[0].u2[0])
    for rows in complete.pieces:
        # Next to where u2 changes sign the regularised law is steep.
        calm = np.abs(rows.u2) > 3
        outputs = solution.outputs(np.minimum(rows.s[calm], 1))
        np.testing.assert_allclose(sign * outputs["u2"], rows.u2[calm], atol=1e-3)
        np.testing.assert_allclose(outputs["u3"], rows.u3[calm], atol=1e-3)


def test_a_band_may_begin_where_its_bending_changes_sign():
    first, second = whole(1, "half").pieces
    later = replace(first, s=first.s + 1, u2=-first.u2, eta=-first.eta, d1=-first.d1, d2=-first.d2)
    shifted, surface = sweep((second, later)), sweep((first, second))
    assert shifted.leaps and shifted.one_sided
    assert shifted.half_width == surface.half_width
    for side in (-1, 1):
        a, b = surface.sheets[0].points(side), shifted.sheets[1].points(-side)
        np.testing.assert_allclose(a, b, atol=1e-12)


@pytest.mark.parametrize(("gap", "closed"), [(0.0, True), (5e-5, True), (2e-4, False)])
def test_a_gap_that_can_be_seen_is_drawn(gap, closed):
    """A ring as wide as a page of 1600 points is 5000 of them long: the last gap is one of them."""
    angle = np.linspace(0, 2 * np.pi * (1 - gap), 400)
    sin, cos, zero = np.sin(angle), np.cos(angle), 0 * angle
    d1, d3 = np.stack([cos, sin, zero], axis=1), np.stack([-sin, cos, zero], axis=1)
    surface = sweep((Piece(angle, *4 * [zero], d1, -d1, np.cross(d3, -d1), d3),))
    assert (surface.closed, surface.one_sided) == (closed, False)


@pytest.mark.parametrize("plot", [plot_strains, plot_plane, plot_ribbon])
def test_figures_say_how_much_follows_by_symmetry(plot):
    figure = plot(solved(3, "fundamental"))
    assert "5 of 6 pieces by symmetry" in text_of(figure)
    assert "by symmetry" not in text_of(plot(solved(3, "fundamental"), complete=False))
    figure.canvas.draw()
    box = figure.get_tightbbox()
    assert (box.min >= 0).all() and (box.max <= figure.get_size_inches()).all()


@pytest.mark.slow
def test_other_equilibria_are_drawn_into_their_folders(tmp_path):
    solution = solved(3, "fundamental")
    paths = save_figures(replace(solution, others=(solution, solution)), tmp_path)
    names = {name for name in PICTURES if name.endswith(".png")}
    folders = [tmp_path, *(tmp_path / "equilibria" / i for i in "23")]
    assert set(paths) == {folder / name for folder in folders for name in names}
    assert all(path.is_file() for path in paths)
