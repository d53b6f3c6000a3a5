"""Rows and branches that are not as they were written: the line is named, and nothing is lost."""

import base64
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from half_studies import loaded

from ribbonopt.errors import OutputError
from ribbonopt.scene import Scene, dump_scene, loads_scene
from ribbonopt.studies.batch.files import BatchFolder, load_batch
from ribbonopt.studies.batch.study import Study
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.files import BranchFolder, load_branch, rows_of
from ribbonopt.studies.continuation.stored import restored

STUDY = "scene: scene.yaml\nsweep: {grid: {law.epsilon: [0.1, 0.2, 0.3, 0.4]}}\n"
ROW = {"scene": "half", "status": "converged", "verified": True, "energy": 1.5, "message": ""}


# rows


@pytest.fixture
def study(tmp_path: Path) -> Study:
    return loaded(tmp_path, STUDY)


@pytest.fixture
def batch(study: Study, tmp_path: Path) -> Path:
    """Return a folder of four rows."""
    folder = BatchFolder(tmp_path / "out", study, resume=False)
    for ribbon in study.ribbons:
        folder.append({"number": ribbon.number, **ribbon.inputs, **ROW})
    folder.close()
    return folder.folder


def lines_of(path: Path) -> list[bytes]:
    return path.read_bytes().splitlines(keepends=True)


def refusal(read: Callable[[], object]) -> str:
    with pytest.raises(OutputError) as refused:
        read()
    return str(refused.value)


@pytest.mark.parametrize("place", [0, 1, 3])
@pytest.mark.parametrize("spoil", ["torn", "glued", "zeros", "text", "empty object"])
def test_a_bad_row_is_named_and_the_rest_is_kept(
    batch: Path, study: Study, place: int, spoil: str
) -> None:
    path = batch / "rows.jsonl"
    lines = lines_of(path)
    bad = {
        "torn": lines[place][:40] + b"\n",
        "glued": lines[place][:40] + lines[place],
        "zeros": bytes(50) + b"\n",
        "text": b"not a row\n",
        "empty object": b"{}\n",
    }[spoil]
    path.write_bytes(b"".join([*lines[:place], bad, *lines[place + 1 :]]))
    before = path.read_bytes()
    for read in (
        lambda: load_batch(batch),
        lambda: BatchFolder(batch, study, resume=True),
    ):
        message = refusal(read)
        assert message.startswith(f"{path}, line {place + 1}: is damaged (")
        assert "remove this line: the others are kept" in message
        assert path.read_bytes() == before
    # what the message says
    path.write_bytes(b"".join(lines[:place] + lines[place + 1 :]))
    folder = BatchFolder(batch, study, resume=True)
    assert sorted(folder.known) == [n for n in (1, 2, 3, 4) if n != place + 1]
    folder.close()


@pytest.mark.parametrize("tail", [b'{"number": 4, "sta', b"{", bytes(4096), b'{"a": \xc3'])
def test_a_torn_last_row_is_cut(batch: Path, study: Study, tail: bytes) -> None:
    path = batch / "rows.jsonl"
    lines = lines_of(path)
    path.write_bytes(b"".join(lines[:3]) + tail)
    assert [row["number"] for row in load_batch(batch)[1]] == [1, 2, 3]
    folder = BatchFolder(batch, study, resume=True)
    folder.append({"number": 4, "law.epsilon": 0.4, **ROW})
    folder.close()
    assert [row["number"] for row in load_batch(batch)[1]] == [1, 2, 3, 4]
    assert path.read_bytes() == b"".join(lines)


@pytest.mark.parametrize("tail", [b"%PDF-1.4", b"[[[[", b"NaN"])
def test_what_is_no_row_that_was_begun_is_not_cut(batch: Path, tail: bytes) -> None:
    path = batch / "rows.jsonl"
    path.write_bytes(path.read_bytes() + tail)
    assert f"{path}, line 5: is damaged (" in refusal(lambda: load_batch(batch))


VALUES: dict[str, tuple[dict[str, Any], str]] = {
    "number": ({"number": "2"}, "number: found '2', expected a whole number >= 1"),
    "zero": ({"number": 0}, "number: found 0, expected a whole number >= 1"),
    "beyond": ({"number": 5}, "number: found 5, the study has 4 ribbons"),
    "status": ({"status": ["converged"]}, "status: found ['converged'], expected text"),
    "verified": ({"verified": 1}, "verified: found 1, expected true or false"),
    "energy": ({"energy": "1"}, "energy: expected a number"),
    "truth": ({"energy": True}, "energy: expected a number"),
    "digits": ({"n0x": 10**400}, "n0x: expected a number"),
    "message": ({"message": None}, "message: found null, expected text"),
    "seconds": ({"seconds": []}, "seconds: found [], expected a number"),
}


@pytest.mark.parametrize("case", VALUES)
def test_rows_that_no_batch_writes(batch: Path, case: str) -> None:
    path = batch / "rows.jsonl"
    lines = lines_of(path)
    changes, words = VALUES[case]
    lines[1] = json.dumps(json.loads(lines[1]) | changes).encode() + b"\n"
    path.write_bytes(b"".join(lines))
    assert f"{path}, line 2: is damaged ({words}" in refusal(lambda: load_batch(batch))


