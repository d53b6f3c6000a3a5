"""A ribbon is drawn as wide as it is, everywhere."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ribbonopt.solution.solution import Solution
from ribbonopt.views.camera import Camera
from ribbonopt.views.facets import draw_surface
from ribbonopt.views.generatrices import WIDTH_SHARE
from ribbonopt.views.pieces import Piece
from ribbonopt.views.ribbon import draw_ribbon
from ribbonopt.views.subject import subject_of
from ribbonopt.views.surface import sweep

AXES = np.eye(3)


def strip(width: object) -> Piece:
    """Return rows of a flat strip along x, 2 long, whose generatrices lie across it."""
    s, zero = np.linspace(0, 2, 21), np.zeros(21)
    d1, d3 = np.tile(AXES[2], (21, 1)), np.tile(AXES[0], (21, 1))
    r = np.stack([s, zero, zero], axis=1)
    piece = Piece(s, zero, zero, zero, zero, r, d1, np.cross(d3, d1), d3)
    return replace(piece, width=width)  # type: ignore[arg-type]


@pytest.mark.parametrize("half_width", [None, 0.3])
def test_edges_are_half_the_width_from_the_centre_line(half_width: float | None) -> None:
    along = 4 - 1.5 * np.linspace(0, 2, 21)
    surface = sweep((strip(along),), half_width)
    # By default it is widest as any ribbon is wide.
    unit = half_width or 2 * WIDTH_SHARE / 4
    assert surface.half_width == pytest.approx(unit) and surface.tapers
    (sheet,) = surface.sheets
    for fraction in (1.0, -0.5):
        across = np.sum(sheet.points(fraction) * sheet.piece.d2, axis=1)
        np.testing.assert_allclose(across, fraction * unit * along, rtol=1e-12)
    corners = draw_surface(surface, Camera(AXES[0], AXES[1], AXES[2])).corners
    assert np.abs(corners[..., 1]).max() == pytest.approx(4 * unit)


def test_a_uniform_width_is_drawn_as_none() -> None:
    surface, plain = sweep((strip(2.0),)), sweep((strip(1.0),))
    assert not surface.tapers and surface.widest == pytest.approx(plain.widest)


def test_the_figure_of_a_tapered_strip_says_so(solved: Callable[..., Solution]) -> None:
    found = solved("tapered_strip")
    (piece,) = subject_of(found, complete=True).solved
    np.testing.assert_allclose(piece.widths, 1 - 0.7 * piece.s, rtol=1e-12)
    figure = draw_ribbon(subject_of(found, complete=True))
    assert "half-width 0.05 w(s) along" in " ".join(text.get_text() for text in figure.texts)


def test_a_straight_strip_is_drawn_as_a_rectangle(solved: Callable[..., Solution]) -> None:
    """Its strains are rounding, and so would be the slope of its generatrices."""
    found = solved("lateral_buckling")
    assert 0 < np.abs(found.at_stages["u"]).max() < 1e-12
    (piece,) = subject_of(found, complete=True).solved
    assert (piece.eta == 0).all()
