"""The verbs `compare` and `bench`: voices, files, exit statuses."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Run = Callable[..., Any]
SMALL = ("--formulations", "inverted", "--transcriptions", "gauss")


@pytest.fixture
def half(configs: Path) -> Path:
    return configs / "moebius_half.yaml"


def test_compare_prints_a_table_and_findings(run: Run, half: Path, tmp_path: Path) -> None:
    status, out, err = run("compare", half, *SMALL, "--tolerances", "1e-4,1e-6")
    assert (status, err) == (0, "")
    lines = out.splitlines()
    assert any(line.startswith("inverted, reduced, gauss") for line in lines)
    assert any(line.startswith("inverted, full, gauss") for line in lines)
    assert lines[-2].startswith("To 1e-04: inverted + gauss ")
    assert lines[-1].startswith("To 1e-06: inverted + gauss ")
    assert list(tmp_path.iterdir()) == []


def test_compare_json_is_one_object(run: Run, half: Path) -> None:
    status, out, err = run("compare", half, *SMALL, "--tolerances", "1e-4", "--json")
    assert (status, err) == (0, "")
    assert out.count("\n") == 1
    found = json.loads(out)
    assert found["tolerances"] == [1e-4]
    assert found["cheapest"][0]["pair"].startswith("inverted, ")


def test_compare_writes_whole_results(run: Run, half: Path, tmp_path: Path) -> None:
    out = tmp_path / "result"
    status = run("compare", half, *SMALL, "--tolerances", "1e-4", "--out", out, "--quiet")
    assert status == (0, "", "")
    files = sorted(path.name for path in out.iterdir())
    assert files == ["comparison.csv", "comparison.json", "comparison.png"]
    assert [path.name for path in tmp_path.iterdir()] == ["result"]
    with open(out / "comparison.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["status"] for row in rows} == {"converged"}


def test_foreign_folders_are_left_alone(run: Run, half: Path, tmp_path: Path) -> None:
    (tmp_path / "letters.txt").write_text("dear")
    status, _, err = run("compare", half, *SMALL, "--out", tmp_path)
    assert status == 2
    assert "letters.txt" in err
    assert [path.name for path in tmp_path.iterdir()] == ["letters.txt"]


def test_failures_are_rows(run: Run, half: Path) -> None:
    both = ("--formulations", "inverted,energy", "--transcriptions", "gauss")
    sets = ("--set", "law={type: regularized, epsilon: 1e-2}")
    status, out, _ = run("compare", half, *sets, *both, "--tolerances", "1e-2")
    assert status == 0
    assert "failed:" in out
    assert "energy, reduced, gauss; energy, full, gauss" in out


def test_nothing_solved_is_status_3(run: Run, half: Path) -> None:
    sets = ("--set", "solver={type: newton, max_iterations: 1}")
    status, out, err = run("compare", half, *sets, *SMALL)
    assert status == 3
    assert "no pair gets there" in out
    assert err == "ribbonopt: moebius-half: no pair gave a verified solution\n"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--formulations", "inverted,inverse"), "expected some of inverted, algebraic"),
        (("--transcriptions", "simpson"), "expected some of gauss, radau, lobatto"),
        (("--tolerances", "1e-6,small"), "expected numbers between 0 and 1"),
        (("--tolerances", "10"), "expected numbers between 0 and 1"),
    ],
)
def test_unknown_words_are_status_2(
    run: Run, half: Path, tmp_path: Path, words: tuple[str, ...], expected: str
) -> None:
    status, out, err = run("compare", half, *words, "--out", tmp_path / "result")
    assert (status, out) == (2, "")
    assert expected in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_bench_measures_orders(run: Run, half: Path, tmp_path: Path) -> None:
    out = tmp_path / "result"
    status, text, err = run("bench", half, *SMALL, "--quick", "--repeat", "1", "--out", out)
    assert (status, err) == (0, "")
    assert "order" in text
    files = sorted(path.name for path in out.iterdir())
    assert files == ["benchmark.csv", "benchmark.json", "benchmark.png"]


@pytest.mark.parametrize("repeat", ["0", "many"])
def test_bench_wants_a_number_of_repeats(run: Run, half: Path, repeat: str) -> None:
    status, _, err = run("bench", half, "--repeat", repeat)
    assert status == 2
    assert "--repeat" in err
