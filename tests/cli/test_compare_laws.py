"""The verb `compare` with `--laws`: voices, files, exit statuses."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Run = Callable[..., Any]
FILES = ["laws.csv", "laws.json", "laws.png"]
PNG = b"\x89PNG\r\n"


@pytest.fixture
def arch(configs: Path) -> Path:
    return configs / "elastica_clamped.yaml"


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_scene_is_told_law_by_law(run: Run, arch: Path, tmp_path: Path) -> None:
    laws = ("--laws", "kirchhoff,variational,extensible", "--poisson", "0.3")
    status, out, err = run("compare", arch, *laws)
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("elastica-clamped under 3 laws; units Dw = L = 1")
    assert lines[2].split()[:2] == ["law", "numbers"]
    # The rows, and the differences, with the energy of elliptic integrals; digits that stand.
    assert any(line.startswith("sadowsky ") and " 10.55146" in line for line in lines)
    rod = [line for line in lines if line.startswith("kirchhoff ")]
    assert len(rod) == 2
    assert "B2 = 0.91, B3 = 1.4" in rod[0]
    assert " 9.6018" in rod[0]  # 0.91 times that
    assert "-9.0000" in rod[1]
    reason = next(line for line in lines if line.startswith("  extensible: left out"))
    assert "--width 0.05 --thickness 0.001" in reason
    assert list(tmp_path.iterdir()) == []


def test_json_is_one_object_without_curves(run: Run, arch: Path) -> None:
    status, out, err = run("compare", arch, "--laws", "kirchhoff", "--json")
    assert (status, err) == (0, "")
    assert out.count("\n") == 1
    found = json.loads(out)
    assert [row["law"] for row in found["rows"]] == ["sadowsky", "kirchhoff"]
    assert found["reference"] == "sadowsky"
    assert "curves" not in found["rows"][0]
    assert "Poisson's ratio" in found["rows"][1]["note"]


def test_files_hold_rows_and_curves(run: Run, arch: Path, tmp_path: Path) -> None:
    out = tmp_path / "result"
    assert run("compare", arch, "--laws", "kirchhoff", "--out", out, "--quiet") == (0, "", "")
    assert names(out) == FILES
    assert (out / "laws.png").read_bytes().startswith(PNG)
    with open(out / "laws.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["law"] for row in rows] == ["sadowsky", "kirchhoff"]
    found = json.loads((out / "laws.json").read_text(encoding="utf-8"))
    curves = found["rows"][1]["curves"]
    assert {"s", "r", "u2", "u3", "m2", "m3"} == set(curves)
    assert len({len(values) for values in curves.values()}) == 1
    # The result is replaced as a whole, and nothing else is.
    assert run("compare", arch, "--laws", "sadowsky", "--out", out, "--quiet") == (0, "", "")
    assert names(out) == FILES


def test_a_scene_with_a_continuation_is_followed(run: Run, configs: Path, tmp_path: Path) -> None:
    out = tmp_path / "result"
    short = "continuation={parameter: parameters.taper, from: 0.3, to: 0.5}"
    scene = configs / "tapered_strip.yaml"
    status, text, err = run("compare", scene, "--set", short, "--laws", "kirchhoff", "--out", out)
    assert (status, err) == (0, "")
    assert text.startswith("tapered-strip continued under 2 laws")
    assert "no special points" in text
    assert names(out) == FILES
    found = json.loads((out / "laws.json").read_text(encoding="utf-8"))
    ends = [law["points"][-1]["parameters.taper"] for law in found["laws"]]
    assert ends == [0.5, 0.5]


def test_its_solution_alone_is_compared_without(run: Run, configs: Path) -> None:
    scene = configs / "tapered_strip.yaml"
    status, text, _ = run("compare", scene, "--set", "continuation=null", "--laws", "kirchhoff")
    assert status == 0
    assert text.startswith("tapered-strip under 2 laws")


def test_a_study_is_compared_ribbon_by_ribbon(run: Run, study: Path, tmp_path: Path) -> None:
    out = tmp_path / "result"
    few = "name: few\nscene: scene.yaml\nsweep: {grid: {law.epsilon: [0.1, 0.09]}}\n"
    study.write_text(few)
    laws = ("--laws", "kirchhoff,sano", "--jobs", "1")
    status, text, err = run("compare", study, *laws, "--out", out)
    assert (status, err) == (0, "")
    lines = text.splitlines()
    assert "differences to their own law" in lines[0]
    assert any(line.startswith("own ") for line in lines)
    assert any(line.startswith("  sano: left out") for line in lines)
    assert names(out) == FILES


def test_nothing_solved_is_status_3(run: Run, arch: Path) -> None:
    sets = ("--set", "solver={type: newton, max_iterations: 1}", "--set", "guess=circle")
    status, out, err = run("compare", arch, *sets, "--laws", "sano")
    assert status == 3
    assert "no solution:" in out
    assert err == "ribbonopt: elastica-clamped: no law gave a verified solution\n"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--laws", "sadowski"), "expected some of all, kirchhoff"),
        (("--laws", "sadowski"), "did you mean 'sadowsky'?"),
        (("--laws", ""), "--laws: found ''"),
        (("--laws", "all", "--width", "-1"), "--width: found '-1'; expected a number > 0"),
        (("--laws", "all", "--poisson", "0.7"), "at most 0.5"),
        (("--laws", "all", "--edges", "free"), "expected straight or free for the start"),
        (("--laws", "all", "--jobs", "2"), "--jobs: is for studies"),
        (("--laws", "all", "--tolerances", "1e-3"), "--tolerances: compares formulations"),
        (("--width", "0.1"), "--width: is for laws"),
    ],
)
def test_unknown_words_are_status_2(
    run: Run, arch: Path, tmp_path: Path, words: tuple[str, ...], expected: str
) -> None:
    status, out, err = run("compare", arch, *words, "--out", tmp_path / "result")
    assert (status, out) == (2, "")
    assert expected in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_size_that_the_ribbon_says_is_status_2(run: Run, configs: Path) -> None:
    status, _, err = run(
        "compare", configs / "ribbon_si.yaml", "--laws", "all", "--thickness", "0.1"
    )
    assert status == 2
    assert "--thickness: the `ribbon` of ribbon-si has thickness = 0.0001" in err


def test_foreign_folders_are_left_alone(run: Run, arch: Path, tmp_path: Path) -> None:
    (tmp_path / "letters.txt").write_text("dear")
    status, _, err = run("compare", arch, "--laws", "kirchhoff", "--out", tmp_path)
    assert status == 2
    assert "letters.txt" in err
    assert names(tmp_path) == ["letters.txt"]
