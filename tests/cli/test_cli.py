"""Every verb of the command line does what its help says, in all its voices."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from references import HALF_MOEBIUS

from ribbonopt.output.results import load_solution
from ribbonopt.output.summary import versions
from ribbonopt.scene import json_schema
from ribbonopt.version import VERSION

Run = Callable[..., Any]


@pytest.fixture
def half(configs: Path) -> Path:
    return configs / "moebius_half.yaml"


def test_solve_reports_and_writes_nothing_unasked(run: Run, half: Path, tmp_path: Path) -> None:
    status, out, err = run("solve", half)
    assert (status, err) == (0, "")
    assert "moebius-half: converged, verified" in out
    assert "43.4964080" in out
    assert list(tmp_path.iterdir()) == []


def test_report_prints_only_digits_that_stand(run: Run, half: Path) -> None:
    line = next(x for x in run("solve", half).out.splitlines() if "force n(0)" in x)
    numbers = [float(x) for x in line[line.index("(", 20) + 1 : line.rindex(")")].split(",")]
    printed = len(line.split(",")[-2].strip().rstrip(")").split(".")[1])
    for found, exact in zip(numbers[1:], HALF_MOEBIUS["n0"][1:], strict=True):
        assert abs(found - exact) <= 10.0**-printed


def test_solve_json_is_one_object(run: Run, half: Path) -> None:
    status, out, err = run("solve", half, "--json")
    summary = json.loads(out)
    assert (status, err) == (0, "")
    assert out.count("\n") == 1
    assert summary["verified"] is True
    assert summary["n0"] == pytest.approx(HALF_MOEBIUS["n0"], rel=1e-8)
    assert set(summary["timings"]) >= {"import", "build", "evaluate", "linear", "total"}


def test_solve_quiet_prints_nothing(run: Run, half: Path) -> None:
    assert run("solve", half, "--quiet") == (0, "", "")


def test_check_prints_versions_and_needs_no_scene(
    run: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        run("check", "--versions")
    out, err = capsys.readouterr()
    assert (ended.value.code, err) == (0, "")
    told = dict(line.split(maxsplit=1) for line in out.splitlines())
    assert told == versions()
    assert {"ribbonopt", "casadi", "numpy", "python", "kernel"} == told.keys()


def test_overrides_change_the_scene(run: Run, configs: Path) -> None:
    elastica = configs / "elastica_clamped.yaml"
    out = run("solve", elastica, "--set", "parameters.shortening=0.5", "--json").out
    assert json.loads(out)["n0"][2] == pytest.approx(-53.2741125962, rel=1e-8)


def test_overrides_add_up(run: Run, half: Path) -> None:
    sets = ["--set", "law={type: variational}", "--set", "law.delta=1e-1"]
    assert json.loads(run("solve", half, *sets, "--json").out)["law"]["delta"] == 0.1


def test_solve_out_writes_a_result(run: Run, half: Path, tmp_path: Path) -> None:
    status, out, _ = run("solve", half, "--out", tmp_path / "result")
    assert status == 0
    assert "written" in out
    files = sorted(path.name for path in (tmp_path / "result").iterdir())
    assert files == ["scene.yaml", "solution.npz", "summary.json"]
    assert load_solution(tmp_path / "result").verified
    assert [path.name for path in tmp_path.iterdir()] == ["result"]


def test_solve_plot_draws_pictures(run: Run, half: Path, tmp_path: Path) -> None:
    assert run("solve", half, "--plot", "--out", tmp_path / "result").status == 0
    pictures = [path for path in (tmp_path / "result").iterdir() if path.suffix == ".png"]
    assert len(pictures) >= 3
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in pictures)


def test_plot_draws_a_saved_result(run: Run, half: Path, tmp_path: Path) -> None:
    run("solve", half, "--out", tmp_path / "result")
    status, out, err = run("plot", tmp_path / "result", "--out", tmp_path / "pictures")
    assert (status, err) == (0, "")
    drawn = sorted((tmp_path / "pictures").iterdir())
    assert sorted(Path(line) for line in out.splitlines()) == drawn
    assert len(drawn) >= 3


def test_check_counts_and_says_what_is_skipped(run: Run, half: Path, tmp_path: Path) -> None:
    status, out, err = run("check", half)
    assert (status, err) == (0, "")
    assert "13 unknown numbers" in out
    assert "13 conditions" in out
    assert "boundary.end.d3.x" in out
    assert "skipped" in out
    assert list(tmp_path.iterdir()) == []


def test_check_json_is_one_object(run: Run, half: Path) -> None:
    found = json.loads(run("check", half, "--json").out)
    assert sum(found["unknowns"].values()) == len(found["conditions"]) == 13


def test_check_quiet_prints_nothing(run: Run, half: Path) -> None:
    assert run("check", half, "--quiet") == (0, "", "")


def test_check_knows_the_size_of_the_full_states(run: Run, configs: Path) -> None:
    found = json.loads(run("check", configs / "moebius_half_full.yaml", "--json").out)
    assert sum(found["unknowns"].values()) == 18


def test_schema_is_that_of_the_library(run: Run) -> None:
    status, out, err = run("schema")
    assert (status, err) == (0, "")
    assert json.loads(out) == json_schema()


@pytest.mark.parametrize("arguments", [[], ["fly"], ["solve"], ["solve", "a", "--fast"], ["plot"]])
def test_wrong_commands_are_bad_input(
    capsys: pytest.CaptureFixture[str], run: Run, arguments: list[str]
) -> None:
    with pytest.raises(SystemExit) as caught:
        run(*arguments)
    assert caught.value.code == 2
    assert "usage: ribbonopt" in capsys.readouterr().err


def process(*arguments: object, **keywords: Any) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "ribbonopt", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **keywords)


def test_module_is_a_command() -> None:
    assert process("--version").stdout == f"ribbonopt {VERSION}\n"


def test_process_solves(half: Path, tmp_path: Path) -> None:
    done = process("solve", half, "--json", cwd=tmp_path, env=environment())
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["status"] == "converged"
    assert list(tmp_path.iterdir()) == []


def test_process_fails_without_traceback(tmp_path: Path) -> None:
    done = process("solve", tmp_path / "none.yaml", cwd=tmp_path, env=environment())
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert "Traceback" not in done.stderr


def test_a_reader_that_leaves_early_is_no_error(half: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "ribbonopt", "solve", str(half)]
    done = subprocess.run(
        command, stdout=writer, stderr=subprocess.PIPE, text=True, check=False, env=environment()
    )
    os.close(writer)
    assert "Traceback" not in done.stderr


def environment() -> dict[str, str]:
    """Return the environment in which this very package is found from any folder."""
    root = str(Path(__file__).parents[2])
    paths = [root, os.environ.get("PYTHONPATH", "")]
    return os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, paths))}


def test_calls_from_python_leave_the_interpreter_alone(half: Path) -> None:
    code = (
        "import gc\nfrom ribbonopt.cli import main\n"
        f"main(['solve', {str(half)!r}, '--quiet'])\nassert gc.isenabled()"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment())
    assert done.returncode == 0, done.stderr


def test_what_a_process_prints_of_a_failure_arrives_whole() -> None:
    """The process leaves without ceremony: nothing of its output may stay behind."""
    command = [sys.executable, "-m", "ribbonopt", "solve", "nowhere.yaml", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert json.loads(done.stdout)["status"] == "bad_input"
    assert "nowhere.yaml: no such file" in done.stderr


def test_a_reader_that_leaves_before_a_failure_is_no_error() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    command = [sys.executable, "-m", "ribbonopt", "solve", "nowhere.yaml", "--json"]
    done = subprocess.run(command, stdout=writing, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writing)
    assert done.returncode == 141
    assert "Traceback" not in done.stderr
