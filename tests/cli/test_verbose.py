"""`solve --verbose`: what each step took, and what was skipped and why."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from ribbonopt.output.steps import steps_of

Run = Callable[..., tuple[int, str, str]]
HALF = Path(__file__).resolve().parents[2] / "configs" / "moebius_half.yaml"


def test_steps_and_reasons_are_told_once(run: Run) -> None:
    code, out, _ = run("solve", HALF, "--verbose")
    assert code == 0
    table = out[out.index("  steps ") :]
    assert re.search(r"newton, gauss 6 on 10 intervals +\d+ +\d+\.\d\d\n", table)
    assert "in all" in table and "pictures" in table and "files (no --out)" in table
    assert out.count("second derivatives (nothing is minimised)") == 1
    # The line of steps of a plain report is not there again.
    assert not re.search(r"intervals(?: in \d phases)?, \d+ iterations \(", out)


@pytest.mark.parametrize("other", ["--json", "--quiet"])
def test_what_prints_nothing_else_is_refused(run: Run, other: str) -> None:
    code, out, err = run("solve", HALF, "--verbose", other)
    assert code == 2
    assert f"found {other}" in (json.loads(out)["message"] if other == "--json" else err)


def test_rows_add_up() -> None:
    """What no step has is what is left of the whole."""
    path = [{"step": "one", "seconds": 0.5}, {"step": "two", "iterations": 3, "seconds": 0.25}]
    timings = {"import": 2.0, "build": 0.125, "rest": 0.9, "total": 1.125}
    summary = {"path": path, "timings": timings, "skipped": ["this (because)"]}
    text = steps_of(summary, drawn=False, written=True)
    found = [float(line.split()[-1]) for line in text.splitlines()[1:7]]
    assert found == [2000.0, 125.0, 500.0, 250.0, 250.0, 3125.0]
    assert "this (because)" in text and "no --plot" in text and "no --out" not in text
