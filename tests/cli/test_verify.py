"""The verb `verify`: voices, files, exit statuses."""

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

Run = Callable[..., Any]
ROWS = """\
scenes:
  tip:
    law: {type: sadowsky}
    boundary:
      start: {support: clamped, position: [0, 0, 0], directors: identity}
      end: {support: free, force: [1, 0, 0]}
    guess: {force: [1, 0, 0], moment: [0, 1, 0]}
    tolerance: 1.0e-10
rows:
  - {scene: tip, quantity: n0.x, value: 1, digits: exact, source: the load}
  - {scene: tip, quantity: r(1).x, value: 0.3017207738, digits: 10, source: elliptic integrals}
"""


def test_shipped_rows_are_confirmed(run: Run, tmp_path: Path) -> None:
    status, out, err = run("verify", "half/n0.*", "helix_held")
    assert (status, err) == (0, "")
    assert out.splitlines()[0].split()[:4] == ["scene", "quantity", "source", "ours"]
    assert " rows within their bars" in out
    assert list(tmp_path.iterdir()) == []


def test_own_rows_and_their_files(run: Run, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text(ROWS)
    assert run("verify", "--file", "own.yaml", "--out", "out", "--quiet") == (0, "", "")
    files = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert files == ["verification.csv", "verification.json", "verification.md"]
    with open(tmp_path / "out" / "verification.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["quantity"], row["status"]) for row in rows] == [
        ("n0.x", "ok"),
        ("r(1).x", "ok"),
    ]
    found = json.loads((tmp_path / "out" / "verification.json").read_text())
    assert found["verified"] and found["counts"] == {"ok": 2}


def test_a_row_that_is_off_is_told_and_fails(run: Run, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text(ROWS.replace("value: 1,", "value: 1.0000001,"))
    status, out, err = run("verify", "--file", "own.yaml")
    assert status == 3
    assert "row 1, tip n0.x: " in out
    assert err == "ribbonopt: own.yaml: 1 of 2 rows are not confirmed\n"
    status, out, _ = run("verify", "--file", "own.yaml", "--json")
    found = json.loads(out)
    assert (status, found["status"], found["verified"]) == (3, "off", False)
    assert [row["status"] for row in found["rows"]] == ["off", "ok"]


def test_bad_files_are_told_with_line_and_key(run: Run, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text(ROWS.replace("quantity: n0.x", "quantity: n0.w"))
    status, out, err = run("verify", "--file", "own.yaml")
    assert (status, out) == (2, "")
    assert err.startswith("ribbonopt: own.yaml, line 10, rows.0.quantity: found 'n0.w'")
    assert run("verify", "--file", "none.yaml").err == "ribbonopt: none.yaml: no such file\n"


def test_a_pattern_that_names_no_row(run: Run) -> None:
    status, _, err = run("verify", "halv")
    assert status == 2
    assert "did you mean 'half'?" in err


def test_a_scene_that_does_not_hold_together(run: Run, tmp_path: Path) -> None:
    bad = ROWS.replace("support: free, force: [1, 0, 0]", "position: {x: 0}")
    (tmp_path / "own.yaml").write_text(bad)
    status, _, err = run("verify", "--file", "own.yaml")
    assert status == 2
    assert err.startswith("ribbonopt: own.yaml: row 1 (tip n0.x): ")
