"""The verb `view`: a page beside a result, a branch or a batch, or where it is asked for."""

import json
import os
import re
import shutil
import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from branches import COLUMN, SHORT
from half_studies import SCENE

Run = Callable[..., Any]
STUDY = """\
name: study
scene: scene.yaml
save: all
sweep: {list: [{law.epsilon: 0.1}, {law.epsilon: 0.05}, {law.epsilon: 0.03}]}
"""


def shown(path: str | Path) -> dict[str, Any]:
    text = Path(path).read_text(encoding="utf-8")
    (found,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    data: dict[str, Any] = json.loads(found)
    return data


@pytest.fixture(scope="module")
def places(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from ribbonopt.cli import main

    folder = tmp_path_factory.mktemp("seen")
    (folder / "scene.yaml").write_text(SCENE)
    (folder / "column.yaml").write_text(COLUMN + SHORT)
    (folder / "study.yaml").write_text(STUDY)
    for verb, file, out in (
        ("solve", "scene", "result"),
        ("continue", "column", "branch"),
        ("batch", "study", "batch"),
    ):
        words = [verb, str(folder / f"{file}.yaml"), "--out", str(folder / out), "--quiet"]
        assert main([*words, *(["--jobs", "1"] if verb == "batch" else [])]) == 0
    return folder


@pytest.fixture
def here(places: Path, tmp_path: Path) -> Path:
    """The working folder with copies of all that is looked at."""
    for name in ("result", "branch", "batch"):
        shutil.copytree(places / name, tmp_path / name)
    return tmp_path


def test_a_result(run: Run, here: Path) -> None:
    assert run("view", "result") == (0, "result/view.html\n", "")
    told = shown("result/view.html")
    assert (told["kind"], len(told["shapes"])) == ("result", 1)
    assert told["diagram"] is told["table"] is None
    summary = json.loads((here / "result" / "summary.json").read_text())
    energy = float(dict(told["shapes"][0]["numbers"])["energy"].split()[0])
    assert energy == pytest.approx(summary["energy"], rel=1e-6)


def test_a_page_belongs_to_its_result(run: Run, places: Path, here: Path) -> None:
    assert run("view", "result/summary.json")[0] == 0  # any file of it
    before = (here / "result" / "view.html").read_bytes()
    assert run("view", "result", "--half-width", "0.07")[0] == 0
    assert (here / "result" / "view.html").read_bytes() != before
    status, _, err = run("solve", places / "scene.yaml", "--out", "result", "--quiet")
    assert (status, err) == (0, "")
    assert not (here / "result" / "view.html").exists()  # it showed the older one


def test_other_equilibria_are_shown_too(run: Run, here: Path) -> None:
    shutil.copytree("result", "result/equilibria/2")
    shutil.copytree("result/equilibria/2", "result/equilibria/10")
    assert run("view", "result")[0] == 0
    captions = [shape["caption"] for shape in shown("result/view.html")["shapes"]]
    assert captions == [f"equilibrium {i}, verified" for i in (1, 2, 3)]


def test_a_branch(run: Run, here: Path) -> None:
    assert run("view", "branch")[:2] == (0, "branch/view.html\n")
    told = shown("branch/view.html")
    rows = [
        json.loads(line) for line in (here / "branch" / "branch.jsonl").read_text().splitlines()
    ]
    rows = [line["row"] for line in rows if "row" in line]
    assert told["kind"] == "branch"
    assert [shape["row"] for shape in told["shapes"]] == list(range(len(rows)))
    assert told["diagram"]["number"] == [row["number"] for row in rows]
    for shape, row in zip(told["shapes"], rows, strict=True):
        assert f"P = {row['parameters.P']:.6g}" in shape["caption"]
        assert ("unstable" in shape["caption"]) == bool(row["negative"])
        assert float(dict(shape["numbers"])["shortening"]) == pytest.approx(
            row["shortening"], rel=1e-5, abs=1e-5
        )


def test_a_branch_with_a_page_goes_on(run: Run, places: Path, here: Path) -> None:
    assert run("view", "branch")[0] == 0
    words = ("continue", places / "column.yaml", "--out", "branch", "--resume", "--quiet")
    assert run(*words) == (0, "", "")


def test_a_batch(run: Run, here: Path) -> None:
    assert run("view", "batch")[:2] == (0, "batch/view.html\n")
    told = shown("batch/view.html")
    assert (told["kind"], len(told["table"]["rows"])) == ("batch", 3)
    assert [shape["row"] for shape in told["shapes"]] == [0, 1, 2]
    assert [shape["caption"] for shape in told["shapes"]] == [
        f"ribbon {i}, verified" for i in (1, 2, 3)
    ]
    shutil.rmtree("batch/solutions/2")
    assert run("view", "batch")[0] == 0
    assert [shape["row"] for shape in shown("batch/view.html")["shapes"]] == [0, 2]
    shutil.rmtree("batch/solutions")
    assert run("view", "batch")[0] == 0
    told = shown("batch/view.html")
    assert (told["shapes"], len(told["table"]["rows"])) == ([], 3)


def test_another_place(run: Run, here: Path) -> None:
    assert run("view", "result", "--out", "pages/ribbon.html")[:2] == (0, "pages/ribbon.html\n")
    assert os.listdir("pages") == ["ribbon.html"]
    assert not (here / "result" / "view.html").exists()


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        (("--out", "result"), "'result': expected a file for the page, such as view.html"),
        (("--out", "thesis.tex"), "thesis.tex: expected a name that ends in .html"),
        (("--out", "mine.html"), "mine.html: is not a page of ribbonopt; choose another name"),
        (("--out", "link.html"), "link.html: is a link to"),
        (("--half-width", "0"), "--half-width: found '0'; expected a number > 0"),
        (("--half-width", "nan"), "--half-width: found 'nan'; expected a number > 0"),
        (("--half-width", "wide"), "--half-width: found 'wide'; expected a number > 0"),
    ],
)
def test_what_is_refused(run: Run, here: Path, words: tuple[str, ...], complaint: str) -> None:
    (here / "mine.html").write_text("<p>mine</p>")
    (here / "page.html").write_text('<meta name="generator" content="ribbonopt view">')
    (here / "link.html").symlink_to("page.html")
    before = sorted(path.name for path in here.rglob("*"))
    status, out, err = run("view", "result", *words)
    assert (status, out) == (2, "")
    assert complaint in err
    assert sorted(path.name for path in here.rglob("*")) == before
    assert (here / "mine.html").read_text() == "<p>mine</p>"


def test_what_is_no_result(run: Run, here: Path) -> None:
    (here / "empty").mkdir()
    for place, complaint in (("nothing", "no such folder"), ("empty", "without a result")):
        status, out, err = run("view", place)
        assert (status, out) == (2, "")
        assert f"{place}: " in err
        assert complaint in err
        assert not (here / place / "view.html").exists()


def test_a_folder_that_cannot_be_written(run: Run, here: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("root may write anywhere")
    (here / "result").chmod(0o500)
    status, out, err = run("view", "result")
    (here / "result").chmod(0o700)
    assert (status, out) == (2, "")
    assert "result: cannot be written" in err


def test_it_is_opened(run: Run, here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(webbrowser, "open", lambda url: asked.append(url) or len(asked) == 1)
    assert run("view", "result", "--open") == (0, "result/view.html\n", "")
    assert asked == [(here / "result" / "view.html").resolve().as_uri()]
    status, out, err = run("view", "result", "--open")
    assert (status, out) == (0, "result/view.html\n")
    assert "no browser was found" in err
