"""What bends in its own plane is no ribbon: its strains are drawn, and a thin strip along d2."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.text import Text
from user_modules import importer

from ribbonopt import save_figures, save_solution, solve
from ribbonopt.errors import ViewError
from ribbonopt.scene import Boundary, Collocation, End, Kirchhoff, Loop, RotationVector, Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.views import Pictures, plot_plane, plot_ribbon, plot_strains
from ribbonopt.views.branch import save_branch_figures
from ribbonopt.views.branch_rows import BranchFigure
from ribbonopt.views.files import draw_figures
from ribbonopt.views.pieces import in_plane, sample_pieces
from ribbonopt.views.strip import plot_strip
from ribbonopt.views.subject import subject_of
from ribbonopt.views.surface import sweep

BOUNDARY = Boundary(
    End("clamped", (0.0, 0.0, 0.0), "identity"),
    End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6))),
)
ROW = {
    "number": 0,
    "stage": 0,
    "branch": 0,
    "parameter": "a",
    "a": 1.0,
    "kind": "point",
    "negative": 0,
}


@pytest.fixture(scope="module")
def rod(tmp_path_factory: pytest.TempPathFactory) -> Solution:
    with pytest.MonkeyPatch.context() as patch:
        module = importer(tmp_path_factory.mktemp("user"), patch)("rod")
        law = module.Rod(k1=0.4, k2=1.0, k3=-0.5)
        return solve(Scene("rod", law, BOUNDARY, transcription=Collocation(intervals=8)))


def test_all_three_strains_are_drawn(rod: Solution) -> None:
    figure = plot_strains(rod)
    (axes,) = figure.axes
    for line, name in zip(axes.lines, ("u1", "u2", "u3"), strict=False):
        s, drawn = (np.asarray(v)[:-1] for v in line.get_data())  # but for the break at the end
        np.testing.assert_allclose(drawn, rod.outputs(s)[name])
        assert str(line.get_label()).startswith(f"$u_{name[1]}$")
    figure.canvas.draw()
    box = figure.get_tightbbox()
    assert (box.min >= 0).all() and (box.max <= figure.get_size_inches()).all()
    assert not any("eta" in text.get_text() for text in figure.findobj(Text))


def test_how_far_it_bends_in_its_plane(rod: Solution) -> None:
    strains = rod.outputs(np.linspace(0, 1, 301))["u"]
    largest = np.abs(strains).max(axis=0)
    assert in_plane(sample_pieces(rod)) == pytest.approx(largest[0] / largest.max(), rel=1e-3)


def test_what_needs_generatrices_says_why_not(rod: Solution) -> None:
    reason = r"rod may bend in its own plane \(u1 is up to 0\.17 of the largest strain\): it is no"
    with pytest.raises(ViewError, match=reason):
        plot_plane(rod)


def test_it_is_drawn_as_a_thin_strip_straight_across(rod: Solution) -> None:
    subject = subject_of(rod, complete=True)
    assert subject.rod and subject.drawn == pytest.approx(1 / 80, rel=1e-6)
    (piece,) = subject.pieces
    assert not piece.eta.any() and piece.u3.any()
    (sheet,) = sweep(subject.pieces, subject.drawn).sheets
    np.testing.assert_allclose(sheet.points(1.0) - sheet.points(0.0), piece.d2 / 80, atol=1e-9)
    for figure in (plot_ribbon(rod), plot_strip([rod], ["rod"])):
        assert not any("eta" in text.get_text() for text in figure.findobj(Text))


def test_a_ribbon_is_no_rod() -> None:
    law = Kirchhoff(B2=1, B3=0.8)
    subject = subject_of(solve(Scene("ribbon", law, BOUNDARY)), complete=True)
    assert not subject.rod and subject.drawn is None


def test_pictures_that_there_are_none_of_are_left_out(rod: Solution, tmp_path: Path) -> None:
    (tmp_path / "plane.png").write_text("of an older result", encoding="utf-8")
    assert {path.name for path in save_figures(rod, tmp_path)} == {"strains.png", "ribbon.png"}
    assert {path.name for path in tmp_path.iterdir()} == {"strains.png", "ribbon.png"}
    both = draw_figures(replace(rod, others=(rod,)), tmp_path)
    assert [text.split(":")[0] for text in both.left_out] == [
        "plane.png",
        "equilibria/2/plane.png",
    ]
    left_out = save_solution(rod, tmp_path / "equilibria", [Pictures()])
    assert "a strip along d2 can be drawn" in left_out[-1]


def test_a_branch_of_rods_is_drawn(rod: Solution, tmp_path: Path) -> None:
    rows = [ROW | {"energy": 1.0}, ROW | {"number": 1, "a": 2.0, "energy": 3.0}]
    figure = BranchFigure(rows, (("a", "energy"),))
    drawn = save_branch_figures(figure, {0: rod}, tmp_path)
    assert {path.name for path in drawn.paths} == {"branch.png", "ribbons.png"}
    assert not drawn.left_out


@pytest.mark.parametrize(("half_twists", "piece"), [(1, "half"), (2, "half"), (3, "fundamental")])
def test_strains_by_symmetry_are_those_of_their_directors(
    half_twists: int,
    piece: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    law = importer(tmp_path, monkeypatch)("rod").Rod()
    start = End(position=(0.0, 0.0, 0.0), directors="identity")
    loop = Boundary(End() if piece == "fundamental" else start, loop=Loop(half_twists, piece))  # type: ignore[arg-type]
    interval = (0.0, 1 / loop.loop.pieces) if loop.loop else (0.0, 1.0)
    band = subject_of(solve(Scene("band", law, loop, interval=interval)), complete=True)
    assert band.mirrored and band.rod
    for part in band.pieces:
        rows = slice(20, -20)  # evenly spaced
        s, d = part.s[rows], [part.d1[rows], part.d2[rows], part.d3[rows]]
        for i, u in enumerate((part.u1, part.u2, part.u3)):
            change = np.gradient(d[(i + 1) % 3], s, axis=0)
            found = np.einsum("ki,ki->k", change, d[(i + 2) % 3])
            np.testing.assert_allclose(
                found[1:-1], u[rows][1:-1], atol=0.02 * np.abs(u).max() + 0.02
            )


def test_nothing_of_a_whole_band_is_cut_off(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    law = importer(tmp_path, monkeypatch)("rod").Rod()
    start = End(position=(0.0, 0.0, 0.0), directors="identity")
    scene = Scene("band", law, Boundary(start, loop=Loop(1, "half")), interval=(0.0, 0.5))
    figure = plot_strains(solve(scene))
    figure.canvas.draw()
    box = figure.get_tightbbox()
    assert (box.min >= 0).all() and (box.max <= figure.get_size_inches()).all()
    assert figure.axes[0].get_position().x1 > 0.9
