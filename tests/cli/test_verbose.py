"""What verbs say in short, and with `--verbose`: what each step took, what was skipped and why."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from batches import STUDY
from branches import COLUMN, SHORT, written
from half_studies import SCENE
from references import HALF_MOEBIUS

from ribbonopt.output.steps import steps_of

Run = Callable[..., tuple[int, str, str]]
CONFIGS = Path(__file__).resolve().parents[2] / "configs"
HALF = CONFIGS / "moebius_half.yaml"


def rows_of(out: str) -> dict[str, tuple[tuple[str, ...], float]]:
    """Return numbers as they are written, and bars, of the rows of a report by their names."""
    rows = re.findall(r"^  (.{25})(\(?)([-\d.e+, ]+?)\)?  \+- (\S+)$", out, re.MULTILINE)
    return {name.strip(): (tuple(v.split(", ")), float(bar)) for name, _, v, bar in rows}


def test_a_solve_is_told_in_about_eight_lines(run: Run) -> None:
    _, out, err = run("solve", HALF, "--out", "result")
    lines = out.splitlines()
    assert len(lines) <= 9 and err == ""
    assert lines[0] == "moebius-half: converged, verified"
    assert lines[-1] == "  written: result: scene.yaml, solution.npz, summary.json"
    assert "  half twists              1" in lines
    assert "  stability                stable" in lines
    found = rows_of(out)
    assert len(found) == 4
    for name, key in (("force n(0), lab frame", "n0"), ("moment m(0), lab frame", "m0")):
        values, bar = found[name]
        assert 0 < bar < 1e-8
        for text, truth in zip(values, HALF_MOEBIUS[key], strict=True):
            rounded = 0.5 * 10.0 ** -len(text.partition(".")[2]) if "." in text else 0.0
            assert abs(float(text) - truth) <= bar + rounded
    for word in ("skipped", "time in ms", "unknowns", "iterations", "drift"):
        assert word not in out


def test_steps_and_reasons_are_told_once(run: Run) -> None:
    code, out, _ = run("solve", HALF, "--verbose")
    assert code == 0
    table = out[out.index("  steps ") :]
    assert re.search(r"newton, gauss 6 on 10 intervals +\d+ +\d+\.\d\d\n", table)
    assert re.search(r"stability of the answer: .* \d+\.\d\d\n", table)
    assert "in all" in table and "pictures" in table and "files (no --out)" in table
    assert out.count("second derivatives (nothing is minimised)") == 1
    # The line of steps of a plain report is not there again.
    assert not re.search(r"intervals(?: in \d phases)?, \d+ iterations \(", out)


def test_at_length_all_is_said_that_is_said_in_short(run: Run) -> None:
    short = run("solve", CONFIGS / "three_supports.yaml")[1]
    long = run("solve", CONFIGS / "three_supports.yaml", "--verbose")[1]
    assert rows_of(short).items() <= rows_of(long).items()
    assert "  drift along the ribbon " in long and "unknowns" in long
    # What the support in the middle carries is of the answer; loads and ends are not.
    assert "  carried at supports.0    (12.91033555" in short
    assert "on the ribbon (" in long and "on the ribbon (" not in short


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        ("elastica_shortening", "unstable, 1 direction"),
        ("ribbon_si", "stable among disturbances with its symmetry"),
        ("moebius_regularized", "not known: the law regularized has no energy"),
    ],
)
def test_stability_is_told_in_words(run: Run, scene: str, words: str) -> None:
    out = run("solve", CONFIGS / f"{scene}.yaml")[1]
    assert f"\n  {'stability':<25}{words}\n" in out


def test_what_did_not_converge_has_no_stability(run: Run) -> None:
    scene = CONFIGS / "moebius_half.yaml"
    code, out, err = run("solve", scene, "--set", "solver={type: newton, max_iterations: 2}")
    assert code == 3 and out.splitlines()[0] == "moebius-half: max iterations"
    assert "the iterations ran out" in out.splitlines()[1] and "the iterations ran out" in err
    assert "stability" not in out


@pytest.mark.parametrize("other", ["--json", "--quiet"])
@pytest.mark.parametrize("verb", ["solve", "continue", "batch"])
def test_what_prints_nothing_else_is_refused(run: Run, verb: str, other: str) -> None:
    code, out, err = run(verb, HALF, "--verbose", other)
    assert code == 2
    assert f"found {other}" in (json.loads(out)["message"] if other == "--json" else err)
    assert not Path("results").exists()


def test_a_branch_says_what_it_took(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    short = run("continue", scene, "--out", "o")[1]
    code, long, _ = run("continue", scene, "--out", "p", "--verbose")
    assert code == 0
    assert long.startswith(short.replace(" o: ", " p: "))
    more = long[len(short) :]
    rows = [
        json.loads(line).get("row")
        for line in (tmp_path / "p/branch.jsonl").read_text().splitlines()
    ]
    iterations = sum(row["iterations"] for row in rows if row)
    assert f"    stage 1: {iterations} iterations " in more
    assert re.search(r"    this run in all: \d+\.\d s\n", more)
    assert "second derivatives (nothing is minimised)" in more


def test_a_batch_says_what_it_took(run: Run, tmp_path: Path) -> None:
    (tmp_path / "study.yaml").write_text(STUDY.replace("count: 30", "count: 4"))
    (tmp_path / "scene.yaml").write_text(SCENE)
    code, out, _ = run("batch", "study.yaml", "--jobs", "1", "--out", "o", "--verbose")
    assert code == 0
    rows = [json.loads(line) for line in (tmp_path / "o/rows.jsonl").read_text().splitlines()]
    assert out.splitlines()[0].endswith(": 4 ribbons: 4 converged; all verified")
    low, high = re.findall(r"^  energy (\S+) to (\S+); relative error at most", out, re.M)[0]
    energies = [row["energy"] for row in rows]
    assert (float(low), float(high)) == pytest.approx((min(energies), max(energies)), rel=1e-5)
    assert f"{sum(row['seconds'] for row in rows):.1f} s of solving" in out
    own = sum(row["start"] == "own" for row in rows)
    assert 0 < own < 4
    begun = re.findall(r"\n    begun from: (.*)\n", out)[0].split(", ")
    assert sorted(begun) == [f"another ribbon ({4 - own})", f"own ({own})"]


def test_rows_add_up() -> None:
    """What no step has is what is left of the whole."""
    path = [{"step": "one", "seconds": 0.5}, {"step": "two", "iterations": 3, "seconds": 0.25}]
    timings = {"import": 2.0, "build": 0.125, "rest": 0.9, "total": 1.125}
    summary = {"path": path, "timings": timings, "skipped": ["this (because)"]}
    text = steps_of(summary, drawn=False, written=True)
    found = [float(line.split()[-1]) for line in text.splitlines()[1:7]]
    assert found == [2000.0, 125.0, 500.0, 250.0, 250.0, 3125.0]
    assert "this (because)" in text and "no --plot" in text and "no --out" not in text
    judged = steps_of(summary, drawn=False, written=True, judged=0.5).splitlines()[6:8]
    assert [float(line.split()[-1]) for line in judged] == [500.0, 3625.0]
