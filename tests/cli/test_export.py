"""`ribbonopt export`: results, branches and batches as files for others."""

import json
import shutil
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from branches import COLUMN
from half_studies import SCENE

import ribbonopt
from ribbonopt.cli import main
from ribbonopt.errors import ModelError
from ribbonopt.exports.formats import FORMATS
from ribbonopt.exports.series import times_of
from ribbonopt.output.saved import read_summary

Run = Callable[..., Any]
STAGES = """\
continuation:
  - {parameter: parameters.P, from: 30, to: 36, largest: 3}
  - {parameter: parameters.turn, values: [0, 0.02], largest: 0.02}
"""
STUDY = """\
name: O'Brien & Söhne
scene: scene.yaml
sweep: {grid: {law.epsilon: [0.1, 0.08]}}
save: all
"""
SAVED = ("scene.yaml", "solution.npz", "summary.json")


@pytest.fixture(scope="module")
def once(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with results of each kind, made once and copied by those who write into them."""
    folder = tmp_path_factory.mktemp("once")
    (folder / "scene.yaml").write_text(SCENE)
    (folder / "column.yaml").write_text(COLUMN + STAGES)
    assert main(["solve", str(folder / "scene.yaml"), "--out", str(folder / "one"), "--quiet"]) == 0
    command = ["continue", str(folder / "column.yaml"), "--out", str(folder / "branch"), "--quiet"]
    assert main(command) == 0
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    command = ["batch", str(folder / "study.yaml"), "--jobs", "1", "--quiet", "--out"]
    assert main([*command, str(folder / "all")]) == 0
    # A batch that saves none is one without that folder.
    shutil.copytree(folder / "all", folder / "none", ignore=lambda *_: ["solutions"])
    return folder


@pytest.fixture
def here(once: Path, tmp_path: Path) -> Path:
    for name in ("one", "branch", "all", "none"):
        shutil.copytree(once / name, tmp_path / name)
    return tmp_path


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_result_has_its_files_in_a_folder_beside(here: Path, run: Run) -> None:
    status, out, err = run("export", "one")
    assert (status, err) == (0, "")
    assert out.splitlines() == ["one/exports/half.vtp", "one/exports/half-line.vtp"]
    assert all((here / line).is_file() for line in out.splitlines())
    # The folder is one of the result: the next result there takes its place.
    assert run("solve", "one/scene.yaml", "--out", "one", "--quiet").status == 0
    assert names(here / "one") == sorted(SAVED)


@pytest.mark.parametrize("kind", FORMATS)
def test_the_ending_of_a_file_is_its_format(here: Path, run: Run, kind: str) -> None:
    status, out, err = run("export", "one/summary.json", "--out", f"new/my.{kind}")
    assert (status, err) == (0, "")
    assert f"my.{kind}" in names(here / "new")
    assert Path(out.splitlines()[0]).name == f"my.{kind}"
    assert names(here / "one") == sorted(SAVED)


def test_several_formats_at_once(here: Path, run: Run) -> None:
    assert run("export", "one", "--format", "stl, glb,stl", "--out", "more").status == 0
    assert names(here / "more") == ["half.glb", "half.stl"]


def test_options_do_what_they_say(here: Path, run: Run) -> None:
    options = ["--half-width", "0.01", "--rows", "100", "--across", "7", "--piece"]
    assert run("export", "one", "--out", "a.npz", *options).status == 0
    assert run("export", "one", "--out", "b.npz").status == 0
    some, usual = np.load("a.npz"), np.load("b.npz")
    assert (some["half_width"] == 0.01).all()
    assert len(some["s"]) < len(usual["s"]) / 3
    assert not some["mirrored"].any() and usual["mirrored"].any()
    assert len(some["points"]) == 8 * len(np.unique(some["point_rows"]))
    assert (usual["closing"], some["closing"]) == (-1, 0)


def test_a_branch_is_a_series(here: Path, run: Run) -> None:
    status, out, err = run("export", "branch")
    assert (status, err) == (0, "")
    rows = ribbonopt.load("branch").rows
    stages = sorted({(row["stage"], row["branch"]) for row in rows})
    assert len(stages) == 2
    folder, common = here / "branch" / "exports", "column-stage{}-branch{}{}.{}"
    for stage, branch in stages:
        own = [row for row in rows if (row["stage"], row["branch"]) == (stage, branch)]
        for line in ("", "-line"):
            pvd = folder / common.format(stage + 1, branch, line, "pvd")
            sets = ET.parse(pvd).getroot().findall("Collection/DataSet")
            files = [f"column-{row['number']:04d}{line}.vtp" for row in own]
            assert [found.get("file") for found in sets] == files
            values = [row[row["parameter"]] for row in own]
            assert [float(found.get("timestep", "nan")) for found in sets] == values
            series = json.loads(pvd.with_suffix(".vtp.series").read_text())
            listed = [(item["name"], item["time"]) for item in series["files"]]
            assert listed == list(zip(files, values, strict=True))
            assert all((folder / file).is_file() for file in files)
    assert len(names(folder)) == 2 * len(rows) + 8
    assert out.splitlines()[-1] == f"and {2 * len(rows) + 4} files in branch/exports"
    # What was exported is no reason not to go on.
    command = ["continue", "branch/scene.yaml", "--out", "branch", "--resume", "--quiet"]
    assert run(*command).status == 0


def test_all_ribbons_of_a_branch_are_as_wide(here: Path, run: Run) -> None:
    assert run("export", "branch", "--format", "npz,glb", "--out", "wide").status == 0
    widths = {float(np.load(path)["half_width"][0]) for path in (here / "wide").glob("*.npz")}
    assert len(widths) == 1
    scales = {
        path.read_bytes().split(b'"color_largest": ')[1].split(b"}")[0]
        for path in (here / "wide").glob("*.glb")
    }
    assert len(scales) == 1


def test_time_is_what_grows() -> None:
    assert times_of([0.0, 2.5, 2.6], [0, 1, 2]) == [0.0, 2.5, 2.6]
    assert times_of([0.0, 2.5, 2.4], [0, 1, 2]) == [0, 1, 2]
    assert times_of([1.0, 1.0], [4, 5]) == [4, 5]


def test_a_batch_is_what_was_saved(here: Path, run: Run) -> None:
    status, out, err = run("export", "all", "--format", "json")
    assert (status, err) == (0, "")
    files = [Path(line) for line in out.splitlines()]
    assert [path.name for path in files] == [f"O'Brien & Söhne-000{i}.json" for i in (1, 2)]
    told = [json.loads(path.read_text())["about"] for path in files]
    assert [about["ribbon"] for about in told] == ["half, ribbon 1", "half, ribbon 2"]
    numbers = [json.loads(path.read_text())["numbers"] for path in files]
    assert numbers == [{"number": i, "law.epsilon": e} for i, e in ((1, 0.1), (2, 0.08))]


def test_other_equilibria_of_a_batch_are_exported_too(here: Path, run: Run) -> None:
    shutil.copytree(here / "one", here / "all/solutions/2/equilibria/2")
    status, out, err = run("export", "all", "--format", "json", "--out", "o")
    assert (status, err) == (0, "")
    files = [Path(line) for line in out.splitlines()]
    assert [path.stem[-7:] for path in files] == ["ne-0001", "ne-0002", "-0002-2"]
    told = json.loads(files[2].read_text())
    assert told["about"]["ribbon"] == "half, ribbon 2, equilibrium 2"
    assert told["numbers"] == {"number": 2, "law.epsilon": 0.08, "equilibrium": 2}


def test_of_a_batch_that_failed_nothing_is_exported(here: Path, run: Run) -> None:
    shutil.rmtree(here / "all" / "solutions")
    rows = (here / "all" / "rows.jsonl").read_text()
    (here / "all" / "rows.jsonl").write_text(rows.replace('"verified": true', '"verified": false'))
    status, out, err = run("export", "all")
    assert (status, out) == (2, "") and "none of its 2 ribbons was solved" in err


def test_python_takes_one_format_as_a_word_and_says_what_it_wants(here: Path) -> None:
    one = ribbonopt.load(here / "one")
    paths = ribbonopt.export(one, here / "o", "stl")
    assert [path.name for path in paths] == ["half.stl"]
    with pytest.raises(ModelError, match="expected a Solution, a Branch, a Batch or the folder"):
        ribbonopt.export([one], here / "p", "stl")  # type: ignore[arg-type]
    assert not (here / "p").exists()


def test_ribbons_that_were_not_saved_are_told(here: Path, run: Run) -> None:
    shutil.rmtree(here / "all" / "solutions" / "1")
    status, out, err = run("export", "all", "--format", "stl")
    assert status == 0 and out.splitlines() == ["all/exports/O'Brien & Söhne-0002.stl"]
    assert "left out: 1 of 2 ribbons" in err and "save: all" in err


def test_other_equilibria_are_exported_too(here: Path, run: Run) -> None:
    for ribbon, number in ((1, "2"), (2, "10")):
        shutil.copytree(here / "all/solutions" / str(ribbon), here / "one/equilibria" / number)
    status, out, _ = run("export", "one", "--format", "json")
    assert status == 0
    files = [Path(line) for line in out.splitlines()]
    assert [path.name for path in files] == ["half.json", "half-2.json", "half-3.json"]
    told = [json.loads(path.read_text()) for path in files]
    assert told[2]["about"]["ribbon"] == "half, equilibrium 3"
    epsilon = [found["summary"]["law"]["epsilon"] for found in told[1:]]
    assert epsilon == [0.1, 0.08]  # by their numbers


def test_a_failed_solve_is_exported_and_told(here: Path, run: Run) -> None:
    stop = "solver={type: newton, max_iterations: 1}"
    assert run("solve", "one/scene.yaml", "--set", stop, "--out", "bad", "--quiet").status == 3
    (folder,) = here.glob("bad*")
    assert not read_summary(folder)[0].ended.converged
    status, out, err = run("export", folder.name, "--format", ",".join(FORMATS))
    assert status == 0 and len(out.splitlines()) == 11
    assert "not verified" in err
    told = json.loads((folder / "exports" / "half.json").read_text())
    assert told["about"]["verified"] == "no" and told["summary"]["verified"] is False


BAD = {
    "unknown format": (["one", "--format", "vtp,xlsx"], "--format: found 'xlsx'"),
    "empty format": (["one", "--format", ""], "--format"),
    "no such folder": (["nowhere"], "nowhere: no such folder"),
    "no result": (["."], "folder without a result"),
    "nothing saved": (["none"], "no solution of this batch was saved"),
    "flat": (["one", "--half-width", "0"], "--half-width: found '0'"),
    "no width": (["one", "--half-width", "nan"], "--half-width"),
    "wider than numbers": (["one", "--half-width", "1e40"], "--half-width: found '1e40'"),
    "few rows": (["one", "--rows", "3"], "--rows: found 3"),
    "no strips": (["one", "--across", "0"], "--across: found '0'"),
    "no field": (["one", "--color", "u4"], "--color: found 'u4'"),
    "a vector": (["one", "--color", "n"], "--color: found 'n'"),
    "many points": (["one", "--rows", "50000", "--across", "99"], "--rows: found 50,000 rows"),
    "two formats in a file": (["one", "--out", "a.stl", "--format", "stl,obj"], "the file a.stl"),
    "unknown ending": (["one", "--out", "a.step"], "--out: found the ending .step"),
    "into a file": (["one", "--out", "one/summary.json/x"], "summary.json"),
    "no path": (["one", "--out", ""], "--out: found ''"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_is_refused_and_nothing_written(here: Path, run: Run, name: str) -> None:
    arguments, words = BAD[name]
    before = sorted(here.rglob("*"))
    status, out, err = run("export", *arguments)
    assert (status, out) == (2, "")
    assert words in err and "Traceback" not in err
    assert sorted(here.rglob("*")) == before


def test_damaged_results_are_refused(here: Path, run: Run) -> None:
    (here / "one" / "solution.npz").write_bytes(b"PK")
    status, out, err = run("export", "one")
    assert (status, out) == (2, "") and "solution.npz" in err
    assert names(here / "one") == sorted(SAVED)


def test_a_folder_in_the_place_of_a_file_stays(here: Path, run: Run) -> None:
    (here / "half.stl").mkdir()
    status, _, err = run("export", "one", "--format", "stl", "--out", ".")
    assert status == 2 and "half.stl: cannot be written" in err
    assert (here / "half.stl").is_dir() and names(here) == sorted(
        ["all", "branch", "half.stl", "none", "one"]
    )


def test_links_are_not_written_through(here: Path, run: Run) -> None:
    (here / "precious").write_text("mine")
    (here / "half.stl").symlink_to("precious")
    assert run("export", "one", "--out", "half.stl").status == 0
    assert (here / "precious").read_text() == "mine"
    assert not (here / "half.stl").is_symlink()


def test_in_python_as_on_the_command_line(here: Path, run: Run) -> None:
    assert run("export", "one", "--out", "a.obj").status == 0
    (path,) = ribbonopt.export(ribbonopt.load("one"), "b.obj")
    assert path.read_bytes() == (here / "a.obj").read_bytes()
    branch = ribbonopt.load("branch")
    paths = ribbonopt.export(branch, "points", ["stl"])
    assert len(paths) == len(branch)
    with pytest.raises(ModelError, match="format: found 'step', expected one of"):
        ribbonopt.export(branch, "points", ["step"])
    with pytest.raises(ModelError, match="expected one or several of vtp, glb"):
        ribbonopt.export(branch, "points")


def test_other_equilibria_at_hand_are_exported_too(here: Path) -> None:
    found = ribbonopt.load(here / "one")
    paths = ribbonopt.export(replace(found, others=(found,)), here / "two", ["stl"])
    assert [path.name for path in paths] == ["half.stl", "half-2.stl"]


@pytest.mark.parametrize("verb", ["export", "plot", "view"])
def test_of_an_empty_branch_nothing_is_made(here: Path, run: Run, verb: str) -> None:
    (here / "branch" / "branch.jsonl").write_text("")
    before = sorted(here.rglob("*"))
    status, out, err = run(verb, "branch")
    assert (status, out) == (2, "") and "nothing to" in err
    assert sorted(here.rglob("*")) == before
