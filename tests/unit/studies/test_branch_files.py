"""Branch files: points as text and back, bit for bit; tables; lines that are not read."""

import csv
import json
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from ribbonopt.errors import OutputError
from ribbonopt.scene import Scene, dump_scene, loads_scene
from ribbonopt.scene.lens import value_at
from ribbonopt.scene.stages import stages_of
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.files import (
    FILE,
    SCENE,
    TABLE,
    BranchFolder,
    load_branch,
    rows_of,
)
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.stored import Stored, restored
from ribbonopt.studies.continuation.walk.branches import Nothing
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, POINT, Point

COLUMN = """\
name: column
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {P: 30, turn: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: {x: 0}, force: {y: 0, z: -P}, d3: {x: 0}, d1: {y: turn}, moment: {d1: 0}}
guess: {force: [0, 0, -30], moment: [0, 0, 0]}
tolerance: 1e-9
transcription: {type: collocation, degree: 6, intervals: 6}
record: {shortening: "1 - dot(r, ez)"}
continuation:
  - {parameter: parameters.P, from: 37, to: 40.2, switch: true, largest: 3}
  - {parameter: parameters.turn, values: [0, 0.05], largest: 0.02}
"""
MOEBIUS = """\
name: moebius
law: {type: regularized, epsilon: 0.1}
interval: [0, 1]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}}
  end:
    position: {y: 0, z: 0}
    directors: {d1: [-1, 0, 0], d2: [0, -1, 0], d3: [0, 0, 1]}
guess: {force: [0, 43, 43], moment: [0, 2.1, -8.6]}
tolerance: 1e-8
transcription: {type: collocation, scheme: gauss, degree: 8, intervals: 24}
continuation: {parameter: law.epsilon, to: 0.02, scale: log}
"""
#: a stage that ends before its goal, and two that begin where it ended
STOPPED = (
    COLUMN[: COLUMN.index("continuation:")]
    + """\
continuation:
  - {parameter: parameters.P, from: 30, to: 38, largest: 2, stop: [value > 33]}
  - {parameter: parameters.turn, to: 0.05, largest: 0.02}
  - {parameter: law.B3, to: 2.5, largest: 0.2}
"""
)
#: both ways from a start, with what crosses; special points and conditions that end a stage
WAYS = (
    COLUMN[: COLUMN.index("continuation:")]
    + """\
continuation:
  - {parameter: parameters.P, from: 39.6, to: [39.3, 39.8], switch: 2, stability: false}
  - {parameter: parameters.P, to: 45, stop: [shortening > 0.01, value > 40.1], stability: false}
  - {parameter: parameters.P, to: 39, stop: [branch point], stability: false}
"""
).replace("tolerance: 1e-9", "tolerance: 1e-7")
SCENES = {
    "branches and stages": COLUMN,
    "phases and meshes": MOEBIUS,
    "stopped": STOPPED,
    "ways": WAYS,
}
START = ["number", "stage", "branch", "origin", "parameter"]
HEAD = [
    *("kind", "negative", "error", "energy"),
    *("potential", "H0", "n0x", "n0y", "n0z", "m0x", "m0y", "m0z", "u1", "u2", "u3"),
]
TAIL = ["switches", "intervals", "iterations", "note"]

each_scene = pytest.mark.parametrize("name", SCENES)


class Followed(NamedTuple):
    """A branch as it was found, and as it was written."""

    scene: Scene
    points: list[Point]
    folder: Path

    @property
    def lines(self) -> list[str]:
        return (self.folder / FILE).read_text().splitlines(keepends=True)


@pytest.fixture(scope="module")
def followed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Followed]:
    """Return every scene's whole branch."""
    made = {}
    for name, text in SCENES.items():
        scene, path = loads_scene(text), tmp_path_factory.mktemp("branch")
        folder = BranchFolder(path, scene, resume=False)
        made[name] = Followed(scene, list(folder.follow(Continuation(scene))), path)
    return made


