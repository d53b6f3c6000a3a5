"""The verb `stress`: voices, files, exit statuses."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.studies.stress.verdict import Judged, Verdict

Run = Callable[..., Any]
FEW = ("--quick", "--only", "tolerance", "--only", "smoothing")


@pytest.fixture
def bent(configs: Path) -> Path:
    return configs / "cantilever.yaml"


def test_a_table_files_and_what_does_not_apply(run: Run, bent: Path, tmp_path: Path) -> None:
    folder = tmp_path / "result"
    status, out, err = run("stress", bent, *FEW, "--out", folder)
    assert (status, err) == (0, "")
    lines = out.splitlines()
    rows = [line.split()[:3] for line in lines if line.startswith("tolerance  1e")]
    # To 1e-13 rounding may be too much.
    assert rows[:3] == [["tolerance", value, "solved"] for value in ("1e-02", "1e-06", "1e-10")]
    assert len(rows) == 4
    assert "  smoothing: law sadowsky is not smoothed by a number" in lines
    assert lines[-1].startswith("4 trials: ") and lines[-1].endswith("; none wrong.")
    assert sorted(p.name for p in folder.iterdir()) == ["stress.csv", "stress.json", "stress.png"]
    found = json.loads((folder / "stress.json").read_text(encoding="utf-8"))
    assert found["counts"]["wrong"] == 0 and found["counts"]["solved"] >= 3
    with open(folder / "stress.csv", encoding="utf-8", newline="") as file:
        verdicts = [row["verdict"] for row in csv.DictReader(file)]
    assert verdicts == [row["verdict"] for row in found["rows"]]


def test_anything_wrong_is_status_3(run: Run, bent: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wrong = Judged(Verdict.WRONG, "n0 is off by 3 times its bar", 1e-3, 3.0)
    monkeypatch.setattr("ribbonopt.studies.stress.run._judged", lambda *_: wrong)
    status, out, err = run("stress", bent, *FEW, "--json")
    assert status == 3
    assert out.count("\n") == 1
    found = json.loads(out)
    count = found["counts"]["wrong"]
    assert count >= 3
    assert {row["message"] for row in found["rows"] if row["verdict"] == "wrong"} == {wrong.reason}
    assert err == f"ribbonopt: cantilever: {count} of 4 trials wrong or crashed\n"


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (("--only", "noises"), "--only: found 'noises'; expected some of noise, "),
        (("--seconds", "0"), "--seconds: found '0'; expected a number > 0"),
        (("--set", "tolerances=1"), "did you mean"),
    ],
)
def test_unknown_words_are_status_2(
    run: Run, bent: Path, tmp_path: Path, words: tuple[str, ...], expected: str
) -> None:
    status, out, err = run("stress", bent, *words, "--out", tmp_path / "result")
    assert (status, out) == (2, "")
    assert expected in err
    assert list(tmp_path.iterdir()) == []
