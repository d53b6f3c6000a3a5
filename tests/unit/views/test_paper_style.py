"""Figures for papers: sizes in inches and points, text that stays text, settings that go again."""

import re
import zlib
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib import rc_context, rcParams
from matplotlib.image import imread
from matplotlib.text import Text

from ribbonopt import load_scene, solve
from ribbonopt.errors import ModelError, ViewError
from ribbonopt.solution.solution import Solution
from ribbonopt.views import Style, plot_ribbon, plot_solution, save_figures
from ribbonopt.views.camera import camera_said
from ribbonopt.views.lettering import lettered, wrapped
from ribbonopt.views.subject import subject_of
from ribbonopt.views.symbols import formula, symbol
from ribbonopt.views.tint import TINTS, tint_of

CONFIGS = Path(__file__).parents[3] / "configs"
COLUMN = Style(width=3.35)
KINDS = ("ribbon", "strains", "plane")


@cache
def solved(name: str = "moebius_half") -> Solution:
    return solve(load_scene(CONFIGS / f"{name}.yaml"))


def words_of(figure):
    return [t for t in figure.findobj(Text) if t.get_text().strip() and t.get_visible()]


@pytest.mark.parametrize("kind", KINDS)
def test_a_single_column_has_its_width_and_legible_type(kind, tmp_path):
    figure = plot_solution(solved(), kind, COLUMN)
    assert figure.get_size_inches()[0] == 3.35
    figure.savefig(tmp_path / "a.png")
    assert imread(tmp_path / "a.png").shape[1] == int(3.35 * 150)
    assert all(7 <= t.get_fontsize() <= 9 for t in words_of(figure))
    box = figure.get_tightbbox()  # nothing is cut off
    assert (box.min >= 0).all() and (box.max <= figure.get_size_inches()).all()
    wide = plot_solution(solved(), kind)
    thin, usual = (
        max(line.get_linewidth() for axes in f.axes for line in axes.lines) for f in (figure, wide)
    )
    assert thin < 0.75 * usual


def test_a_style_may_say_every_size():
    style = Style(width=5, height=2, font_size=11, line_scale=2, font="serif")
    figure = plot_solution(solved(), "strains", style)
    assert tuple(figure.get_size_inches()) == (5, 2)
    assert figure.axes[1].xaxis.label.get_fontsize() == 11
    assert "STIXGeneral" in figure.axes[1].xaxis.label.get_fontfamily()
    assert figure.axes[0].lines[0].get_linewidth() == 2 * 1.8


def test_text_in_files_is_text_and_files_are_the_same_each_time(tmp_path):
    bare = Style(width=3.35, titles=False, font="serif")
    figures = [plot_solution(solved("helix"), "strains", bare) for _ in range(2)]
    for name in ("a.pdf", "a.svg"):
        for figure, beside in zip(figures, ("1", "2"), strict=True):
            figure.savefig(tmp_path / f"{beside}{name}")
        assert (tmp_path / f"1{name}").read_bytes() == (tmp_path / f"2{name}").read_bytes()
    data = (tmp_path / "1a.pdf").read_bytes()
    box = re.search(rb"/MediaBox \[ 0 0 ([\d.]+)", data)
    assert box and float(box[1]) == pytest.approx(3.35 * 72)
    assert b"/FontFile2" in data and b"/Type3" not in data
    streams = re.findall(rb"stream\r?\n(.*?)endstream", data, re.DOTALL)
    assert any(b"Tj" in zlib.decompress(s) for s in streams if s[:1] == b"x")
    text = (tmp_path / "1a.svg").read_text()
    assert text.count("<text") > 3 and ">0.2</text>" in text
    # And with settings of a user's own it is so all the same.
    with rc_context({"svg.fonttype": "path"}):
        figures[0].savefig(tmp_path / "3a.svg")
    assert (tmp_path / "3a.svg").read_text().count("<text") == text.count("<text")


def test_all_formats_that_are_asked_for_are_written(tmp_path):
    paths = save_figures(
        solved("helix"), tmp_path, style=Style(width=2, format=("svg", "png"), titles=False)
    )
    assert {p.name for p in paths} == {f"{k}.{f}" for k in KINDS for f in ("png", "svg")}
    assert all(p.stat().st_size > 1000 for p in paths)


def test_settings_of_matplotlib_are_what_they_were(tmp_path, monkeypatch):
    before = dict(rcParams)
    figure = plot_solution(solved(), "plane", Style(width=3.35, font="serif"))
    figure.savefig(tmp_path / "a.svg")
    with pytest.raises(ModelError):
        plot_ribbon(solved(), style=Style(camera="up"))
    assert dict(rcParams) == before
    monkeypatch.setitem(rcParams, "font.size", 30.0)  # a user's own do not spoil figures
    figure = plot_solution(solved(), "plane")
    assert max(t.get_fontsize() for t in words_of(figure)) == 12


