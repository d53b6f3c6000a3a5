"""Pictures of ribbons with natural strains: what is shaded, and where lines break."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.path import Path as Outline

from ribbonopt.scene import Natural
from ribbonopt.solution.solution import Solution
from ribbonopt.views.natural import shade_natural
from ribbonopt.views.plane import plot_plane
from ribbonopt.views.strains import plot_strains
from ribbonopt.views.style import ALLOWED, blank
from ribbonopt.views.subject import subject_of

Solved = Callable[..., Solution]


@pytest.mark.parametrize("across", [0.8, -1.3])
def test_shaded_is_what_a_sheet_allows(across: float) -> None:
    axes = blank(3, 3).add_subplot()
    shade_natural(axes, 4.0, across)
    *sheets, disc = (patch for patch in axes.patches if patch.get_facecolor() is not None)
    allowed = [p for p in sheets if p.get_facecolor() == to_rgba(ALLOWED)]
    outlines = [Outline(p.get_xy()) for p in allowed]
    u2, u3 = np.random.default_rng(1).uniform(-3, 3, (2, 4000))
    points = np.column_stack([u2, u3])
    shown = np.any([outline.contains_points(points) for outline in outlines], axis=0)
    shown &= ~Outline(disc.get_xy()).contains_points(points)  # type: ignore[attr-defined]
    fits = (u3**2 <= u2**2 + across * u2) & (u2**2 + u3**2 >= across * u2)
    assert (shown != fits).mean() < 0.01


def test_lines_break_where_a_fold_ends(solved: Solved) -> None:
    found = solved("tape_spring")
    subject = subject_of(found, complete=True)
    assert len(subject.pieces) == 3
    assert subject.across == pytest.approx(65)
    assert [float(np.abs(piece.u2).max() > 1) for piece in subject.pieces] == [0, 1, 0]
    labels = plot_plane(found).legends[0].get_texts()
    assert any("K_{22}" in label.get_text() for label in labels)


def test_nothing_is_shaded_where_the_limit_varies(solved: Solved) -> None:
    found = solved("curled_strip")
    assert found.scene.natural is not None
    natural = replace(found.scene.natural, across="s")
    scene = replace(found.scene, natural=natural)
    assert isinstance(natural, Natural)
    varied = replace(found, posed=replace(found.posed, given=scene))
    assert subject_of(varied, complete=True).across is None
    axes = plot_plane(varied).axes[0]
    assert not [patch for patch in axes.patches if patch.get_facecolor()[:3] != (1, 1, 1)]
    assert plot_strains(varied).axes[1].get_ylim()[1] >= 1
