"""Figures of batches: every row is there, whatever it says does no harm."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from batch_rows import KINDS, ROWS, Row, bad, good

from ribbonopt.errors import OutputError
from ribbonopt.views.batch import plot_outcomes, plot_scatter, save_batch_figures, usual_pairs
from ribbonopt.views.histogram import histogram_of


@pytest.mark.parametrize("rows", KINDS.values(), ids=KINDS)
def test_any_rows(rows: list[Row], tmp_path: Path) -> None:
    for inputs in (("a", "b"), ("a",), ("b", "nowhere"), ()):
        plot_scatter(rows, usual_pairs(rows, inputs), inputs)
    pairs = [("a", "energy"), ("status", "number"), ("energy", "error"), ("a", "status")]
    assert len(save_batch_figures(rows, ("a", "b"), tmp_path, pairs)) == 2


def test_figures_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="cannot be written"):
        save_batch_figures(ROWS, ("a",), tmp_path / "nowhere")


def test_histograms_count_every_ribbon_once() -> None:
    rows = [good(i, a=0.1 * (i % 5), energy=1.0 * i) for i in range(1, 51)]
    rows += [bad(i, a=0.4) for i in range(51, 54)]
    steps = histogram_of(rows, "a")  # values recur: a bar around each
    assert steps is not None
    assert [(bar.verified, bar.failed) for bar in steps.bars] == [(10, 0)] * 4 + [(10, 3)]
    for bar, value in zip(steps.bars, (0, 0.1, 0.2, 0.3, 0.4), strict=True):
        assert bar.left < value < bar.right
    bins = histogram_of(rows, "energy")
    assert bins is not None
    assert (sum(bar.verified for bar in bins.bars), bins.ends) == (50, (1.0, 50.0))
    powers = histogram_of([good(i, a=10.0**i) for i in range(1, 7)], "a")
    assert powers is not None
    assert powers.log
    assert [powers.edges(bar)[0] < 1e6 for bar in powers.bars] == [True] * 6


def test_words_have_bars_and_rounding_has_none() -> None:
    rows = [good(1, a="left"), good(2, a={"type": "x"}), bad(3, a="left")]
    found = histogram_of(rows, "a")
    assert found is not None
    assert found.words == ("left", "type: x")
    assert [(bar.verified, bar.failed) for bar in found.bars] == [(1, 1), (1, 0)]
    assert histogram_of([good(i, a=1.0 + 1e-15 * i) for i in range(1, 9)], "a") is None
    planar = [good(i, n0x=1e-14 * i, n0y=5.0 * i) for i in range(1, 9)]
    assert histogram_of(planar, "n0x") is None  # of a load in the plane
    assert histogram_of(planar, "n0y") is not None


def points(figure: Any) -> list[int]:
    """Return how many finite points each scatter of the first panel has."""
    offsets = [np.asarray(c.get_offsets(), dtype=float) for c in figure.axes[0].collections]
    return [int(np.isfinite(each).all(axis=1).sum()) for each in offsets]


def test_scatter_has_every_row_with_both_numbers() -> None:
    # Four verified, one without an energy; two failed, which have none: crosses on the axis.
    assert points(plot_scatter(ROWS, [("a", "energy")], ("a", "b"))) == [3, 0, 2]
    assert points(plot_scatter(ROWS, [("a", "b")], ("a", "b"))) == [4, 2]
    assert (
        len(plot_scatter(ROWS, [("a", "energy")] * 7, ("a", "b")).axes) == 8
    )  # four panels, their colours
    # Words have places too; the third panel is the outcome over both inputs.
    words = [{**row, "law": "rod" if row["number"] % 2 else "strip"} for row in ROWS]
    assert sum(points(plot_scatter(words, [("law", "energy")], ("law",)))) == 3 + 2
    shaded = plot_scatter(words, [("a", "energy")], ("a", "law"))
    legend = shaded.axes[0].get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["rod", "strip"]
    axes = plot_scatter([*ROWS, bad(40)], [("a", "energy")]).axes[0]
    assert axes.get_xlim()[1] > 4  # where the last has failed


def test_usual_pairs_and_outcomes() -> None:
    assert usual_pairs(ROWS, ("a", "b")) == [("a", "energy"), ("b", "energy"), ("a", "b")]
    assert usual_pairs(ROWS, ("scene",)) == [("number", "energy")]
    bars = plot_outcomes(ROWS).axes[0]
    assert {bar.get_width() for bar in bars.patches} == {4, 2}