def test_rows_of_other_ribbons_are_not_gone_on_with(batch: Path, study: Study) -> None:
    path = batch / "rows.jsonl"
    path.write_bytes(path.read_bytes().replace(b'"law.epsilon": 0.2', b'"law.epsilon": 0.25'))
    message = refusal(lambda: BatchFolder(batch, study, resume=True))
    assert "line 2: is damaged (law.epsilon: found 0.25, its study has 0.2)" in message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no JSON"),
        ("[]", "found [], expected a mapping of keys"),
        ('{"name": "x"}', "ribbons: missing"),
        ('{"name": 1, "ribbons": 4, "inputs": [], "digest": ""}', "name: found 1, expected text"),
        ('{"name": "x", "ribbons": 1e9, "inputs": [], "digest": ""}', "ribbons: found"),
        ('{"name": "x", "ribbons": 4, "inputs": "abc", "digest": ""}', "inputs: found 'abc'"),
    ],
)
def test_studies_that_no_batch_writes(batch: Path, text: str, words: str) -> None:
    (batch / "study.json").write_text(text)
    message = refusal(lambda: load_batch(batch))
    assert f"study.json: is damaged ({words}" in message
    assert "choose another folder" in message


# branches

COLUMN = """\
name: column
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {P: 30}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: {x: 0}, force: {y: 0, z: -P}, d3: {x: 0}, d1: {y: 0}, moment: {d1: 0}}
guess: {force: [0, 0, -30], moment: [0, 0, 0]}
tolerance: 1e-6
transcription: {type: collocation, degree: 4, intervals: 6}
continuation: {parameter: parameters.P, from: 37, to: 40.2, largest: 1, special: false}
"""


@pytest.fixture(scope="module")
def scene() -> Scene:
    return loads_scene(COLUMN)


@pytest.fixture(scope="module")
def points(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> list[bytes]:
    """Return the lines of a branch: its points, and how it ended."""
    folder = BranchFolder(tmp_path_factory.mktemp("branch"), scene, resume=False)
    list(folder.follow(Continuation(scene)))
    return lines_of(folder.folder / "branch.jsonl")


@pytest.fixture
def branch(scene: Scene, points: list[bytes], tmp_path: Path) -> Path:
    (tmp_path / "scene.yaml").write_text(dump_scene(scene))
    (tmp_path / "branch.jsonl").write_bytes(b"".join(points))
    return tmp_path


def with_line(folder: Path, number: int, change: Callable[[dict[str, Any]], object]) -> Path:
    """Change what a line, from 1, says; return the file."""
    path = folder / "branch.jsonl"
    lines = lines_of(path)
    line = json.loads(lines[number - 1])
    change(line)
    lines[number - 1] = json.dumps(line).encode() + b"\n"
    path.write_bytes(b"".join(lines))
    return path


def as_text(array: Any, kind: str = "<f8") -> str:
    return base64.b64encode(np.asarray(array, kind).tobytes()).decode()


def array_of(line: dict[str, Any], name: str) -> Any:
    return np.frombuffer(base64.b64decode(line["state"][name]), "<f8")


def state(**changes: Any) -> Callable[[dict[str, Any]], object]:
    return lambda line: line["state"].update(changes)


def row(**changes: Any) -> Callable[[dict[str, Any]], object]:
    return lambda line: line["row"].update(changes)


def times(name: str, factor: float) -> Callable[[dict[str, Any]], object]:
    return lambda line: line["state"].update({name: as_text(factor * array_of(line, name))})


def filled(name: str, value: float) -> Callable[[dict[str, Any]], object]:
    return lambda line: line["state"].update({name: as_text(0 * array_of(line, name) + value)})


LINES: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "no row": (lambda line: line.clear(), "expected a point (row, state), or an ending"),
    "no state": (lambda line: line.pop("state"), "found null, expected a mapping of keys"),
    "missing": (lambda line: line["row"].pop("error"), "error: missing"),
    "value": (lambda line: line["row"].pop("parameters.P"), "parameters.P: missing"),
    "number": (row(number=7), "number: found 7, expected 2"),
    "stage": (row(stage=1), "stage: found 1, its scene has 1"),
    "branch": (row(branch=-1), "branch: found -1, expected a whole number >= 0"),
    "kind": (row(kind="corner"), "kind: found 'corner', expected 'point', 'fold'"),
    "origin": (row(origin=2), "origin: expected the number of a point before"),
    "parameter": (row(parameter="law.B2"), "parameter: expected parameters.P"),
    "energy": (row(energy="1"), "energy: expected a number"),
    "intervals": (row(intervals=1000), "intervals: expected as many as there are elements"),
    "switches": (row(switches=[None]), "switches.0: found null, expected a number"),
    "step": (state(step=0), "step: found 0, expected a number > 0"),
    "no base64": (state(w="A"), "state.w: no base64"),
    "letters": (state(w="éé=="), "state.w: no base64"),
    "single": (state(w=as_text([1, 2, 3], "<f4")), "state.w: no whole number of numbers"),
    "not finite": (filled("w", np.nan), "state.w: numbers that are not finite"),
    "infinite": (filled("tangent", np.inf), "state.tangent: numbers that are not finite"),
    "tangent": (state(tangent=as_text([1.0])), "state.tangent: expected one number more than"),
    "elements": (state(elements=[10**15]), "widths: expected one for each element"),
    "phases": (state(sheets=[1, -1]), "elements: expected a number of them for each phase"),
    "kinds": (state(sheets=[5]), "sheets: expected kinds of phases"),
    "widths": (times("widths", 2.0), "widths: mesh of phase 0: relative widths add up to 1.9"),
    "ending": (lambda line: line.update(ending={"stage": 0}), "branch: missing"),
}


