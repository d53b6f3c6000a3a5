"""The report of a batch: every row is there, whatever it says does no harm."""

import base64
import hashlib
import json
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from batch_rows import KINDS, ROWS, Row, bad, good

from ribbonopt.errors import OutputError
from ribbonopt.text import printable
from ribbonopt.viewer.report import write_report
from ribbonopt.viewer.rows import BAD, GOOD
from ribbonopt.views.style import BENDING, INK, TWIST

HOSTILE = "</script><script>alert(1)</script> <b>&amp; @data@ \u2028 \\ ' \" ]]>"


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
    assert data["verified"] == [True, False, True, True, False, True]
    assert (data["x"], data["y"], data["c"]) == ("a", "energy", "b")
    assert data["colours"] == {"converged": "--good", "crashed": "--bad"}
    named = [name for name, may in zip(names, data["axis"], strict=True) if not may]
    assert named == ["message"]
    assert [name for name, log in zip(names, data["log"], strict=True) if log] == ["error"]


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
    # Signs that could act are seen, as everywhere; the table writes this text as it stands here.
    assert found.data["rows"][1][found.data["names"].index("word")] == printable(HOSTILE)
    assert set(found.data["colours"].values()) == {"--good", "--bad"}
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    (data,) = re.findall(r'id="data">(.*?)</script>', text, re.DOTALL)
    assert not set("<>&\u2028\u2029") & set(data)


def test_only_its_own_script_may_run(tmp_path: Path) -> None:
    text = page_text(tmp_path)
    (policy,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', text)
    (script,) = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}';" in policy
    assert "default-src 'none'" in policy
    assert not re.search(r" on\w+=", text.partition("<script>")[0])


@pytest.mark.parametrize("rows", KINDS.values(), ids=KINDS)
def test_any_rows(rows: list[Row], tmp_path: Path) -> None:
    for inputs in (("a", "b"), ("a",), ("b", "nowhere"), ()):
        data = page(rows, tmp_path, inputs).data
        assert len(data["rows"]) == len(rows)
        assert all(len(row) == len(data["names"]) for row in data["rows"])


def test_texts_that_are_no_text_and_numbers_that_are_no_numbers(tmp_path: Path) -> None:
    rows = [bad(1, message="half \ud800"), good(2, a=10**400, energy=float("inf"))]
    found = page(rows, tmp_path)
    assert "half" in found.text
    assert [row[found.data["names"].index("energy")] for row in found.data["rows"]] == [None, None]


def test_what_is_beside_the_report_is_a_link(tmp_path: Path) -> None:
    assert page(ROWS, tmp_path).data["links"] == {}
    (tmp_path / "solutions" / "2").mkdir(parents=True)
    (tmp_path / "solutions" / "javascript:alert(1)").mkdir()
    assert page(ROWS, tmp_path).data["links"] == {"2": "solutions/2/"}
    assert '<a href="table.csv">' not in page_text(tmp_path)
    (tmp_path / "table.csv").touch()
    assert '<a href="table.csv">' in page_text(tmp_path)


def page_text(tmp_path: Path) -> str:
    path = write_report(ROWS, ("a", "b"), tmp_path / "report.html", name="n", count=6)
    return path.read_text(encoding="utf-8")


def test_a_page_needs_nothing_from_elsewhere_and_has_the_colours_of_figures(tmp_path: Path) -> None:
    text = page_text(tmp_path)
    assert "https:" not in text
    assert set(re.findall(r"http:[^\"]*", text)) == {"http://www.w3.org/2000/svg"}  # a name
    assert not re.search(r"@(title|policy|style|head|failures|distributions|files|data)@", text)
    light, dark = text.split(":root.dark")
    for name, colour in {"good": BENDING, "bad": TWIST, "ink": INK}.items():
        assert f"--{name}: {colour};" in light
    # Every colour that is used is defined, in light and dark.
    used = set(re.findall(r"var\((--\w+)\)", text)) | {GOOD, *BAD, "--none"}
    for part in (light, dark):
        assert used <= set(re.findall(r"(--\w+): #", part))


def test_what_a_report_weighs_without_rows(tmp_path: Path) -> None:
    page([], tmp_path)
    assert (tmp_path / "report.html").stat().st_size < 50_000


def test_ten_thousand_rows(tmp_path: Path) -> None:
    rows = [good(i, error=1e-9) if i % 50 else bad(i) for i in range(1, 10_001)]
    found = page(rows, tmp_path)
    assert len(found.data["rows"]) == 10_000
    # Rows are shown a page at a time, by the browser: they stand once in the file.
    assert found.tags.count("tr") == 0
    assert (tmp_path / "report.html").stat().st_size < 10_000 * 100 + 60_000


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
    (tmp_path / "r.html").mkdir()
    with pytest.raises(OutputError, match="cannot be written"):
        write_report(ROWS, ("a",), tmp_path / "r.html", name="n", count=6)
    assert [path.name for path in tmp_path.iterdir()] == ["r.html"]
