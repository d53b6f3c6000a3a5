"""Places that cannot be had are told before anything is solved, by each verb."""

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from branches import COLUMN, SHORT
from half_studies import SCENE

from ribbonopt.output.claims import claimed
from ribbonopt.output.results import load_solution
from ribbonopt.output.staging import staged_result

Run = Callable[..., Any]
STUDY = "scene: scene.yaml\nsave: all\nsweep: {grid: {law.epsilon: [0.1, 0.09]}}\n"
VERBS = {
    "solve": ("solve", "scene.yaml"),
    "compare": ("compare", "scene.yaml"),
    "bench": ("bench", "scene.yaml"),
    "stress": ("stress", "scene.yaml"),
    "continue": ("continue", "column.yaml"),
    "batch": ("batch", "study.yaml", "--jobs", "1"),
    "plot": ("plot", "result"),
    "verify": ("verify", "half"),
}

each_verb = pytest.mark.parametrize("verb", VERBS)


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory, solved: Callable[..., Any]) -> Path:
    from ribbonopt.output.results import save_solution

    place = tmp_path_factory.mktemp("results") / "result"
    with staged_result(place) as stage:
        save_solution(solved("helix"), stage.folder)
        stage.commit()
    return place


@pytest.fixture
def folder(tmp_path: Path, result: Path) -> Path:
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "column.yaml").write_text(COLUMN + SHORT)
    (tmp_path / "study.yaml").write_text(STUDY)
    shutil.copytree(result, tmp_path / "result")
    return tmp_path


@pytest.fixture
def never(monkeypatch: pytest.MonkeyPatch) -> None:
    def solve(*_: object, **__: object) -> None:
        raise AssertionError("solved")

    monkeypatch.setattr("ribbonopt.solvers.newton.NewtonSolver.solve", solve)
    monkeypatch.setattr("ribbonopt.solvers.ipopt.IpoptSolver.solve", solve)
    monkeypatch.setattr("ribbonopt.studies.batch.child.subprocess.Popen", solve)
    monkeypatch.setattr("ribbonopt.views.files._save", solve)


def is_refused(found: Any, words: str, folder: Path, before: list[str]) -> None:
    assert (found.status, found.out, found.err.count("\n")) == (2, "", 1)
    assert found.err.startswith("ribbonopt: ")
    assert words in found.err
    assert sorted(os.listdir(folder)) == before


@each_verb
@pytest.mark.parametrize("by", [claimed, staged_result])
def test_a_place_that_another_writes(
    run: Run, folder: Path, never: None, verb: str, by: Callable[..., Any]
) -> None:
    with by(folder / "place", ("summary.json",)):
        before = sorted(os.listdir(folder))
        found = run(*VERBS[verb], "--out", "place")
        is_refused(found, "place: is being written by another process", folder, before)


@each_verb
def test_a_link(run: Run, folder: Path, never: None, verb: str) -> None:
    (folder / "there").mkdir()
    (folder / "place").symlink_to("there")
    before = sorted(os.listdir(folder))
    is_refused(run(*VERBS[verb], "--out", "place"), "place: is a link to", folder, before)
    assert os.listdir(folder / "there") == []


@each_verb
@pytest.mark.parametrize("place", ["scene.yaml", "scene.yaml/a", "a" * 300, "/dev/null/a"])
def test_no_place(run: Run, folder: Path, never: None, verb: str, place: str) -> None:
    before = sorted(os.listdir(folder))
    if (verb, place) == ("plot", "scene.yaml"):
        return  # a file of a result stands for its folder
    is_refused(run(*VERBS[verb], "--out", place), "", folder, before)


@pytest.mark.parametrize("verb", ["solve", "compare", "bench", "stress"])
def test_the_working_folder_is_not_replaced(
    run: Run, folder: Path, never: None, verb: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "empty").mkdir()
    monkeypatch.chdir(folder / "empty")
    before = sorted(os.listdir(folder))
    command = [verb, folder / "scene.yaml", "--out"]
    is_refused(run(*command, "."), "the working folder is in it", folder, before)
    is_refused(run(*command, ""), "expected a folder", folder, before)


@pytest.mark.parametrize("name", ["rows.jsonl", "table.csv", "study.json", "solutions"])
def test_no_batch_is_written_through_links(run: Run, folder: Path, never: None, name: str) -> None:
    (folder / "mine").mkdir()
    (folder / "place").mkdir()
    (folder / "place" / name).symlink_to(folder / "mine")
    before = sorted(os.listdir(folder))
    found = run(*VERBS["batch"], "--out", "place", "--resume")
    is_refused(found, f"place/{name}: is a link to {folder / 'mine'}", folder, before)
    assert os.listdir(folder / "mine") == []


def test_pictures_are_not_written_through_links(run: Run, folder: Path) -> None:
    (folder / "mine").write_text("mine")
    (folder / "result" / "strains.png").symlink_to(folder / "mine")
    found = run("plot", "result")
    is_refused(found, "strains.png: is a link to", folder, sorted(os.listdir(folder)))
    assert (folder / "mine").read_text() == "mine"


def test_a_result_that_was_being_replaced_is_read(run: Run, folder: Path) -> None:
    (folder / "result").rename(folder / ".result.old")
    (folder / ".result.lock").write_text("1 nowhere")
    assert load_solution("result").verified
    (folder / "result").rename(folder / ".result.old")
    assert run("plot", "result").status == 0
    assert [name for name in os.listdir(folder) if name.startswith(".")] == []


def test_what_workers_left_is_put_away(run: Run, folder: Path) -> None:
    assert run(*VERBS["batch"], "--out", "place", "--quiet").status == 0
    solutions = folder / "place" / "solutions"
    (solutions / ".2.new").mkdir()
    (solutions / "1").rename(solutions / ".1.old")
    (folder / "place" / ".table.csv.new").write_text("half")
    (folder / "place" / ".lock").write_text("")
    assert run(*VERBS["batch"], "--out", "place", "--quiet", "--resume").status == 0
    assert sorted(os.listdir(solutions)) == ["1", "2"]
    names = ["report.html", "rows.jsonl", "solutions", "study.json", "table.csv"]
    assert sorted(os.listdir(folder / "place")) == names
