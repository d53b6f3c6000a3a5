"""Options with numbers, and memory that runs out: one message, no traceback."""

from pathlib import Path

import pytest
from conftest import Run
from half_studies import SCENE

STUDY = "scene: s.yaml\n%s\n"


@pytest.fixture
def study(tmp_path: Path) -> Path:
    (tmp_path / "s.yaml").write_text(SCENE)
    return tmp_path / "study.yaml"


@pytest.mark.parametrize("number", ["1001", "1" + "0" * 9, "9" * 5000])
def test_jobs_and_repeats_are_limited(run: Run, study: Path, number: str) -> None:
    study.write_text(STUDY % "sweep: {grid: {law.epsilon: [0.1, 0.2]}}")
    for command, most in (
        (("batch", study, "--jobs"), "1,000"),
        (("bench", "s.yaml", "--repeat"), "10,000"),
    ):
        text = number if most == "1,000" else number + "0"
        status, out, err = run(*command, text)
        assert status == 2 and not out
        assert f"{command[-1]}: found" in err and f"expected at most {most}" in err
        assert len(err) < 300


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("time_limit: 1e10", "time_limit: found 10000000000.0, expected at most 1,000,000 seconds"),
        ("sweep: {grid: {law.epsilon: {from: 0, to: 1, count: 10000000000000}}}", "law.epsilon"),
        (
            "sweep: {random: {count: 1000000000, over: {law.epsilon: {uniform: [0, 1]}}}}",
            "1,000,000",
        ),
        (
            "sweep: {random: {count: 1%s, over: {a: {uniform: [0, 1]}}}}" % ("0" * 390),
            "at most 1,0",
        ),
        ("sweep: {random: {count: 2, over: {a: {uniform: [-1e300, 1e300]}}}}", "at most 1e+30"),
        (
            "sweep: {grid: {law.epsilon: {from: 0, to: 1, count: 1000000}, parameters.turn: "
            "{from: 0, to: 1, count: 1000000}}}",
            "more than 1,000,000 ribbons; make several studies of them",
        ),
    ],
)
def test_studies_are_limited_before_any_ribbon_is_made(
    run: Run, study: Path, words: str, found: str
) -> None:
    study.write_text(STUDY % words)
    status, out, err = run("batch", study, "--yes")
    assert status == 2 and not out and found in err
    assert not (study.parent / "results").exists()


@pytest.mark.parametrize(
    ("error", "status"),
    [(MemoryError(), 3), (RuntimeError(".../casadi.i:1: std::bad_alloc"), 3)],
)
def test_memory_that_runs_out_is_one_message(
    run: Run, study: Path, monkeypatch: pytest.MonkeyPatch, error: Exception, status: int
) -> None:
    def full(scene: object) -> None:
        raise error

    monkeypatch.setattr("ribbonopt.pipeline.prepared.solve", full)
    found = run("solve", study.parent / "s.yaml")
    assert found.status == status and not found.out
    assert (
        found.err.startswith("ribbonopt: there is not enough memory") and found.err.count("\n") == 1
    )


def test_other_faults_are_not_hidden(
    run: Run, study: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(scene: object) -> None:
        raise RuntimeError("something else")

    monkeypatch.setattr("ribbonopt.pipeline.prepared.solve", broken)
    with pytest.raises(RuntimeError, match="something else"):
        run("solve", study.parent / "s.yaml")
