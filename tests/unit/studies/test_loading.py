"""One loader for results, branches and batches: which is which, and what is there instead."""

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
from half_studies import loaded

from ribbonopt import Batch, Branch, Continuation, Solution, load, loads_scene, run_batch
from ribbonopt.attempt.structure import Structure
from ribbonopt.errors import OutputError, SceneError
from ribbonopt.output.results import save_solution
from ribbonopt.problem import Posed
from ribbonopt.studies.batch.files import BatchFolder
from ribbonopt.studies.continuation.files import BranchFolder
from ribbonopt.views import Style

BRANCH = """\
name: column
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {P: 36}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: {x: 0}, force: {y: 0, z: -P}, d3: {x: 0}, d1: {y: 0}, moment: {d1: 0}}
guess: {force: [0, 0, -36], moment: [0, 0, 0]}
tolerance: 1e-9
transcription: {type: collocation, degree: 6, intervals: 6}
continuation: {parameter: parameters.P, from: 36, to: 40, largest: 2}
"""
STUDY = """\
name: study
scene: scene.yaml
save: all
sweep: {grid: {law.epsilon: [0.1, 0.05, 0.02]}}
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a result, a branch and a batch, each as its verb writes it."""
    folder = tmp_path_factory.mktemp("results")
    scene = loads_scene(BRANCH)
    continuation = Continuation(scene)
    branch = BranchFolder(folder / "column-branch", scene, resume=False)
    points = list(branch.follow(continuation))
    branch.close()
    (folder / "column").mkdir()
    save_solution(points[0].solution, folder / "column")
    study = loaded(folder, STUDY)
    batch = BatchFolder(folder / "study", study, resume=False)
    for row in run_batch(study, jobs=1, folder=str(folder / "study")):
        batch.append(row)
    batch.close()
    return folder


def test_each_is_told_by_its_files(place: Path) -> None:
    assert isinstance(load(place / "column"), Solution)
    assert isinstance(load(place / "column-branch"), Branch)
    assert isinstance(load(place / "study"), Batch)
    assert isinstance(load(str(place / "study" / "solutions" / "2")), Solution)


@pytest.mark.parametrize(
    "file", ["column/solution.npz", "column-branch/branch.csv", "study/table.csv"]
)
def test_any_file_of_it_will_do(place: Path, file: str) -> None:
    assert type(load(place / file)) is type(load((place / file).parent))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("colum", ("no such folder", "did you mean {}/column?")),
        (
            "column-branch/none",
            ("no such folder", "written by ribbonopt solve, continue, batch or map"),
        ),
        ("none/there", ("no such folder",)),
        ("scene.yaml", ("is a file", "load_scene or load_study reads it")),
        ("", ("without a result", "it holds results: {0}/column, {0}/column-branch, {0}/study")),
        ("study/solutions", ("without a result", "study/solutions/1, ")),
    ],
)
def test_what_is_none_is_refused_with_what_is_there(
    place: Path, name: str, words: tuple[str, ...]
) -> None:
    with pytest.raises(OutputError) as refused:
        load(place / name)
    for word in words:
        assert word.format(place) in str(refused.value)


@pytest.mark.parametrize("ending", ["-branch", ".not-converged", ".wrong-solution"])
def test_a_branch_or_what_failed_is_meant_where_there_is_no_result(
    tmp_path: Path, ending: str
) -> None:
    (tmp_path / f"arch{ending}").mkdir()
    with pytest.raises(OutputError, match=rf"no such folder; .* did you mean .*arch{ending}\?"):
        load(tmp_path / "arch")


def test_what_is_built_for_one_solution_of_a_batch_serves_all(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    built = list[Posed]()
    of = Structure.of

    def noted(posed: Posed) -> Structure:
        built.append(posed)
        return of(posed)

    batch = Batch.load(place / "study")
    with monkeypatch.context() as patch:
        patch.setattr(Structure, "of", noted)
        kept = [batch[number] for number in batch.saved]
    assert (len(kept), len(built)) == (3, 1)
    for number, found in zip(batch.saved, kept, strict=True):
        assert isinstance(found, Solution)
        alone = load(place / "study" / "solutions" / str(number))
        assert isinstance(alone, Solution)
        assert found.energy == alone.energy and (found.n0 == alone.n0).all()
        assert found.scene == alone.scene


@pytest.mark.parametrize("file", ["comparison.json", "stress.json", "verification.json"])
def test_what_other_verbs_write_has_no_ribbons(tmp_path: Path, file: str) -> None:
    (tmp_path / file).write_text("{}")
    with pytest.raises(OutputError, match=f"{file.partition('.')[0][:6]}.*no ribbons; read {file}"):
        load(tmp_path)


@pytest.mark.parametrize("name", ["</script>", "ü 漢字", "a\nb", "..", "nul\0l"])
def test_odd_names_are_seen_and_do_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / "in").mkdir()
    monkeypatch.chdir(tmp_path / "in")
    with pytest.raises(OutputError) as refused:
        load(name)
    assert "\0" not in str(refused.value)


@pytest.mark.skipif(os.geteuid() == 0, reason="root reads all")
def test_a_folder_that_cannot_be_read_is_refused(tmp_path: Path) -> None:
    (tmp_path / "shut").mkdir(mode=0)
    with pytest.raises(OutputError):
        load(tmp_path / "shut")


