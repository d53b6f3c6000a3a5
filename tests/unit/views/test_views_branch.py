"""Branches are drawn as they were found: stable and unstable, folds, stages, ribbons along them."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.image import imread
from matplotlib.text import Text

from ribbonopt.errors import OutputError
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.views import plot_ribbon
from ribbonopt.views.branch import COLOURS, draw_branch, plot_branch, save_branch_figures
from ribbonopt.views.branch_rows import BranchFigure
from ribbonopt.views.strip import plot_strip
from ribbonopt.views.style import blank

CONFIGS = Path(__file__).parents[3] / "configs"
STATES = ("stable", "unstable", "stability unknown")
TURN = math.sqrt(0.5)


def row(number, value, negative=0, kind="point", parameter="parameters.load", **others):
    point = {"stage": 0, "branch": 0, "parameter": parameter, parameter: value, "error": 1e-9}
    return {**point, "number": number, "negative": negative, "kind": kind, **others}


def fold():
    """Two folds, unstable between; the rows of the folds say nothing of stability."""
    rows = []
    for i, t in enumerate(sorted([*np.linspace(-1.6, 1.6, 20), -TURN, TURN])):
        special = math.isclose(abs(t), TURN)
        negative = None if special else int(abs(t) < TURN)
        kind = "fold" if special else "point"
        rows.append(row(i, t**3 - 1.5 * t, negative, kind, energy=float(t), u2=t * t))
    return rows


def pitchfork():
    rows = [
        row(i, v, int(v > 1), "branch point" if v == 1 else "point", u2=0.0)
        for i, v in enumerate(np.arange(0, 2.25, 0.25))
    ]
    for branch, sign in ((1, 1), (2, -1)):
        for v in np.arange(1.25, 2.25, 0.25):
            rows.append(row(len(rows), v, branch=branch, u2=sign * math.sqrt(v - 1)))
    return rows


def two_stages():
    rows = [row(i, 0.1 * i, energy=float(i), parameter="parameters.shortening") for i in range(4)]
    for i, epsilon in enumerate(np.geomspace(0.1, 1e-3, 5)):
        rows.append(row(4 + i, epsilon, energy=3.0 + i, stage=1, parameter="law.epsilon"))
    return rows


def lines_of(axes, label):
    return [line for line in axes.lines if line.get_label() == label]


def data_of(axes, label):
    return [line.get_xydata() for line in lines_of(axes, label)]


def on_curve(curve, points):
    """Check that a curve begins and ends with points, and meets each of them in their order."""
    places = [int(np.flatnonzero((curve == point).all(axis=1))[0]) for point in points]
    assert places == sorted(places)
    assert (places[0], places[-1]) == (0, len(curve) - 1)


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


@cache
def solved(name: str, *overrides: str) -> Solution:
    return solve(load_scene(CONFIGS / f"{name}.yaml", list(overrides)))


def test_unstable_stretches_are_dashed_and_folds_end_both():
    rows = fold()
    figure = plot_branch(rows, "value", "energy", title="arch")
    (axes,) = figure.axes
    first, last = (i for i, r in enumerate(rows) if r["kind"] == "fold")
    xy = np.array([[r["parameters.load"], r["energy"]] for r in rows])
    before, after = data_of(axes, "stable")
    (between,) = data_of(axes, "unstable")
    on_curve(before, xy[: first + 1])
    on_curve(between, xy[first : last + 1])
    on_curve(after, xy[last:])
    assert {line.is_dashed() for line in lines_of(axes, "unstable")} == {True}
    assert {line.is_dashed() for line in lines_of(axes, "stable")} == {False}
    assert not lines_of(axes, "stability unknown")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("load", r"energy $E$")
    assert axes.get_title(loc="left") == "arch"


def test_folds_are_squares_and_the_ends_are_marked():
    rows = fold()
    figure = plot_branch(rows, "value", "energy")
    (axes,) = figure.axes
    (folds,) = lines_of(axes, "fold")
    assert folds.get_marker() == "s"
    assert folds.get_linestyle() == "None"
    np.testing.assert_allclose(folds.get_ydata(), [-TURN, TURN])
    assert data_of(axes, "first point")[0].tolist() == [[rows[0]["parameters.load"], -1.6]]
    assert data_of(axes, "last point")[0].tolist() == [[rows[-1]["parameters.load"], 1.6]]
    assert legend_of(figure) == ["stable", "unstable", "first point", "last point", "fold (2)"]


def test_branches_differ_in_colour_and_are_not_joined():
    figure = plot_branch(pitchfork(), "value", "u2")
    (axes,) = figure.axes
    drawn = [line for line in axes.lines if line.get_label() in STATES]
    assert [line.get_color() for line in drawn] == [COLOURS[k] for k in (0, 0, 1, 2)]
    runs = [[r for r in pitchfork() if r["branch"] == k] for k in range(3)]
    ends = [line.get_xydata()[[0, -1]].tolist() for line in drawn]
    assert ends[:2] == [[[0, 0], [1, 0]], [[1, 0], [2, 0]]]
    # each begins where it branches off
    assert ends[2:] == [[[1, 0], [2, 1]], [[1, 0], [2, -1]]]
    for line, run in zip(drawn[2:], runs[1:], strict=True):
        points = [[r["parameters.load"], r["u2"]] for r in run]
        on_curve(line.get_xydata(), [[1, 0], *points])
        # between its points it is the parabola that it is
        x, y = line.get_xydata().T
        np.testing.assert_allclose(x, 1 + y**2, atol=0.02)
    (switch,) = lines_of(axes, "branch point")
    assert (switch.get_marker(), switch.get_markerfacecolor()) == ("o", "w")
    assert switch.get_xydata().tolist() == [[1, 0]]
    assert {"branch 0", "branch 1", "branch 2", "branch point (1)"} < set(legend_of(figure))
    assert len(data_of(axes, "last point")[0]) == 3


def test_where_stability_changes_between_points_it_is_unknown():
    rows = [row(i, i, negative, u2=0) for i, negative in enumerate([0, 0, 1, 2, None, None])]
    axes = plot_branch(rows, "value", "u2").axes[0]
    ends = {label: [xy[[0, -1], 0].tolist() for xy in data_of(axes, label)] for label in STATES}
    assert ends == {
        "stable": [[0, 1]],
        "unstable": [[2, 3]],
        "stability unknown": [[1, 2], [3, 5]],
    }
    thin, thick = lines_of(axes, "stability unknown")[0], lines_of(axes, "stable")[0]
    assert thin.get_linewidth() < thick.get_linewidth()
    assert thin.is_dashed()


def test_without_any_stability_lines_are_plain():
    figure = plot_branch([row(i, i, None, u2=i) for i in range(3)], "value", "u2")
    (line,) = lines_of(figure.axes[0], "stability unknown")
    assert not line.is_dashed()
    on_curve(line.get_xydata(), [[0, 0], [1, 1], [2, 2]])
    assert legend_of(figure) == ["stability unknown", "first point", "last point"]
    assert not figure.legends[0].get_lines()[0].is_dashed()


@pytest.mark.parametrize("log", [True, ["law.epsilon"]])
def test_each_parameter_has_its_axis(log):
    left, right = plot_branch(two_stages(), "value", "energy", log=log).axes
    assert left.get_xlabel() == "shortening\nstage 1"
    assert right.get_xlabel() == "$\\epsilon$\nstage 2"
    assert (left.get_xscale(), right.get_xscale()) == ("linear", "log")  # the first is at 0
    assert left.get_ylim() == right.get_ylim()
    assert data_of(left, "stable")[0][[0, -1]].tolist() == [[0, 0], [0.1 * 3, 3]]
    assert data_of(right, "stable")[0][[0, -1], 1].tolist() == [3, 7]
    assert lines_of(left, "first point") and not lines_of(left, "last point")
    assert lines_of(right, "last point") and not lines_of(right, "first point")


def test_stages_share_an_axis_where_the_parameter_is_not_drawn():
    (axes,) = plot_branch(two_stages(), "number", "energy", log=True).axes
    assert axes.get_xlabel() == "point"
    assert axes.get_xscale() == "linear"
    assert [xy[[0, -1]].tolist() for xy in data_of(axes, "stable")] == [
        [[0, 0], [3, 3]],
        [[4, 3], [8, 7]],
    ]


@pytest.mark.parametrize("high", [0.02, 0.5, 100.0])
def test_a_logarithmic_axis_has_ticks(high):
    rows = [row(i, v, u2=1) for i, v in enumerate(np.geomspace(0.011, high, 5))]
    figure = plot_branch(rows, "value", "u2", log=True)
    figure.canvas.draw()
    (axes,) = figure.axes
    low, high = axes.get_xlim()
    shown = [tick for tick in axes.get_xticks() if low <= tick <= high]
    assert axes.get_xscale() == "log"
    assert 3 <= len(shown) <= 8


def test_errors_are_drawn_on_a_logarithmic_axis():
    (axes,) = plot_branch(fold(), "number", "error").axes
    assert (axes.get_ylabel(), axes.get_yscale()) == ("estimated error", "log")


@pytest.mark.parametrize("log", [False, True])
def test_one_point(log):
    figure = plot_branch([row(0, 0.5, u2=1)], "value", "u2", log=log)
    figure.canvas.draw()
    (axes,) = figure.axes
    (line,) = lines_of(axes, "stable")
    assert (line.get_xydata().tolist(), line.get_marker()) == ([[0.5, 1]], "o")
    assert lines_of(axes, "first point") and not lines_of(axes, "last point")


def test_rows_without_values_are_skipped():
    rows = [row(i, i, u2=u2) for i, u2 in enumerate([1, None, 2, math.nan, 3])] + [row(5, 5)]
    (axes,) = plot_branch(rows, "value", "u2").axes
    on_curve(data_of(axes, "stable")[0], [[0, 1], [2, 2], [4, 3]])
    assert data_of(axes, "last point")[0].tolist() == [[4, 3]]


@pytest.mark.parametrize("rows", [[], [row(0, 1)]])
def test_nothing_to_draw(rows):
    figure = plot_branch(rows, "value", "H0", log=True)
    figure.canvas.draw()
    assert [text.get_text() for text in figure.axes[0].texts] == ["nothing recorded"]


def test_ribbons_are_drawn_to_one_scale():
    shares = (0.1, 0.4)
    ribbons = [solved("elastica_clamped", f"parameters.shortening={share}") for share in shares]
    figure = plot_strip(ribbons, ["parameters.shortening = 0.1\nthe first", "the other"])
    figure.canvas.draw()
    one, other = figure.axes
    assert one.get_xlim() == other.get_xlim() and one.get_ylim() == other.get_ylim()
    assert one.get_window_extent().size == pytest.approx(other.get_window_extent().size)
    assert other.get_xlabel() == "the other"
    assert one.get_xlabel().endswith("\nthe first")
    spans = []
    for axes in (one, other):
        (faces,) = axes.findobj(PolyCollection)
        points = np.concatenate([path.vertices for path in faces.get_paths()])
        low, high = points.min(axis=0), points.max(axis=0)
        assert axes.get_xlim()[0] <= low[0] < high[0] <= axes.get_xlim()[1]
        assert axes.get_ylim()[0] <= low[1] < high[1] <= axes.get_ylim()[1]
        spans.append(high - low)
    assert spans[0][0] > spans[1][0]  # shortened
    assert spans[0][1] < spans[1][1]  # and buckled


def test_bands_are_drawn_whole_and_said_to_be():
    piece = solved("band_three")
    figure = plot_strip([piece], ["three half twists"])
    assert any("by symmetry" in text.get_text() for text in figure.findobj(Text))
    whole, part = plot_ribbon(piece), plot_ribbon(piece, complete=False)
    count, expected, fewer = (
        len(f.axes[0].findobj(PolyCollection)[0].get_paths()) for f in (figure, whole, part)
    )
    assert count == expected > 1.5 * fewer


def test_files_are_written(tmp_path):
    pairs = [("value", "energy"), ("value", "u2"), ("u2", "energy"), ("number", "error")]
    figure = BranchFigure(fold(), (*pairs, pairs[0]))
    ribbons = {figure.pictured[0]["number"]: solved("helix")}
    paths, left_out = save_branch_figures(figure, ribbons, tmp_path)
    assert left_out == []
    assert [path.name for path in paths] == ["branch.png", "ribbons.png"]
    assert all(imread(path).std() > 0.02 for path in paths)
    assert imread(paths[0]).shape[1] > 1500  # two panels wide
    (only,) = save_branch_figures(BranchFigure(fold(), (pairs[0],)), {}, tmp_path).paths
    assert only == tmp_path / "branch.png"


def test_a_folder_that_is_not_there(tmp_path):
    with pytest.raises(OutputError, match=r"branch\.png: cannot be written"):
        figure = BranchFigure(fold(), (("value", "energy"),))
        save_branch_figures(figure, {}, tmp_path / "none")


# jumps, corners, notes, numbers


def straight(kinds=(), notes=None, count=7):
    kinds, notes = dict(kinds), notes or {}
    return [
        row(i, float(i), kind=kinds.get(i, "point"), u2=float(i % 3), note=notes.get(i, ""))
        for i in range(count)
    ]


def test_no_line_crosses_a_jump():
    rows = straight()
    figure = BranchFigure(rows, (("value", "u2"),), jumps=[3])
    (axes,) = draw_branch(figure, []).axes
    ends = [xy[[0, -1], 0].tolist() for xy in data_of(axes, "stable")]
    assert ends == [[0, 2], [3, 6]]


@pytest.mark.parametrize("jump", [0, 6])
def test_a_jump_at_an_end_leaves_a_point(jump):
    (axes,) = draw_branch(BranchFigure(straight(), (("value", "u2"),), jumps=[jump]), []).axes
    ends = [xy[[0, -1], 0].tolist() for xy in data_of(axes, "stable")]
    assert ends == ([[0, 6]] if jump == 0 else [[0, 5], [6, 6]])


@pytest.mark.parametrize(
    ("kind", "marker", "name"),
    [
        *(("fold", "s", "fold"), ("branch point", "o", "branch point")),
        *(("buckling point", "D", "buckling point"), ("kink", "v", "kink")),
        ("what comes later", "*", "other special point"),
    ],
)
def test_each_kind_has_its_mark(kind, marker, name):
    figure = plot_branch(straight({2: kind, 4: kind}), "value", "u2")
    (line,) = lines_of(figure.axes[0], name)
    assert (line.get_marker(), line.get_xdata().tolist()) == (marker, [2, 4])
    assert f"{name} (2)" in legend_of(figure)


def test_a_kink_is_a_corner():
    def slopes(kind):
        (axes,) = plot_branch(straight({2: kind}), "value", "u2").axes
        x, y = data_of(axes, "stable")[0].T
        at = int(np.flatnonzero(x == 2)[0])
        return [(y[k] - y[at]) / (x[k] - x[at]) for k in (at - 1, at + 1)]

    into, out = slopes("kink")
    assert into == pytest.approx(1, rel=0.3)
    assert out < -1
    into, out = slopes("branch point")
    assert abs(into - out) < 0.5 * 3


def test_notes_are_marked_where_they_begin():
    notes = {1: "odd", 2: "odd", 3: "other", 5: "odd"}
    figure = plot_branch(straight(notes=notes), "value", "u2")
    (line,) = lines_of(figure.axes[0], "note")
    assert line.get_xdata().tolist() == [1, 3, 5]
    assert "note" in legend_of(figure)


def test_special_points_and_ends_are_pictured_and_numbered():
    rows = fold()
    subject = BranchFigure(rows, (("value", "energy"),))
    chosen = [r["number"] for r in subject.pictured]
    special = [r["number"] for r in rows if r["kind"] != "point"]
    assert {0, len(rows) - 1, *special} <= set(chosen)
    assert chosen == sorted(set(chosen))
    assert len(chosen) <= 12
    (axes,) = draw_branch(subject, chosen).axes
    texts = [number for text in axes.texts for number in text.get_text().split(", ")]
    assert sorted(map(int, texts)) == chosen
    for text in axes.texts:
        number = int(text.get_text().split(",")[0])
        assert text.xy == pytest.approx((rows[number]["parameters.load"], rows[number]["energy"]))
    figure = draw_branch(subject, chosen)
    assert "numbers: points in ribbons.png" in legend_of(figure)


def test_pictures_are_spread_along_the_way_not_along_the_points():
    # many points at the begin, as where steps are short
    values = [*np.linspace(0, 0.01, 50), *np.linspace(0.1, 1, 10)]
    rows = [row(i, v, u2=v) for i, v in enumerate(values)]
    chosen = [r["u2"] for r in BranchFigure(rows, (("value", "u2"),)).pictured]
    assert max(np.diff(chosen)) < 0.25
    assert (chosen[0], chosen[-1]) == (0, 1)


def test_too_many_special_points_are_not_all_pictured():
    rows = straight({i: "fold" for i in range(1, 60, 2)}, count=60)
    chosen = BranchFigure(rows, (("value", "u2"),)).pictured
    assert len(chosen) <= 12
    assert sum(r["kind"] == "fold" for r in chosen) == 8


def test_captions_name_number_kind_and_value(tmp_path, monkeypatch):
    said = []
    monkeypatch.setattr(
        "ribbonopt.views.branch.plot_strip",
        lambda _, captions, style: said.append(captions) or blank(1, 1, style),
    )
    rows = pitchfork()
    subject = BranchFigure(rows, (("value", "u2"),))
    save_branch_figures(subject, {4: None, rows[-1]["number"]: None}, tmp_path)
    ((first, last),) = said
    assert first == "4  branch point\nload = 1"
    assert last == f"{rows[-1]['number']}\nload = 2\nbranch 2"


def test_mirror_images_are_both_seen():
    rows = [r | {"energy": abs(r["u2"])} for r in pitchfork()]
    one, other = plot_branch(rows, "value", "energy").axes[0].lines[2:4]
    assert one.get_linewidth() > 2 * other.get_linewidth()
    one, other = plot_branch(rows, "value", "u2").axes[0].lines[2:4]
    assert one.get_linewidth() == other.get_linewidth()


def test_a_branch_begins_at_the_nearest_crossing():
    rows = [
        row(i, float(i), kind="branch point" if i in (1, 3) else "point", u2=0.0) for i in range(5)
    ]
    rows += [row(5, 3.1, branch=1, u2=0.2), row(6, 4.0, branch=1, u2=1.0)]
    rows += [row(7, 1.1, branch=2, u2=0.2), row(8, 2.0, branch=2, u2=1.0)]
    drawn = [
        line.get_xydata()[0].tolist()
        for line in plot_branch(rows, "value", "u2").axes[0].lines
        if line.get_color() in COLOURS[1:3]
    ]
    assert drawn == [[3, 0], [1, 0]]


@pytest.mark.parametrize("si", [False, True])
def test_axes_bear_units_where_they_are_known(si):
    path = "boundary.end.position.z"
    rows = [row(i, i, parameter=path, energy=i, tip=i) for i in range(3)]
    pairs = (("value", "energy"), (path, "tip"), ("u2", "error"))
    labels = [
        (axes.get_xlabel(), axes.get_ylabel())
        for axes in draw_branch(BranchFigure(rows, pairs, "arch", si=si), []).axes
    ]
    expected = [(f"{path} (m)", "energy $E$ (J)"), (f"{path} (m)", "tip")]
    plain = [(path, "energy $E$"), (path, "tip")]
    assert labels[:2] == (expected if si else plain)


def test_rounding_is_flat():
    rows = [row(i, i, u2=(-1) ** i * 1e-31, m0x=3 + 1e-15 * i, m0y=0.0, m0z=0.0) for i in range(5)]
    for name in ("u2", "m0x"):
        (axes,) = plot_branch(rows, "value", name).axes
        low, high = axes.get_ylim()
        assert high - low > 1
        assert low < rows[0][name] < high


@pytest.mark.parametrize("branches", [1, 3, 7])
def test_all_of_the_legend_is_in_the_figure(branches):
    rows = straight({1: "fold", 2: "kink", 3: "branch point", 4: "buckling point", 5: "new"})
    rows += [row(7 + b, 1.0, None, branch=b, u2=1.0, note="odd") for b in range(1, branches)]
    figure = draw_branch(BranchFigure(rows, (("value", "u2"),)), [0])
    figure.canvas.draw()
    box = figure.legends[0].get_window_extent()
    width, height = figure.canvas.get_width_height()
    assert box.x0 >= 0 and box.y0 >= 0 and box.x1 <= width and box.y1 <= height


def test_rows_may_say_where_a_branch_begins():
    rows = [row(i, float(i), kind="branch point" if i == 3 else "point", u2=0.0) for i in range(5)]
    rows += [row(5, 3.1, branch=1, u2=0.2, origin=1), row(6, 4.0, branch=1, u2=1.0, origin=1)]
    (branch,) = (
        line
        for line in plot_branch(rows, "value", "u2").axes[0].lines
        if line.get_color() == COLOURS[1]
    )
    assert branch.get_xydata()[0].tolist() == [1, 0]


def test_the_two_ways_from_a_start_are_one_curve():
    def there(x):
        return (x - 0.3) ** 2

    ways = [np.linspace(0, 1, 6), np.linspace(0, -1, 6)[1:]]
    rows = [row(i, x, u2=there(x)) for i, x in enumerate(ways[0])]
    rows += [row(6 + i, x, branch=1, origin=0, u2=there(x)) for i, x in enumerate(ways[1])]
    lines = plot_branch(rows, "value", "u2").axes[0].lines
    curve = next(line for line in lines if line.get_color() == COLOURS[1]).get_xydata()
    assert curve[0].tolist() == [0, there(0)]
    slope = (curve[1, 1] - curve[0, 1]) / (curve[1, 0] - curve[0, 0])
    assert slope == pytest.approx(-0.6, abs=0.06)


def test_a_branch_that_begins_with_a_jump_is_not_joined():
    rows = pitchfork()
    first = next(r["number"] for r in rows if r["branch"] == 1)
    axes = draw_branch(BranchFigure(rows, (("value", "u2"),), jumps=[first]), []).axes[0]
    drawn = [line for line in axes.lines if line.get_color() == COLOURS[1]]
    assert [line.get_xydata()[0].tolist() for line in drawn] == [[1.25, 0.5]]


def locus():
    """A branch up to its fold, then the fold in a second number: two ways, one with a cusp."""
    first, second = "parameters.load", "parameters.depth"
    rows = [row(i, 0.25 * i, parameter=first, **{second: 0.0}) for i in range(4)]
    rows.append(row(4, 1.0, None, "fold", first, **{second: 0.0}))
    for branch, sign in ((0, 1), (1, -1)):
        for t in np.arange(1, 5) / 4:
            cusp = (branch, t) == (1, 0.5)
            more = {first: 1 - t * t, "stage": 1, "branch": branch, "of": "fold", "origin": 4}
            kind = "cusp" if cusp else "point"
            rows.append(row(len(rows), sign * t, None, kind, second, **more))
    return rows


def test_loci_are_lines_of_their_own() -> None:
    subject = BranchFigure(locus(), (("parameters.load", "parameters.depth"),), "locus")
    figure = draw_branch(subject, ())
    (axes,) = figure.axes
    lines = {line.get_label(): line for line in axes.lines}
    assert {"stable", "locus of folds", "cusp", "fold"} <= set(lines)
    assert not {"unstable", "stability unknown"} & set(lines)
    # Black, whatever the branch; both ways are told apart by no colour.
    colours = {line.get_color() for line in axes.lines if line.get_label() == "locus of folds"}
    assert len(colours) == 1
    assert colours.isdisjoint(COLOURS)
    (legend,) = figure.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words[:2] == ["stable", "locus of folds"]
    assert "cusp (1)" in words
    assert legend.get_lines()[0].get_color() == COLOURS[0]
    # Both ways begin at the fold, and go through their points.
    points = np.array([[r["parameters.load"], r["parameters.depth"]] for r in locus()[4:]])
    drawn = np.concatenate([line.get_xydata() for line in axes.lines])
    assert np.abs(points[:, None] - drawn).max(axis=2).min(axis=1).max() < 1e-12


def test_a_locus_has_a_corner_at_a_cusp_only_in_a_plane_of_parameters() -> None:
    rows = [
        row(i, t**3, None, "cusp" if t == 0 else "point", "parameters.b", of="fold")
        | {"parameters.a": t * t, "energy": t}
        for i, t in enumerate(np.linspace(-1, 1, 9))
    ]

    def turn(x: str, y: str) -> float:
        """Return the cosine of the angle by which the curve turns at the cusp."""
        figure = plot_branch(rows, x, y)
        (line,) = (one for one in figure.axes[0].lines if one.get_label() == "locus of folds")
        points = np.asarray(line.get_xydata(), float)
        at = int(np.abs(points).sum(axis=1).argmin())
        before, after = points[at] - points[at - 1], points[at + 1] - points[at]
        return float(before @ after / np.linalg.norm(before) / np.linalg.norm(after))

    assert turn("parameters.a", "parameters.b") < 0
    assert turn("parameters.b", "energy") > 0.9


def test_frequencies_along_a_branch_are_called_by_their_symbols() -> None:
    rows = [row(i, float(i), frequency1=3.0 - i, squared2=-1.0 * i) for i in range(4)]
    for si, words in ((False, (r"$\omega_{1}$", r"$\omega_{2}^2$")), (True, ("$f_{1}$ (Hz)",))):
        for column, said in zip(("frequency1", "squared2"), words, strict=False):
            assert plot_branch(rows, "value", column, si=si).axes[0].get_ylabel() == said
    labels = {"frequency1": "pitch"}
    assert plot_branch(rows, "value", "frequency1", labels=labels).axes[0].get_ylabel() == "pitch"
