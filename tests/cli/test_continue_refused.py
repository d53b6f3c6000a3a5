"""`ribbonopt continue` refuses bad input; nothing is written or lost."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from branches import BRANCH, COLUMN, SHORT, SNAP, Whole, names, written

Run = Callable[..., Any]


STAGE = "parameter: parameters.P, from: 30, to: 38"
#: what the user did: the stage, and what the message must say
BAD: dict[str, tuple[str, tuple[str, ...]]] = {
    "unknown parameter": (
        "parameter: parameters.Q, to: 38",
        ("line 11", "continuation.parameter", "parameters.Q", "did you mean parameters.P?"),
    ),
    "misspelt law": (
        "parameter: law.b2, to: 38",
        ("line 11", "continuation.parameter", "law.b2", "did you mean law.B2?"),
    ),
    "no number": ("parameter: law.type, to: 38", ("line 11", "continuation.parameter")),
    "idle parameter": (
        "parameter: parameters.idle, to: 38",
        ("line 11", "continuation.parameter", "parameters.idle"),
    ),
    "from is to": ("parameter: parameters.P, from: 31, to: 31", ("line 11", "31", "another value")),
    "to is the scene's": ("parameter: parameters.P, to: 30", ("line 11", "continuation.to", "30")),
    "no end": ("parameter: parameters.P", ("line 11", "continuation", "to: 0.1")),
    "first above largest": (
        f"{STAGE}, first: 3, largest: 2",
        ("line 11", "continuation.first", "reversed", "first 3 > largest 2"),
    ),
    "smallest above first": (
        f"{STAGE}, smallest: 3, first: 2",
        ("line 11", "continuation.smallest", "reversed", "smallest 3 > first 2"),
    ),
    "step of nothing": (f"{STAGE}, largest: 0", ("line 11", "continuation.largest", "0")),
    "values and to": (f"{STAGE}, values: [1, 2]", ("line 11", "continuation.to", "values")),
    "values that turn": ("parameter: parameters.P, values: [30, 32, 31]", ("line 11", "values")),
    "logarithm of nothing": (
        "parameter: parameters.turn, from: 0, to: 1, scale: log",
        ("line 11", "continuation.from", "> 0"),
    ),
    "unknown scale": (f"{STAGE}, scale: logg", ("line 11", "continuation.scale", "logg")),
    "no points": (f"{STAGE}, points: 0", ("line 11", "continuation.points", "0")),
    "misspelt key": (f"{STAGE}, stopp: [value > 3]", ("line 11", "stopp", "did you mean 'stop'")),
    "no condition": (f"{STAGE}, stop: [value]", ("line 11", "continuation.stop.0", "value")),
    "two conditions": (f"{STAGE}, stop: ['1 < value < 2']", ("line 11", "continuation.stop.0")),
    "unknown quantity": (
        f"{STAGE}, stop: [shortning > 3]",
        ("line 11", "continuation.stop", "shortning", "shortening"),
    ),
    "quantity that is not recorded": (
        f"{STAGE}, stop: [n3 > 3]",
        ("line 11", "continuation.stop", "n3", "record"),
    ),
    "call in a condition": (
        f"{STAGE}, stop: ['__import__(\"os\") > 3']",
        ("line 11", "continuation.stop", "__import__"),
    ),
    "impossible end": ("parameter: law.B2, to: -1", ("line 11", "continuation.to", "law.B2")),
}


def never(*_: object, **__: object) -> None:
    raise AssertionError("solved")


@pytest.fixture
def unsolved(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let nothing be solved."""
    for solver in ("newton.NewtonSolver", "ipopt.IpoptSolver"):
        monkeypatch.setattr(f"ribbonopt.solvers.{solver}.solve", never)


def refused(outcome: Any, tmp_path: Path, *kept: str) -> str:
    """Check that input was refused and nothing written; return the message."""
    status, out, err = outcome
    assert (status, out) == (2, "")
    assert err.startswith("ribbonopt: ")
    assert err.count("ribbonopt: ") == 1
    assert names(tmp_path) == sorted(["scene_.yaml", *kept])
    return str(err)


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("case", BAD)
def test_bad_stages_are_refused(run: Run, tmp_path: Path, case: str) -> None:
    stage, words = BAD[case]
    scene = written(tmp_path, COLUMN + f"continuation: {{{stage}}}\n")
    message = refused(run("continue", scene, "--out", "o"), tmp_path)
    for word in ("scene_.yaml", *words):
        assert word in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize(
    ("formula", "words"),
    [
        ("dot(r, ex at 0.5", ("line 10", "record.deflection", "cannot be read")),
        ("dot(q, ex) at 0.5", ("line 10", "record.deflection", "unknown name 'q'")),
        ("r at 0.5", ("line 10", "record.deflection", "vector", "dot(r, ex)")),
        ("dot(r, ex) at 1.5", ("line 10", "record.deflection", "from 0 to 1")),
    ],
)
def test_bad_records_are_refused(
    run: Run, tmp_path: Path, formula: str, words: tuple[str, ...]
) -> None:
    scene = written(tmp_path, COLUMN.replace("dot(r, ex) at 0.5", formula) + SHORT)
    message = refused(run("continue", scene, "--out", "o"), tmp_path)
    for word in ("scene_.yaml", *words):
        assert word in message


