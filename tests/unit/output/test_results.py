"""Results on disk: whole or not at all, read back to the last bit, and useful as guesses."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.errors import OutputError
from ribbonopt.output import exports
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.staging import staged_result
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
NAMES = ("r", "d1", "d2", "d3", "n", "m", "u")


@pytest.fixture(scope="module")
def half(solved: Solved) -> Solution:
    return solved("moebius_half")


@pytest.fixture
def saved(half: Solution, tmp_path: Path) -> Path:
    folder = tmp_path / "half"
    store(half, folder)
    return folder


def store(solution: Solution, folder: Path) -> None:
    with staged_result(folder) as stage:
        save_solution(solution, stage.folder)
        stage.commit()


def test_loading_gives_back_what_was_saved(half: Solution, saved: Path) -> None:
    loaded = load_solution(saved)
    s = np.linspace(0, 0.5, 33)
    for name in (*NAMES, "u2", "eta", "m1", "energy", "H"):
        np.testing.assert_array_equal(loaded.sample(s, name), half.sample(s, name))
    assert loaded.scene == half.scene
    assert loaded.status is half.status
    np.testing.assert_array_equal(loaded.multipliers, half.multipliers)
    assert loaded.verification.drift == half.verification.drift


@pytest.mark.parametrize("file", ["scene.yaml", "summary.json", "solution.npz"])
def test_any_file_stands_for_the_result(saved: Path, file: str) -> None:
    assert load_solution(saved / file).verified


def test_rows_in_the_archive_are_as_documented(half: Solution, saved: Path) -> None:
    with np.load(saved / "solution.npz") as data:
        s = data["s"]
        for name in NAMES:
            np.testing.assert_array_equal(data[name], half.sample(s, name))


def test_saved_solution_is_a_better_guess(configs: Path, half: Solution, saved: Path) -> None:
    scene = configs / "moebius_half.yaml"
    again = solve(load_scene(scene, [f"guess={{solution: {saved}}}"]))
    assert again.verified
    assert again.iterations < half.iterations
    np.testing.assert_allclose(again.n0, half.n0, rtol=1e-11, atol=1e-11)


def test_guess_may_come_from_another_mesh_states_and_law(configs: Path, saved: Path) -> None:
    overrides = [f"guess={{solution: {saved}}}", "law={type: variational, delta: 0.05}"]
    mesh = "transcription={type: collocation, scheme: radau, degree: 5, intervals: 17}"
    found = solve(load_scene(configs / "moebius_half_full.yaml", [*overrides, mesh]))
    assert found.verified, found.message


def test_a_solution_is_a_guess_in_process(configs: Path, half: Solution) -> None:
    scene = load_scene(configs / "moebius_half.yaml")
    assert prepare(scene).solve(guess=half).iterations < half.iterations


@pytest.mark.parametrize("file", ["scene.yaml", "summary.json", "solution.npz"])
def test_incomplete_results_are_refused(saved: Path, file: str) -> None:
    (saved / file).unlink()
    with pytest.raises(OutputError, match=f"{file} missing"):
        load_solution(saved)


@pytest.mark.parametrize("content", ["", "{", "[]", "{}", '{"status": "fine"}', "null"])
def test_damaged_summaries_are_refused(saved: Path, content: str) -> None:
    (saved / "summary.json").write_text(content)
    with pytest.raises(OutputError, match="is damaged"):
        load_solution(saved)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 nothing", b"text"])
def test_damaged_archives_are_refused(saved: Path, content: bytes) -> None:
    (saved / "solution.npz").write_bytes(content)
    with pytest.raises(OutputError, match="is damaged"):
        load_solution(saved)


def test_archives_of_another_scene_are_refused(saved: Path) -> None:
    scene = saved / "scene.yaml"
    scene.write_text(scene.read_text() + "states: full\n")
    with pytest.raises(OutputError, match="is damaged"):
        load_solution(saved)


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def test_results_are_replaced_whole(solved: Solved, saved: Path) -> None:
    (saved / "strains.png").write_bytes(b"an old picture")
    store(solved("helix"), saved)
    assert sorted(contents(saved)) == ["scene.yaml", "solution.npz", "summary.json"]
    assert load_solution(saved).scene.name == "helix"
    assert [path.name for path in saved.parent.iterdir()] == ["half"]


@pytest.mark.parametrize("victim", ["summarize", "dump"])
def test_failure_while_writing_leaves_the_old_result(
    solved: Solved, saved: Path, monkeypatch: pytest.MonkeyPatch, victim: str
) -> None:
    before = contents(saved)

    def fail(_: object) -> str:
        raise KeyboardInterrupt

    monkeypatch.setattr(exports, victim, fail)
    with pytest.raises(KeyboardInterrupt):
        store(solved("helix"), saved)
    assert contents(saved) == before
    assert [path.name for path in saved.parent.iterdir()] == ["half"]


def test_failure_while_replacing_leaves_the_old_result(
    solved: Solved, saved: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before, replace = contents(saved), Path.replace

    def full_disk(source: Path, target: Path) -> Path:
        if target == saved and (source / "summary.json").read_text().find("helix") > 0:
            raise OSError(28, "No space left on device")
        return replace(source, target)

    monkeypatch.setattr(Path, "replace", full_disk)
    with pytest.raises(OutputError, match="No space left"):
        store(solved("helix"), saved)
    assert saved.is_dir()
    assert contents(saved) == before


def test_foreign_files_are_never_touched(half: Solution, saved: Path) -> None:
    (saved / "thesis.tex").write_text("mine")
    before = contents(saved)
    with pytest.raises(OutputError, match=r"thesis\.tex"):
        store(half, saved)
    assert contents(saved) == before


def test_results_may_go_into_an_empty_folder(half: Solution, tmp_path: Path) -> None:
    store(half, tmp_path / "a" / "b")
    (tmp_path / "empty").mkdir()
    store(half, tmp_path / "empty")
    assert load_solution(tmp_path / "a" / "b").verified
    assert load_solution(tmp_path / "empty").verified


def test_what_is_not_committed_leaves_no_trace(half: Solution, tmp_path: Path) -> None:
    with staged_result(tmp_path / "result") as stage:
        save_solution(half, stage.folder)
    assert list(tmp_path.iterdir()) == []
