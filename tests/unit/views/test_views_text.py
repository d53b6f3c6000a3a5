"""Names and words in figures are drawn as they are: no mathematics, no warnings, any script."""

from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import matplotlib
import pytest
from hostile import ALL, MARKUP, NAMES_KEPT, acting, texts
from matplotlib.font_manager import fontManager
from matplotlib.text import Text

from ribbonopt.viewer.report import write_report
from ribbonopt.views import page
from ribbonopt.views.batch import plot_outcomes, plot_scatter
from ribbonopt.views.branch import plot_branch
from ribbonopt.views.comparison import plot_study
from ribbonopt.views.style import blank, title

LOOKS_WRONG = (
    "$",
    r"$\frac{$",
    "日本語 $x",
    "_hidden",
    "\x1b[31m",
    "a\nb",
    "x" * 500,
    "שלום",
    "\udcff",
)


def rows_of(word: str) -> list[dict[str, Any]]:
    return [
        {"number": i, "scene": word, "status": word if bad else "converged", "verified": not bad}
        | {"message": word, word: word + str(i % 2), "energy": 1.0 + i, "u2": 2.0 * i}
        for i, bad in enumerate((False, True, False, False), start=1)
    ]


def branch_of(word: str) -> list[dict[str, Any]]:
    return [
        {"number": i, "stage": 0, "branch": 0, "parameter": word, word: 0.1 * i, "kind": "point"}
        | {"negative": 0, "energy": 1.0 + i**2}
        for i in range(1, 5)
    ]


@pytest.mark.parametrize("word", LOOKS_WRONG, ids=ascii)
def test_any_word_can_be_drawn(word: str, tmp_path: Path) -> None:
    # Warnings are errors here.
    comparison = {"name": word, "rows": [], "peers": [], "slopes": []}
    figures = {
        "outcomes": plot_outcomes(rows_of(word)),
        "scatter": plot_scatter(rows_of(word), [(word, "energy"), ("u2", "energy")], [word]),
        "branch": plot_branch(branch_of(word), "value", "energy", title=word),
        "comparison": plot_study(comparison),
    }
    for name, figure in figures.items():
        figure.savefig(tmp_path / f"{name}.png", dpi=40)
        for text in figure.findobj(Text):
            assert isinstance(text, Text)
            assert not acting(text.get_text())


def test_a_title_says_the_name(tmp_path: Path) -> None:
    for name in (*NAMES_KEPT[:8], *MARKUP[:6]):
        axes = blank(4, 3).subplots()
        title(axes, name)
        said = axes.get_title(loc="left").replace(r"\$", "$").strip()
        assert said == name or (said.endswith("…") and name.startswith(said[:-1]))


def test_other_fonts_give_the_letters_that_one_lacks(tmp_path: Path) -> None:
    # Of the fonts that come with matplotlib, the one of figures lacks this letter.
    letter, other = "\U0001d4d0", "STIXGeneral"
    axes = blank(4, 3).subplots()
    title(axes, f"letter {letter}")
    axes.figure.savefig(tmp_path / "a.png")
    (text,) = axes.figure.findobj(lambda artist: letter in getattr(artist, "get_text", str)())
    assert other in text.get_fontfamily()


def test_fonts_that_cannot_be_read_are_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = tmp_path / "broken.ttf"
    broken.write_bytes(b"no font")
    entries = [
        matplotlib.font_manager.FontEntry(fname=str(path), name=name, style="italic", weight=1)
        for name, path in {"Broken": broken, "Missing": tmp_path / "none.ttf"}.items()
    ]
    monkeypatch.setattr(fontManager, "ttflist", entries)
    page._family_with.cache_clear()
    assert page._family_with("\u6f22") == ""
    page._family_with.cache_clear()


class Tags(HTMLParser):
    def __init__(self, path: Path) -> None:
        super().__init__()
        self.tags: list[tuple[str, tuple[str, ...]]] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, tuple(name for name, _ in attrs)))

    handle_startendtag = handle_starttag


def report_of(word: str, folder: Path, short: Callable[[str], str] = str) -> Path:
    rows = rows_of(word)
    return write_report(rows, (word, "u2"), folder / "report.html", name=word, count=4)


def test_no_word_changes_the_elements_of_a_report(tmp_path: Path) -> None:
    harmless = {
        size: Tags(report_of("w" * size, tmp_path)).tags for size in (1, 200)
    }  # long cells have a title
    for word in (*ALL, *texts(seed=6, count=60)):
        if not word or len(word) > 5000:
            continue
        path = report_of(word, tmp_path)
        plain = [(tag, a) for tag, a in Tags(path).tags if tag not in ("td",)]
        assert plain in [[(t, a) for t, a in found if t != "td"] for found in harmless.values()], (
            word
        )
        assert not acting(path.read_text(encoding="utf-8").partition('id="data"')[0])
