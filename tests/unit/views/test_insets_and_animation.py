"""Ribbons inside the diagram of a branch, and moving pictures along one."""

import shutil
import subprocess
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.image import imread
from matplotlib.text import Annotation
from PIL import Image
from test_views_branch import row

from ribbonopt import load_scene, solve
from ribbonopt.errors import ModelError, OutputError, ViewError
from ribbonopt.plain import Rows
from ribbonopt.solution.solution import Solution
from ribbonopt.views import Style, save_animation
from ribbonopt.views.animation import MOST, frames_of
from ribbonopt.views.branch import draw_branch
from ribbonopt.views.branch_rows import BranchFigure
from ribbonopt.views.insets import corners_of

CONFIGS = Path(__file__).parents[3] / "configs"
SMALL = Style(width=1.5, dpi=60)


@cache
def arches() -> list[Solution]:
    path = CONFIGS / "snap.yaml"
    return [solve(load_scene(path, [f"parameters.angle={a}"])) for a in (0, 8, 16)]


def rows() -> Rows:
    return [row(i, 4.0 * i, energy=float(i * i)) for i in range(9)]


def test_insets_of_points_that_are_close_do_not_lie_on_one_another() -> None:
    marks = np.array([[0.5, 0.51, 0.5, 0.52], [0.5, 0.5, 0.51, 0.5]])
    size = np.array([0.2, 0.15])
    corners = corners_of(marks, size, marks)
    for k in range(4):
        apart = np.abs(np.delete(corners, k, axis=1) - corners[:, [k]]) >= size[:, None]
        assert apart.any(axis=0).all()


def test_insets_stand_beside_curves_and_apart() -> None:
    x = np.linspace(0.08, 0.92, 200)
    curve = np.array([x, 0.5 + 0.3 * np.sin(6 * x)])
    marks = curve[:, [5, 60, 120, 190]]
    size = np.array([0.2, 0.15])
    corners = corners_of(marks, size, curve)
    for k, corner in enumerate(corners.T):
        assert (corner >= 0).all() and (corner + size <= 1).all()
        inside = (curve.T > corner).all(axis=1) & (curve.T < corner + size).all(axis=1)
        assert not inside.any()
        near = np.clip(marks[:, k], corner, corner + size)
        assert np.hypot(*(near - marks[:, k])) < 0.25
        for other in corners.T[:k]:
            assert (np.abs(other - corner) >= size).any()


@pytest.mark.parametrize("style", [Style(), Style(width=3.35, titles=False, color="u2")])
def test_each_inset_is_joined_to_its_point(style: Style) -> None:
    subject = BranchFigure(rows(), (("value", "energy"),), "snap")
    ribbons = dict(zip((0, 3, 8), arches(), strict=True))
    with style.applied():
        figure = draw_branch(subject, [1, 2], style, ribbons)
    axes = figure.axes[0]
    insets = [child for child in axes.child_axes if isinstance(child, Axes)]
    assert [i.texts[0].get_text().strip() for i in insets] == ["0", "3", "8"]
    assert len({inset.get_xlim() for inset in insets}) == 1  # one scale
    leads = [text for text in axes.texts if isinstance(text, Annotation)]
    to_data = axes.transAxes + axes.transData.inverted()
    begins = [to_data.transform(lead.xy) for lead in leads]
    for lead, inset in zip(leads, insets, strict=True):  # which ends on the ribbon
        drawn = np.concatenate([p.vertices for p in inset.collections[0].get_paths()])
        assert np.abs(drawn - lead.xyann).sum(axis=1).min() < 1e-12
        assert lead.anncoords is inset.transData
    np.testing.assert_allclose(begins, [(0, 0), (12, 9), (32, 64)], atol=1e-9)
    assert not any("numbers" in t.get_text() for t in figure.legends[0].get_texts())


def test_points_beyond_the_first_panel_have_no_inset() -> None:
    subject = BranchFigure([*rows(), row(9, 40.0)], (("value", "energy"),), "snap")
    with pytest.raises(ViewError, match="point 9 is not in the first panel"):
        draw_branch(subject, [], Style(), {9: arches()[0]})


def test_frames_are_few_and_special_points_among_them() -> None:
    assert frames_of(rows()) == list(range(9))
    many = [row(i, i, kind="fold" if i in (501, 777) else "point") for i in range(1000)]
    frames = frames_of(many)
    assert len(frames) <= MOST and {0, 501, 777, 999} <= set(frames)
    assert np.diff(frames).max() <= 2 * 1000 / MOST


def test_a_gif_has_a_frame_for_each_ribbon(tmp_path: Path) -> None:
    captions = ["angle = 0", "angle = 8", "angle = 16, a longer one"]
    path = save_animation(arches(), captions, tmp_path / "a.gif", SMALL, "snap")
    with Image.open(path) as image:
        assert image.n_frames == 3 and image.size[0] == 90
        frames = []
        for i in range(3):
            image.seek(i)
            frames.append(np.asarray(image.convert("RGB"), float))
    assert all(np.abs(a - b).max() > 50 for a, b in pairwise(frames))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.gif"]


def test_the_view_is_the_same_in_all_frames(tmp_path: Path) -> None:
    same = [arches()[0]] * 2
    path = save_animation(same, ["one", "two"], tmp_path / "a.gif", SMALL)
    with Image.open(path) as image:
        top = (0, 0, image.size[0], image.size[1] // 3)
        parts = [np.asarray(image.crop(top).convert("RGB"), float)]
        image.seek(1)
        parts.append(np.asarray(image.crop(top).convert("RGB"), float))
    assert np.abs(parts[0] - parts[1]).max() < 16  # but for palettes


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not on this machine")
def test_an_mp4_is_written_where_there_is_ffmpeg(tmp_path: Path) -> None:
    path = save_animation(arches(), ["a", "b", "c"], tmp_path / "a.mp4", SMALL)
    subprocess.run(
        ["ffmpeg", "-loglevel", "error", "-i", path, tmp_path / "frame%d.png"], check=True
    )
    frames = [imread(tmp_path / f"frame{i}.png") for i in (1, 2, 3)]
    assert np.abs(frames[0] - frames[1]).max() > 0.3


def test_what_cannot_be_moved_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ViewError, match="no ribbons"):
        save_animation([], [], tmp_path / "a.gif")
    with pytest.raises(ModelError, match="camera"):
        save_animation(arches(), ["", "", ""], tmp_path / "a.gif", Style(camera="up"))
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(OutputError, match="needs ffmpeg, which is not found"):
        save_animation(arches()[:1], ["one"], tmp_path / "a.mp4", SMALL)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(OutputError, match="cannot be written"):
        save_animation(arches()[:1], ["one"], tmp_path / "none" / "a.gif", SMALL)
