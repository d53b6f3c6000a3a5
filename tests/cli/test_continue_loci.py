"""`ribbonopt continue` of loci: refusals, what is kept, from saved branches, after breaks."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from map_truth import ONE_CLAMP

Run = Callable[..., Any]
SCENE = """\
name: strip
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {angle: 28, d: 0.1, idle: 1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 1 - d], directors: {turns: [{y: angle*deg}]}}
guess: {force: [0, 0, -42], moment: [0, 4, 0]}
planar: true
tolerance: 1e-9
continuation:
"""
PAIR = "parameter: [parameters.angle, parameters.d]"
LOCUS = f"{PAIR}, of: fold, between: [28, 80]"
ANGLE, SHORTENING = "parameters.angle", "parameters.d"


def written(folder: Path, stage: str, text: str = SCENE) -> Path:
    path = folder / "strip.yaml"
    path.write_text(text + f"  {{{stage}}}\n")
    return path


BAD = {
    "equal parameters": (
        f"parameter: [{ANGLE}, {ANGLE}], of: fold, between: [28, 80], to: 1",
        ("continuation.parameter", "parameters.angle twice", "two different"),
    ),
    "unknown parameter": (
        f"parameter: [parameters.angel, {SHORTENING}], of: fold, between: [28, 80], to: 0.2",
        ("continuation.parameter", "parameters.angel", "did you mean parameters.angle?"),
    ),
    "parameter that is not used": (
        f"parameter: [{ANGLE}, parameters.idle], of: fold, between: [28, 80], to: 2",
        ("continuation.parameter", "parameters.idle changes nothing"),
    ),
    "first parameter that is not used": (
        f"parameter: [parameters.idle, {SHORTENING}], of: fold, between: [1, 2], to: 0.2",
        ("continuation.parameter", "parameters.idle changes nothing"),
    ),
    "of what": (f"{PAIR}, between: [28, 80], to: 0.2", ("continuation.parameter", "of: fold")),
    "of one parameter": (
        f"parameter: {SHORTENING}, of: fold, to: 0.2",
        ("continuation.of", "two parameters"),
    ),
    "no range": (f"{PAIR}, of: fold, to: 0.2", ("continuation", "between: [0, 60]")),
    "no range to speak of": (
        f"{PAIR}, of: fold, between: [3, 3], to: 0.2",
        ("continuation.between", "[3, 3]", "two different values"),
    ),
    "range of no scene": (
        f"{PAIR}, of: fold, between: [28, .inf], to: 0.2",
        ("continuation.between",),
    ),
    "values on both sides": (
        f"{LOCUS}, values: [0.05, 0.2]",
        ("continuation.values", "0.1", "both ways"),
    ),
    "begin elsewhere": (f"{LOCUS}, from: 0.2, to: 0.3", ("continuation.from", "0.2", "scene")),
    "branches of a locus": (f"{LOCUS}, to: 0.2, switch: true", ("continuation.switch",)),
    "no saved branch": (f"{LOCUS}, branch: nowhere, to: 0.2", ("continuation.branch", "nowhere")),
}


@pytest.mark.parametrize("fault", BAD)
def test_refused_with_one_message(run: Run, tmp_path: Path, fault: str) -> None:
    stage, words = BAD[fault]
    done = run("continue", written(tmp_path, stage), "--out", tmp_path / "out")
    assert done.status == 2
    assert all(word in done.err for word in words), done.err
    assert done.err.count("ribbonopt:") == 1
    assert len(done.err.splitlines()) == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("stage", "words"),
    [
        (f"{PAIR}, of: fold, between: [28, 30], to: 0.2", ("no fold", "28 to 30")),
        (f"{PAIR}, of: branch point, between: [28, 33], to: 0.2", ("no branch point",)),
        (f"{LOCUS}, number: 2, to: 0.2", ("no fold number 2", "fewer")),
    ],
)
def test_a_branch_without_it_is_kept(
    run: Run, tmp_path: Path, stage: str, words: tuple[str, ...]
) -> None:
    done = run("continue", written(tmp_path, stage), "--out", tmp_path / "out", "--quiet")
    assert done.status == 3
    assert all(word in done.err for word in words), done.err
    lines = (tmp_path / "out" / "branch.jsonl").read_text().splitlines()
    assert sum("row" in json.loads(line) for line in lines) > 2
    assert (tmp_path / "out" / "branch.csv").exists()


def test_broken_anywhere_it_goes_on_to_the_byte(run: Run, tmp_path: Path) -> None:
    scene, out = written(tmp_path, f"{LOCUS}, to: 0.2, largest: 0.05"), tmp_path / "out"
    done = run("continue", scene, "--out", out, "--plot", "angle:d")
    assert done.status == 0
    assert "locus of folds in parameters.angle and parameters.d" in done.out
    assert (out / "branch.png").exists()
    whole = (out / "branch.jsonl").read_text()
    lines = whole.splitlines(keepends=True)
    first = next(i for i, line in enumerate(lines) if json.loads(line).get("row", {}).get("of"))
    for cut in (first - 2, first - 1, first, first + 1):
        kept = "".join(lines[:cut]) + lines[cut][:100]
        (out / "branch.jsonl").write_text(kept)
        assert run("continue", scene, "--out", out, "--resume", "--quiet").status == 0
        assert (out / "branch.jsonl").read_text() == whole, cut


def test_from_a_saved_branch(run: Run, tmp_path: Path) -> None:
    alone = written(tmp_path, f"parameter: {ANGLE}, to: 33, stop: [fold]")
    saved = tmp_path / "saved"
    assert run("continue", alone, "--out", saved, "--quiet").status == 0
    stage = f"{LOCUS}, branch: {saved}, values: [0.15]"
    done = run("continue", written(tmp_path, stage), "--out", tmp_path / "out", "--json")
    assert done.status == 0
    rows = json.loads(done.out)["points"]
    assert {row["stage"] for row in rows} == {0}
    assert [row[SHORTENING] for row in (rows[0], rows[-1])] == [0.1, 0.15]
    assert rows[-1][ANGLE] == pytest.approx(ONE_CLAMP[0.15], rel=1e-9)
    other = written(tmp_path, stage, SCENE.replace("B3: 2", "B3: 3"))
    done = run("continue", other, "--out", tmp_path / "other")
    assert done.status == 2
    assert "another scene: its law" in done.err
    assert not (tmp_path / "other").exists()
