"""Report and figures of batches: every row is there, whatever it says does no harm."""

import json
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.errors import OutputError
from ribbonopt.viewer import report
from ribbonopt.views.batch import plot_outcomes, plot_scatter, save_batch_figures, usual_pairs
from ribbonopt.views.histogram import histogram_of
from ribbonopt.viewer.report import write_report
from ribbonopt.views.style import BENDING, FAINT, INK, TWIST

Row = dict[str, Any]
HOSTILE = "</script><script>alert(1)</script> <b>&amp; @data@ \u2028 \\ ' \" ]]>"


def good(number: int, **more: Any) -> Row:
    row = {
        "number": number,
        "scene": "s",
        "a": 0.1 * number,
        "b": number % 3,
        "status": "converged",
    }
    row |= {"verified": True, "message": "", "energy": number**2 / 7, "error": 10.0**-number}
    return row | {"u2": -number, "seconds": 0.01, "path": "newton"} | more


def bad(number: int, **more: Any) -> Row:
    row = {"number": number, "scene": "s", "a": 0.1 * number, "b": number % 3, "status": "crashed"}
    return row | {"verified": False, "message": f"died after {number}.5 s"} | more


ROWS = [good(1), bad(2), good(3), good(4), bad(5), good(6, error=None, energy=float("nan"))]


class Page(HTMLParser):
    """Elements, their attributes and the embedded data of a page; fails on unclosed ones."""

    VOID = ("meta", "input", "rect", "br", "link")

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.text = ""
        self.data: Any = None
        self._json = False
        self.feed(path.read_text(encoding="utf-8"))
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self._json = dict(attrs).get("id") == "data"
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self._json and self.open[-1:] == ["script"]:
            self.data = json.loads(data)
            self._json = False
        elif "script" not in self.open and "style" not in self.open:
            self.text += data


def page(
    rows: list[Row], tmp_path: Path, inputs: tuple[str, ...] = ("a", "b"), **more: Any
) -> Page:
    settings = {"name": "study", "count": len(rows)} | more
    return Page(write_report(rows, inputs, tmp_path / "report.html", **settings))


def test_the_data_are_the_rows(tmp_path: Path) -> None:
    data = page(ROWS[::-1], tmp_path).data
    names = data["names"]
    assert [row[names.index("number")] for row in data["rows"]] == [1, 2, 3, 4, 5, 6]
    for found, row in zip(data["rows"], ROWS, strict=True):
        for name, value in zip(names, found, strict=True):
            wanted = row.get(name)
            if wanted is not None and wanted != wanted:
                wanted = None
            assert value == wanted, name
    assert data["status"] == [True, False, True, True, False, True]
    assert (data["defaults"]["x"], data["defaults"]["y"], data["defaults"]["c"]) == (
        "a",
        "energy",
        "b",
    )


def test_what_failed_and_why(tmp_path: Path) -> None:
    found = page(ROWS, tmp_path, count=8)
    text, reasons = found.text, found.text.split("Distributions")[0]
    # Messages that differ in numbers only are one reason.
    assert found.tags.count("section") == 1
    assert "2 crasheddied after 2.5 sribbons 2, 5" in reasons
    assert "died after 5.5 s" not in reasons
    assert "a0.2 to 0.5" in reasons
    assert "b2" in reasons
    assert "4verified" in text
    assert "2failed" in text
    assert "2missing: go on by --resume" in text
    assert "crashed 2" in text
    assert "largest error; median 1e-03" in text  # of those that are verified
    assert "all verified" in page([good(1), good(2)], tmp_path).text
    many = [bad(i, message=f"reason {'x' * i}") for i in range(1, 61)]
    found = page(many, tmp_path)
    assert (found.tags.count("section"), "10 more failed in 10 other ways" in found.text) == (50, 1)


def test_bars_show_where_among_the_inputs(tmp_path: Path) -> None:
    page(ROWS, tmp_path)  # 0.2 to 0.5 of 0.1 to 0.6
    assert "left:20.0%;right:20.0%" in (tmp_path / "report.html").read_text(encoding="utf-8")
    rows = [good(1, a=1.0), bad(2, a=10.0), good(3, a=100.0)]  # by powers
    page(rows, tmp_path, ("a",))
    assert "left:50.0%;right:50.0%" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_errors_of_what_failed_are_not_those_of_answers(tmp_path: Path) -> None:
    missed = bad(2, status="tolerance_missed", error=0.5, energy=3.0)
    assert "largest error; median 1e-01" in page([good(1), missed], tmp_path).text