def test_points_of_a_branch_come_back_as_they_were(place: Path) -> None:
    branch = load(place / "column-branch")
    assert isinstance(branch, Branch)
    lines = (place / "column-branch" / "branch.jsonl").read_text().splitlines()
    told = [row for line in lines if (row := json.loads(line).get("row"))]
    assert branch.rows == told and len(branch) == len(told) > 2
    for row, found in zip(told, branch, strict=True):
        assert found.verified and found.energy == pytest.approx(row["energy"], rel=1e-12)
    assert branch[-1].energy == branch[len(branch) - 1].energy
    assert [one.energy for one in branch[:2]] == [branch[0].energy, branch[1].energy]
    with pytest.raises(IndexError):
        branch[len(branch)]
    assert branch.reached and list(branch.endings) == [(0, 0)]
    (crossing,) = branch.special
    assert crossing["parameters.P"] == pytest.approx(4 * math.pi**2, rel=crossing["error"])


def test_a_continuation_in_memory_gives_the_same_branch(place: Path) -> None:
    written = load(place / "column-branch")
    assert isinstance(written, Branch)
    continuation = Continuation(written.scene)
    for found in (
        Branch.of(Continuation(written.scene)),
        Branch.of(continuation, list(continuation)),
    ):
        assert found.rows == written.rows and found.endings == written.endings
        np.testing.assert_array_equal(found[1].dense.w, written[1].dense.w)


def test_a_branch_that_was_cut_short_has_not_reached_its_goal(place: Path) -> None:
    written = load(place / "column-branch")
    assert isinstance(written, Branch)
    continuation = Continuation(written.scene)
    points = iter(continuation)
    found = Branch.of(continuation, [next(points)])
    assert (len(found), found.reached, found.endings) == (1, False, {})
    assert "1 point along" in repr(found) and "goal not reached" in repr(found)


def test_rows_of_a_batch_and_what_was_saved(place: Path) -> None:
    batch = load(place / "study")
    assert isinstance(batch, Batch)
    assert [row["number"] for row in batch] == batch.saved == [1, 2, 3] and len(batch) == 3
    assert batch.inputs == ("law.epsilon",) and batch.failed == []
    for row in batch:
        found = batch[row["number"]]
        assert isinstance(found, Solution)
        assert found.scene.law.epsilon == row["law.epsilon"]  # type: ignore[union-attr]
        assert found.energy == pytest.approx(row["energy"], rel=1e-12)
    for number in (0, 4, -1):
        with pytest.raises(KeyError, match="no row of that number"):
            batch[number]


def test_a_batch_in_memory_has_the_same_rows_and_says_what_was_not_saved(
    place: Path, tmp_path: Path
) -> None:
    written = load(place / "study")
    assert isinstance(written, Batch)
    study = loaded(tmp_path, STUDY)
    found = Batch.of(study, reversed(written.rows))
    assert found.rows == written.rows and found.columns == written.columns
    with pytest.raises(OutputError, match="the solution of ribbon 2 was not saved"):
        found[2]
    empty = Batch.of(study, [])
    assert len(empty) == 0 and "0 of 3 ribbons" in repr(empty)
    assert len(empty.to_pandas()) == 0


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [("epsilom", "energy", "did you mean 'epsilon'"), ("epsilon", "nothing_at_all", "expected a")],
)
def test_columns_that_there_are_none_of(place: Path, x: str, y: str, words: str) -> None:
    batch = load(place / "study")
    assert isinstance(batch, Batch)
    with pytest.raises(SceneError, match=words):
        batch.plot(x, y)


def test_a_word_that_means_two_columns_is_refused() -> None:
    from ribbonopt.studies.columns import column_of

    names = ["a.force.x", "b.force.x", "c.y"]
    assert column_of("c.y", names) == column_of("y", names) == "c.y"
    assert column_of("a.force.x", names) == "a.force.x"
    with pytest.raises(SceneError, match=r"may be each of a\.force\.x, b\.force\.x"):
        column_of("force.x", names)


def test_figures_show_the_columns_that_were_asked_for(place: Path) -> None:
    branch, batch = load(place / "column-branch"), load(place / "study")
    assert isinstance(branch, Branch) and isinstance(batch, Batch)
    axes = branch.plot("P", "energy").axes[0]
    drawn = np.concatenate([line.get_xdata() for line in axes.lines])  # type: ignore[arg-type]
    values = [row["parameters.P"] for row in branch.rows]
    assert (drawn.min(), drawn.max()) == pytest.approx((min(values), max(values)))
    (cloud,) = (
        c for c in batch.plot("epsilon", "energy").axes[0].collections if len(c.get_offsets())
    )
    found = sorted(map(tuple, np.asarray(cloud.get_offsets())))
    assert found == sorted((row["law.epsilon"], row["energy"]) for row in batch)


def test_figures_have_the_style_that_was_asked_for(place: Path) -> None:
    branch, batch = load(place / "column-branch"), load(place / "study")
    assert isinstance(branch, Branch) and isinstance(batch, Batch)
    style = Style(width=3.35)
    for figure in (
        branch.plot("P", "energy", style),
        batch.plot("epsilon", "energy", style),
        branch[0].plot("strains", style),
    ):
        assert figure.get_size_inches()[0] == pytest.approx(3.35)