def test_letters_and_titles(tmp_path):
    style = Style(letters=True, titles=False)
    save_figures(solved(), tmp_path, style=style)
    figure = plot_solution(solved(), "strains", style)
    assert not any(t.get_text() == "moebius-half" for t in words_of(figure))
    assert [lettered(i) for i in (0, 1, 25, 26, 51, 52)] == [
        *("(a)", "(b)", "(z)", "(aa)", "(az)", "(ba)")
    ]
    lettered_file, plain = imread(tmp_path / "strains.png"), plot_solution(solved(), "strains")
    assert any(t.get_text() == "moebius-half" for t in words_of(plain))
    assert lettered_file.shape[1] == 1080
    assert len(plot_solution(solved(), "ribbon", style).texts) == 0  # no caption


def test_formulas_stay_whole_in_lines():
    text = r"along generatrices $d_2 + \eta\, d_3$ and more"
    lines = wrapped(text, 1.0, 8).splitlines()
    assert len(lines) > 2 and any(r"$d_2 + \eta\, d_3$" in line for line in lines)
    assert " ".join(lines) == text


@pytest.mark.parametrize(
    "style, said",
    [
        (Style(width=-1), "style: width: found -1, expected a number from 1 to 40"),
        (Style(format=("eps",)), "style: format.0: found 'eps'"),
        (Style(font="No Such Font"), "style: font: found 'No Such Font', expected sans, serif"),
        (Style(width=40, dpi=2400), "dpi: found 2400, which makes a picture of 96,000"),
        (Style(camera="1,2,3"), "camera: found '1,2,3', expected azimuth,elevation"),
        (Style(color="u9"), "color: found 'u9', expected one of u2, u3, eta, energy"),
    ],
)
def test_faults_are_told(style, said):
    with pytest.raises(ModelError, match=re.escape(said)):
        plot_ribbon(solved(), style=style)


@pytest.mark.parametrize("text", ["x", "-x", "y", "-y", "z", "-z", "30,20", " -120 , -35.5 "])
def test_cameras_look_from_where_they_say(text):
    camera = camera_said(text)
    axes = np.array([camera.right, camera.up, camera.towards])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert camera.up[2] >= -1e-15  # z is never down
    if text[-1] in "xyz":
        sign = -1 if text.startswith("-") else 1
        assert camera.towards["xyz".index(text[-1])] == pytest.approx(sign)
    if text == "30,20":
        assert camera.towards[2] == pytest.approx(np.sin(np.deg2rad(20)))
        assert camera.towards[1] / camera.towards[0] == pytest.approx(np.tan(np.deg2rad(30)))


def test_planar_ribbons_lie_in_the_picture_where_the_camera_says():
    solution = solved("elastica_clamped")
    spans = [
        np.ptp(plot_ribbon(solution, style=Style(camera=c)).axes[0].collections[0].get_paths()[0]
               .vertices, axis=0) for c in ("y", "z")
    ]  # fmt: skip
    assert not np.allclose(spans[0], spans[1])


@pytest.mark.parametrize("field", ["u2", "u3", "eta", "energy"])
def test_colours_are_those_of_the_field(field):
    subject = subject_of(solved(), complete=True)
    tint = tint_of(field, [subject])
    for piece in subject.pieces:
        values = getattr(piece, field)
        place = (values[:-1] + values[1:]) / 2
        expected = np.clip((place - tint.low) / (tint.high - tint.low), 0, 1)
        found = np.abs(tint.colours(piece)[:, None] - tint.table).sum(axis=2).argmin(axis=1)
        assert np.abs(found - expected * (TINTS - 1)).max() < 3  # neighbours may look the same
    if field in ("u2", "u3", "eta"):
        assert tint.low == -tint.high  # they change sign: white is zero
    figure = plot_solution(solved(), "ribbon", Style(color=field))
    assert [axes.get_label() for axes in figure.axes][1] == "<colorbar>"


def test_laws_without_energy_and_rods_have_no_such_colours():
    with pytest.raises(ViewError, match="no energy"):
        plot_solution(solved("moebius_regularized"), "ribbon", Style(color="energy"))


def test_labels_are_formulas_only_where_they_can_be_drawn():
    assert formula(r"$\epsilon$") == r"$\epsilon$"
    for text in (r"$\frac{$", "$$", "cost $5", r"$\hspace{1e9}x$", r"$\nosuch$", "$" * 99):
        assert not re.search(r"(?<!\\)\$", formula(text)), text
    assert formula("a\x1b[31m$x$") == "a\\x1b[31m$x$"
    said = {"angle": r"$\alpha$", "u2": "bending"}
    assert symbol("parameters.angle", said) == r"$\alpha$"
    assert (symbol("u2", said), symbol("u2", {})) == ("bending", "$u_2(0)$")
    assert symbol("parameters.my_$x", {}) == r"my_\$x"
    assert symbol("boundary.end.position.z", {}) == "boundary.end.position.z"