def copied(of: Followed, folder: Path, lines: list[str]) -> Path:
    """Return a folder with these lines in its branch file."""
    folder.mkdir()
    (folder / SCENE).write_text(dump_scene(of.scene))
    (folder / FILE).write_text("".join(lines))
    return folder


def kind_of(line: str) -> str:
    """Kind of the point in a line, or "ending"."""
    found = json.loads(line)
    return str(found["row"]["kind"]) if "row" in found else "ending"


# points


def stored(of: Followed) -> Iterator[tuple[Point, Point]]:
    """Every point and what comes back of it."""
    _, lines = load_branch(of.folder)
    history = Stored(Continuation(of.scene), lines)
    for point in of.points:
        same = history.points(point.stage, point.branch, point.kind)
        yield point, next(other for other in same if other.number == point.number)


@each_scene
def test_points_come_back_bit_for_bit(followed: dict[str, Followed], name: str) -> None:
    pairs = list(stored(followed[name]))
    assert len(pairs) > 5
    for point, back in pairs:
        for array, other in (
            (point.solution.dense.w, back.solution.dense.w),
            (point.solution.dense.p, back.solution.dense.p),
            (point.solution.mesh.widths, back.solution.mesh.widths),
            (point.tangent, back.tangent),
            (point.unknowns, back.unknowns),
        ):
            assert array.dtype == other.dtype == np.dtype(float)
            assert array.tobytes() == other.tobytes()
        for word in ("position", "sign", "step", "number", "stage", "branch", "kind"):
            assert getattr(back, word) == getattr(point, word), word
        assert dict(back.row) == dict(point.row)
        assert back.solution.sheets == point.solution.sheets
        layout, other = point.solution.dense.blocks.layout, back.solution.dense.blocks.layout
        assert layout.elements == other.elements


@each_scene
def test_solutions_come_back_with_their_scene(followed: dict[str, Followed], name: str) -> None:
    s = np.linspace(*followed[name].scene.interval, 7)
    for point, back in stored(followed[name]):
        solution, other = point.solution, back.solution
        assert dump_scene(other.scene) == dump_scene(solution.scene)
        assert other.energy == solution.energy
        for quantity in ("r", "n", "m", "u2"):
            found = other.sample(s, quantity)
            np.testing.assert_array_equal(found, solution.sample(s, quantity))


def test_meshes_and_phases_are_those_of_each_point(followed: dict[str, Followed]) -> None:
    solutions = [back.solution for _, back in stored(followed["phases and meshes"])]
    assert {solution.sheets for solution in solutions} == {(1, -1)}
    assert len({solution.mesh.elements for solution in solutions}) > 1


def test_points_are_found_by_stage_branch_and_kind(followed: dict[str, Followed]) -> None:
    of = followed["branches and stages"]
    history = Stored(Continuation(of.scene), load_branch(of.folder)[1])
    for stage, branch, kind in ((0, 0, POINT), (0, 0, BRANCH_POINT), (0, 2, POINT), (1, 0, POINT)):
        expected = [
            point.number
            for point in of.points
            if (point.stage, point.branch, point.kind) == (stage, branch, kind)
        ]
        found = history.points(stage, branch, kind)
        assert [point.number for point in found] == expected
        assert expected
    assert list(history.points(2, 0, POINT)) == []
    assert list(history.points(1, 0, BRANCH_POINT)) == []
    assert sorted(history.endings) == [(0, 0), (0, 1), (0, 2), (1, 0)]
    assert all(ending.reached for ending in history.endings.values())


def test_points_in_memory_are_those_of_the_folder(followed: dict[str, Followed]) -> None:
    of = followed["branches and stages"]
    plain = list(islice(Continuation(of.scene).resume(Nothing()), 6))
    for point, other in zip(plain, of.points, strict=False):
        assert dict(point.row) == dict(other.row)
        assert point.tangent.tobytes() == other.tangent.tobytes()