#: of every row, or what a row may be asked for; a record of this name would take its place
TAKEN = ("value", "stage", "branch", "number", "kind", "parameter", "negative", "error", "switches")


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("name", [*TAKEN, "energy", "u2", "n0x", "H0", "intervals", "iterations"])
def test_records_do_not_replace_what_every_row_has(run: Run, tmp_path: Path, name: str) -> None:
    scene = written(tmp_path, COLUMN.replace("deflection:", f"{name}:") + SHORT)
    message = refused(run("continue", scene, "--out", "o"), tmp_path)
    assert f"record.{name}" in message
    assert "line 10" in message


@pytest.mark.usefixtures("unsolved")
def test_scene_without_continuation(run: Run, tmp_path: Path) -> None:
    message = refused(run("continue", written(tmp_path, COLUMN), "--out", "o"), tmp_path)
    for word in ("scene_.yaml", "continuation", "the scene has none", "law.epsilon"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
def test_energy_formulation_is_refused(run: Run, tmp_path: Path) -> None:
    text = COLUMN.replace("tolerance: 1e-9\n", "formulation: energy\n") + SHORT
    message = refused(run("continue", written(tmp_path, text), "--out", "o"), tmp_path)
    for word in ("scene_.yaml", "line 8", "formulation", "energy", "inverted"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize(
    ("pair", "word"),
    [
        ("nonsense", "expected X:Y"),
        (":energy", "expected X:Y"),
        ("value:", "expected X:Y"),
        ("value:nothing", "'nothing'"),
        ("nothing:value", "'nothing'"),
        ("kind:energy", "'kind'"),
        ("value:switches", "'switches'"),
        ("value:energy:u2", "energy:u2"),
        ("parameters.Q:energy", "did you mean 'parameters.P'?"),
        ("P:enrgy", "did you mean 'energy'?"),
    ],
)
def test_figures_of_nonsense_are_refused_before_solving(
    run: Run, tmp_path: Path, pair: str, word: str
) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    message = refused(run("continue", scene, "--out", "o", "--plot", pair), tmp_path)
    assert "--plot" in message
    assert word in message
    assert "expected" in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("pair", ["nothing:energy", "P:nothing", "kind:energy", "nonsense"])
def test_figures_of_nonsense_of_a_folder_are_refused(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, pair: str
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", reference.data)
    status, out, err = run("plot", folder, "--plot", pair)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"ribbonopt: --plot{f' {pair}' if ':' in pair else ''}: found ")
    assert "expected" in err
    assert names(folder) == sorted([BRANCH, "scene.yaml"])


def test_bad_input_in_json_is_one_object(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT.replace("38", "30"))
    status, out, err = run("continue", scene, "--out", "o", "--json")
    found = json.loads(out)
    assert (status, found["status"], found["verified"]) == (2, "bad_input", False)
    assert found["message"] in err
    assert names(tmp_path) == ["scene_.yaml"]


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("resume", [[], ["--resume"]], ids=["new", "resume"])
def test_folder_with_foreign_files_is_left_alone(
    run: Run, tmp_path: Path, resume: list[str]
) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    message = refused(run("continue", scene, "--out", "mine", *resume), tmp_path, "mine")
    assert names(tmp_path / "mine") == ["notes.txt"]
    for word in ("mine", "notes.txt", "an empty folder"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
def test_file_for_a_folder(run: Run, tmp_path: Path) -> None:
    scene = written(tmp_path, COLUMN + SHORT)
    message = refused(run("continue", scene, "--out", scene), tmp_path)
    assert "scene_.yaml" in message
    assert scene.read_text() == COLUMN + SHORT


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize("cut", [3, None], ids=["unfinished", "finished"])
def test_branches_are_not_overwritten(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, cut: int | None
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", b"".join(reference.lines[:cut]))
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    written(tmp_path, SNAP)
    message = refused(run("continue", reference.scene, "--out", "o"), tmp_path, "o")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    for word in ("o: holds a branch already", "--resume"):
        assert word in message


@pytest.mark.usefixtures("unsolved")
@pytest.mark.parametrize(
    "change", [("to: 120", "to: 100"), ("delta: 0.1", "delta: 0.2"), ("name: snap", "name: other")]
)
def test_only_the_same_scene_is_resumed(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, change: tuple[str, str]
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", b"".join(reference.lines[:3]))
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    scene = written(tmp_path, SNAP.replace(*change))
    message = refused(run("continue", scene, "--out", "o", "--resume"), tmp_path, "o")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    for word in ("o: holds a branch of another scene", "resume with the scene"):
        assert word in message


def test_the_same_scene_may_be_written_otherwise(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path
) -> None:
    reference = whole("fold")
    folder = reference.cut(tmp_path / "o", reference.data)
    scene = written(tmp_path, "# the same\n" + SNAP.replace("0.9]", "9.0e-1]"))
    assert run("continue", scene, "--out", folder, "--resume", "--quiet").status == 3
    assert (folder / BRANCH).read_bytes() == reference.data


@pytest.mark.parametrize("line", [b"3\n", b"{}\n", b'{"row": {}}\n', b"[]\n"])
def test_files_that_are_damaged_are_no_accident(
    run: Run, whole: Callable[[str], Whole], tmp_path: Path, line: bytes
) -> None:
    # JSON, but nothing that a branch file holds
    reference = whole("fold")
    data = b"".join([*reference.lines[:2], line, *reference.lines[2:]])
    folder = reference.cut(tmp_path / "o", data)
    status, _, err = run("continue", reference.scene, "--out", folder, "--resume")
    assert err.startswith("ribbonopt: ")
    assert status in (2, 3)