def test_hostile_texts_do_no_harm(tmp_path: Path) -> None:
    rows = [bad(1, message=HOSTILE, scene=HOSTILE, status=HOSTILE), good(2, word=HOSTILE)]
    found = page(rows, tmp_path, ("a", "word", HOSTILE), name=HOSTILE)
    assert found.tags.count("script") == 2
    assert found.tags.count("b") == 5  # the numbers at the head
    assert HOSTILE.replace("\u2028", r"\u2028") in found.text
    assert found.data["rows"][1][found.data["names"].index("word")] == HOSTILE
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    (data,) = re.findall(r'id="data">(.*?)</script>', text, re.DOTALL)
    assert not set("<>&\u2028\u2029") & set(data)


@pytest.mark.parametrize(
    "rows",
    [
        [],
        [good(1)],
        [bad(1)],
        [bad(1), bad(2)],
        [good(1, energy=None), good(2, energy=None)],
        [good(1, a="left"), good(2, a="right"), bad(3, a=[1, 2])],
        [good(1, a=True), good(2, a=False)],
        [good(i, a=10.0**i) for i in range(1, 6)],
    ],
    ids=["none", "one", "one bad", "all bad", "no energy", "words", "truths", "powers"],
)
def test_any_rows(rows: list[Row], tmp_path: Path) -> None:
    for inputs in (("a", "b"), ("a",), ("b", "nowhere"), ()):
        page(rows, tmp_path, inputs)
        plot_scatter(rows, usual_pairs(rows, inputs), inputs)
    pairs = [("a", "energy"), ("status", "number"), ("energy", "error"), ("a", "status")]
    assert len(save_batch_figures(rows, ("a", "b"), tmp_path, pairs)) == 2


def test_texts_that_are_no_text_and_numbers_that_are_no_numbers(tmp_path: Path) -> None:
    rows = [bad(1, message="half \ud800"), good(2, a=10**400, energy=float("inf"))]
    found = page(rows, tmp_path)
    assert "half" in found.text
    assert [row[found.data["names"].index("energy")] for row in found.data["rows"]] == [None, None]


def test_what_is_beside_the_report_is_a_link(tmp_path: Path) -> None:
    assert "solutions/2/" not in page_text(tmp_path)
    (tmp_path / "solutions" / "2").mkdir(parents=True)
    assert '<a href="solutions/2/">2</a>' in page_text(tmp_path)
    assert "solutions/3/" not in page_text(tmp_path)
    assert '<a href="table.csv">' not in page_text(tmp_path)
    (tmp_path / "table.csv").touch()
    assert '<a href="table.csv">' in page_text(tmp_path)


def page_text(tmp_path: Path) -> str:
    path = write_report(ROWS, ("a", "b"), tmp_path / "report.html", name="n", count=6)
    return path.read_text(encoding="utf-8")


def test_a_page_needs_nothing_from_elsewhere_and_has_the_colours_of_figures(tmp_path: Path) -> None:
    text = page_text(tmp_path)
    assert "default-src 'none'" in text
    assert "http:" not in text and "https:" not in text
    assert not re.search(r"@(title|head|failures|distributions|table|data|script)@", text)
    for name, colour in {"good": BENDING, "bad": TWIST, "ink": INK, "faint": FAINT}.items():
        assert f"--{name}: {colour};" in text
    assert report.GOOD == BENDING
    assert report.BAD[0] == TWIST


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


def test_ten_thousand_rows(tmp_path: Path) -> None:
    rows = [good(i, error=1e-9) if i % 50 else bad(i) for i in range(1, 10_001)]
    found = page(rows, tmp_path)
    assert len(found.data["rows"]) == 10_000
    # Of the 200 that failed, 4 are among the first 200 rows.
    assert found.tags.count("tr") == 1 + 200 + 196
    assert "396 of 10000, the first 200 and those that failed" in found.text


def test_it_loads_no_plotting_library(tmp_path: Path) -> None:
    code = (
        "import sys; from ribbonopt.viewer.report import write_report\n"
        f"write_report([], (), {str(tmp_path / 'r.html')!r}, name='n', count=0)\n"
        "print('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="cannot be written"):
        write_report(ROWS, ("a",), tmp_path / "nowhere" / "r.html", name="n", count=6)
    with pytest.raises(OutputError, match="cannot be written"):
        save_batch_figures(ROWS, ("a",), tmp_path / "nowhere")
    (tmp_path / "r.html").mkdir()
    with pytest.raises(OutputError, match="cannot be written"):
        write_report(ROWS, ("a",), tmp_path / "r.html", name="n", count=6)
    assert [path.name for path in tmp_path.iterdir()] == ["r.html"]


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