def test_chosen_points_are_restored(followed: dict[str, Followed]) -> None:
    of = followed["branches and stages"]
    special = next(point.number for point in of.points if point.kind == BRANCH_POINT)
    chosen = {0, special, of.points[-1].number}
    found = dict(restored(Continuation(of.scene), load_branch(of.folder)[1], chosen))
    assert found.keys() == chosen
    for point in of.points:
        if point.number in chosen:
            back, there = (
                one.sample(np.ones(1), "r") for one in (found[point.number], point.solution)
            )
            np.testing.assert_array_equal(back, there)


@each_scene
def test_each_parameter_has_its_column(followed: dict[str, Followed], name: str) -> None:
    of = followed[name]
    paths = list(dict.fromkeys(stage.parameter for stage in stages_of(of.scene)))
    for point in of.points:
        scene = point.solution.scene
        assert [point.row[path] for path in paths] == [value_at(scene, path) for path in paths]
        assert "value" not in point.row
    # where a stage ended its parameter stays
    ends = {}
    for point in of.points:
        for path, value in ends.items():
            if path != point.row["parameter"]:
                assert point.row[path] == value
        if point.branch == 0 and point.kind == POINT:
            ends[point.row["parameter"]] = value_of(point.row)
    assert len(ends) == len(paths)


@each_scene
def test_branches_of_before_are_read(
    followed: dict[str, Followed], tmp_path: Path, name: str
) -> None:
    # the parameter's column was called `value`
    of = followed[name]
    old = []
    for text in of.lines:
        line = json.loads(text)
        if "row" in line:
            paths = {stage.parameter for stage in stages_of(of.scene)}
            row = {"value": value_of(line["row"])}
            row |= {key: value for key, value in line["row"].items() if key not in paths}
            line["row"] = row
        old.append(json.dumps(line) + "\n")
    path = copied(of, tmp_path / "o", old[:6])
    begun = [value_of(row) for row in rows_of(load_branch(path)[1])]
    assert begun == [value_of(point.row) for point in of.points[: len(begun)]]
    assert len(begun) > 3
    continuation = Continuation(of.scene)
    list(BranchFolder(path, of.scene, resume=True).follow(continuation))
    assert continuation.ending.reached
    rows = rows_of(load_branch(path)[1])
    assert [value_of(row) for row in rows] == [value_of(point.row) for point in of.points]


# files


def test_each_line_is_there_before_its_point_is_given(
    followed: dict[str, Followed], tmp_path: Path
) -> None:
    of = followed["branches and stages"]
    folder = BranchFolder(tmp_path, of.scene, resume=False)
    points = folder.follow(Continuation(of.scene))
    for _, point in zip(range(4), points, strict=False):
        lines = (tmp_path / FILE).read_text().splitlines()
        assert json.loads(lines[-1])["row"]["number"] == point.number
    points.close()  # type: ignore[attr-defined]
    assert (tmp_path / FILE).read_text().splitlines(keepends=True) == of.lines[:4]
    assert (tmp_path / TABLE).read_text().count("\n") == 5