@pytest.mark.parametrize("case", LINES)
def test_lines_that_no_branch_has(branch: Path, scene: Scene, case: str) -> None:
    change, words = LINES[case]
    path = with_line(branch, 3, change)
    before = path.read_bytes()
    for read in (
        lambda: load_branch(branch),
        lambda: BranchFolder(branch, scene, resume=True),
    ):
        message = refusal(read)
        assert message.startswith(f"{path}, line 3: is damaged ({words}"), message
        assert "remove this line and all after it: the points before are kept" in message
        assert path.read_bytes() == before


STATES: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "position": (state(position=38.7), "state.position: is not at parameters.P = "),
    "far": (state(position=1e308), "state.position: is not at parameters.P = "),
    "row": (row(**{"parameters.P": 1.0}), "state.position: is not at parameters.P = 1"),
    "numbers": (times("w", 1.01), "H0: what is told is not what the numbers give"),
    "energy": (row(energy=1e308), "energy: what is told is not what the numbers give"),
    "force": (row(n0z=0.0), "n0: what is told is not what the numbers give"),
    "unknowns": (
        lambda line: line["state"].update(
            w=as_text(array_of(line, "w")[1:]), tangent=as_text(array_of(line, "tangent")[1:])
        ),
        "state.w: ",
    ),
}


@pytest.mark.parametrize("case", STATES)
def test_states_that_are_not_of_their_row(branch: Path, scene: Scene, case: str) -> None:
    change, words = STATES[case]
    path = with_line(branch, 3, change)
    lines = load_branch(branch)[1]
    everything = range(99)
    message = refusal(lambda: list(restored(Continuation(scene), lines, everything, path)))
    assert message.startswith(f"{path}, point 2: is damaged ({words}"), message

    folder = BranchFolder(branch, scene, resume=True)
    assert refusal(lambda: list(folder.follow(Continuation(scene)))).startswith(f"{path}, point 2:")


def test_a_branch_goes_on_where_the_message_says(
    branch: Path, scene: Scene, points: list[bytes]
) -> None:
    path = with_line(branch, 3, state(step=-1))
    assert f"{path}, line 3: " in refusal(lambda: load_branch(branch))
    path.write_bytes(b"".join(points[:2]))
    list(BranchFolder(branch, scene, resume=True).follow(Continuation(scene)))
    assert path.read_bytes() == b"".join(points)


def test_points_that_are_missing_are_missed(branch: Path, points: list[bytes]) -> None:
    path = branch / "branch.jsonl"
    path.write_bytes(b"".join(points[:1] + points[2:]))
    assert "line 2: is damaged (number: found 2, expected 1" in refusal(lambda: load_branch(branch))
    path.write_bytes(b"".join([*points[:-2], points[-1]]))
    message = refusal(lambda: load_branch(branch))
    count = len(points) - 1
    assert f"(points: {count} were there, {count - 1} are left)" in message
    path.write_bytes(b"".join([*points, points[-2]]))
    assert "it has ended in a line before" in refusal(lambda: load_branch(branch))


@pytest.mark.parametrize("spoil", [b"{}\n", b"\n".join([b"text", b""]), b'{"row": {\n'])
def test_a_line_in_the_middle_is_named(branch: Path, points: list[bytes], spoil: bytes) -> None:
    path = branch / "branch.jsonl"
    path.write_bytes(b"".join([*points[:2], spoil, *points[2:]]))
    assert refusal(lambda: load_branch(branch)).startswith(f"{path}, line 3: is damaged (")


def test_the_scene_of_a_branch_may_be_damaged(branch: Path, scene: Scene) -> None:
    (branch / "scene.yaml").write_text("name: [\n")
    assert "scene.yaml, line 2: not YAML" in refusal(lambda: load_branch(branch))
    (branch / "scene.yaml").write_bytes(b"\xff\xfe")
    for read in (lambda: load_branch(branch), lambda: BranchFolder(branch, scene, resume=True)):
        assert "not a text in UTF-8" in refusal(read)


def test_a_sound_branch_is_read(branch: Path, points: list[bytes]) -> None:
    assert len(rows_of(load_branch(branch)[1])) == len(points) - 1 > 3