@each_scene
def test_columns_are_stable(followed: dict[str, Followed], name: str) -> None:
    of = followed[name]
    parameters = dict.fromkeys(stage.parameter for stage in stages_of(of.scene))
    expected = [*START, *parameters, *HEAD, *of.scene.record, *TAIL]
    with open(of.folder / TABLE, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    assert head == expected
    assert len(rows) == len(of.points)
    for cells, point in zip(rows, of.points, strict=True):
        assert list(point.row) == expected
        for column, cell in zip(head, cells, strict=True):
            assert read(cell) == point.row[column], column


def read(cell: str) -> Any:
    """Return what a cell says; only `switches`, as numbers here, are a list."""
    if cell == "":
        return Empty()
    try:
        return OneOrMany([json.loads(word) for word in cell.split()])
    except ValueError:
        return cell


class Empty:
    """An empty cell: nothing, no numbers, or no words."""

    def __eq__(self, other: object) -> bool:
        return other is None or other in ([], "")


class OneOrMany(list[float]):
    """Numbers of a cell, equal to a list of them or to the only one."""

    def __eq__(self, other: object) -> bool:
        return list(self) == (other if isinstance(other, list) else [other])


@each_scene
def test_lines_are_json_objects_with_a_row_or_an_ending(
    followed: dict[str, Followed], name: str
) -> None:
    of = followed[name]
    found = [json.loads(line) for line in of.lines]
    assert [list(line) for line in found if "row" in line] == [["row", "state"]] * len(of.points)
    endings = [line["ending"] for line in found if "row" not in line]
    keys = ["stage", "branch", "reached", "reason", "points"]
    assert all(list(end) == keys for end in endings)
    places = list(dict.fromkeys((point.stage, point.branch) for point in of.points))
    assert [(end["stage"], end["branch"]) for end in endings] == places
    assert rows_of(found) == [dict(point.row) for point in of.points]


@pytest.mark.parametrize("share", [0.01, 0.5, 0.999])
@pytest.mark.parametrize("count", [0, 1, 5])
def test_a_line_that_was_cut_short_is_not_read(
    followed: dict[str, Followed], tmp_path: Path, count: int, share: float
) -> None:
    of = followed["phases and meshes"]
    line = of.lines[count]
    part = line[: max(int(share * (len(line) - 1)), 1)]
    path = copied(of, tmp_path / "o", [*of.lines[:count], part])
    folder = BranchFolder(path, of.scene, resume=True)
    assert [row["number"] for row in folder.rows] == list(range(count))
    assert (path / FILE).read_text() == "".join(of.lines[:count])
    folder.close()


def test_a_line_without_its_end_is_read(followed: dict[str, Followed], tmp_path: Path) -> None:
    of = followed["phases and meshes"]
    path = copied(of, tmp_path / "o", [*of.lines[:3], of.lines[3].rstrip("\n")])
    folder = BranchFolder(path, of.scene, resume=True)
    assert len(folder.rows) == 4
    assert (path / FILE).read_text() == "".join(of.lines[:4])
    folder.close()


def test_special_points_after_the_last_regular_one_are_found_again(
    followed: dict[str, Followed], tmp_path: Path
) -> None:
    of = followed["branches and stages"]
    kinds = [kind_of(line) for line in of.lines]
    place = kinds.index(BRANCH_POINT)
    for more, kept in ((0, place), (1, place), (2, place + 2)):
        path = copied(of, tmp_path / f"o{more}", of.lines[: place + more])
        assert len(load_branch(path)[1]) == kept
        folder = BranchFolder(path, of.scene, resume=True)
        assert (path / FILE).read_text() == "".join(of.lines[:kept])
        # without doubles, and with the same numbers
        points = list(folder.follow(Continuation(of.scene)))
        assert [point.number for point in points] == list(range(kept, len(of.points)))
        assert (path / FILE).read_text() == "".join(of.lines)


def test_special_points_before_an_ending_stay(
    followed: dict[str, Followed], tmp_path: Path
) -> None:
    of = followed["branches and stages"]
    ending = [kind_of(line) for line in of.lines].index("ending")
    path = copied(of, tmp_path / "o", of.lines[: ending + 1])
    assert len(load_branch(path)[1]) == ending + 1


@each_scene
def test_going_on_after_every_line_is_the_same(
    followed: dict[str, Followed], tmp_path: Path, name: str
) -> None:
    of = followed[name]
    table = (of.folder / TABLE).read_bytes()
    for count in range(1, len(of.lines), {"stopped": 1, "ways": 12}.get(name, 6)):
        path = copied(of, tmp_path / str(count), of.lines[:count])
        continuation = Continuation(of.scene)
        list(BranchFolder(path, of.scene, resume=True).follow(continuation))
        assert continuation.ending.reached, count
        assert (path / FILE).read_text() == "".join(of.lines), count
        assert (path / TABLE).read_bytes() == table, count


@pytest.mark.parametrize("missing", [FILE, SCENE])
def test_no_branch(followed: dict[str, Followed], tmp_path: Path, missing: str) -> None:
    path = copied(followed["stopped"], tmp_path / "o", followed["stopped"].lines)
    (path / missing).unlink()
    with pytest.raises(OutputError, match="no branch"):
        load_branch(path)
