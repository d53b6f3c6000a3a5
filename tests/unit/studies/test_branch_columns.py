"""Columns of a branch: what each is called, what else it may be called, and where that is told."""

from pathlib import Path

import pytest

from ribbonopt.cli.arguments import parser
from ribbonopt.errors import ModelError
from ribbonopt.scene import loads_scene
from ribbonopt.scene.stages import words_of
from ribbonopt.solution.sampling import evaluate_formula
from ribbonopt.studies.continuation.columns import COLUMNS
from ribbonopt.studies.continuation.recorded import (
    NUMBERS,
    SOFTEST,
    WORDS,
    Recorder,
    value_of,
)
from ribbonopt.studies.continuation.stops import Stops

ROOT = Path(__file__).parents[3]
SCENE = """\
name: arch
law: {{type: regularized, epsilon: 0.1}}
parameters: {{angle: 0, load: 1, energy_scale: 2}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: free, force: {{x: load, z: 0, y: 0}}}}
record: {{{record}}}
continuation:
  - {{parameter: parameters.load, to: 2{more}}}
  - {{parameter: law.epsilon, to: 0.01, scale: log}}
  - {{parameter: parameters.load, to: 1}}
"""


def recorder(record: str = "tip: 'dot(r, ex)'", more: str = "") -> Recorder:
    return Recorder(loads_scene(SCENE.format(record=record, more=more)))


def test_each_number_that_moves_has_one_column() -> None:
    assert recorder().parameters == ("parameters.load", "law.epsilon")


@pytest.mark.parametrize(
    ("word", "column"),
    [
        ("load", "parameters.load"),
        ("parameters.load", "parameters.load"),
        ("law.epsilon", "law.epsilon"),
        ("value", "value"),
        ("tip", "tip"),
        ("u2", "u2"),
    ],
)
def test_words_for_columns(word: str, column: str) -> None:
    assert recorder().column(word) == column
    assert recorder().fault_of([word]) == ""


@pytest.mark.parametrize("word", ["epsilon", "angle", "parameters.angle", "kind", "note", "r", ""])
def test_words_for_none(word: str) -> None:
    fault = recorder().fault_of(["u2", word])
    assert fault.startswith(f"found {word!r}, expected a recorded quantity")
    for name in ("parameters.load", "law.epsilon", "energy", "tip", "value", "`record`"):
        assert name in fault


def test_a_record_has_its_own_name() -> None:
    # the scene's own name for a number, which a record has taken
    found = recorder(record="load: 'dot(r, ex)'")
    assert found.column("load") == "load"
    assert found.column("parameters.load") == "parameters.load"
    row = {"parameter": "parameters.load", "parameters.load": 5.0, "load": 1.0}
    stage = loads_scene(
        SCENE.format(record="load: 'dot(r, ex)'", more=", stop: [load > 2, value > 4]")
    ).continuation[0]
    assert Stops(stage).met(found.named(row, stage)) == "value > 4"


@pytest.mark.parametrize(
    "condition",
    [
        *("load > 1.5", "parameters.load > 1.5", "value > 1.5", "law.epsilon > 0.05"),
        *("2*law.epsilon*load < 1e3", "norm([load, 0, 0]) > 1.5e0", "1.5E-3 < law.epsilon"),
    ],
)
def test_conditions_name_numbers_that_move(condition: str) -> None:
    more = f", stop: ['{condition}']"
    found = recorder(more=more)
    stage = loads_scene(SCENE.format(record="", more=more)).continuation[0]
    row = {"parameter": "parameters.load", "parameters.load": 1.6, "law.epsilon": 0.1}
    assert Stops(stage).met(found.named(row, stage)) == condition
    assert value_of(row) == 1.6
    none = row | {"parameters.load": 1.4, "law.epsilon": 1e-3}
    assert Stops(stage).met(found.named(none, stage)) == (condition if "1e3" in condition else "")


@pytest.mark.parametrize("condition", ["law.delta > 1", "epsilon < 1", "r.x > 1", "load.x > 1"])
def test_conditions_of_nothing_are_refused(condition: str) -> None:
    with pytest.raises(ModelError, match="expected a recorded quantity"):
        recorder(more=f", stop: ['{condition}']")


def test_words_of_a_formula() -> None:
    found = words_of("2e3*law.epsilon + .5e-2*sin(pi*a_1) - 1.e5 + boundary.end.position.x")
    assert found == ["law.epsilon", "a_1", "boundary.end.position.x"]


def test_dotted_names_are_names_only_where_they_are_known() -> None:
    import numpy as np

    values = {"law.epsilon": np.array([2.0]), "r": np.array([[1.0, 5.0, 3.0]])}
    assert evaluate_formula("law.epsilon * r.y", values).tolist() == [10.0]
    assert evaluate_formula("law.epsilon**2", {**values, "r.y": np.array([7.0])}).tolist() == [4.0]
    with pytest.raises(ValueError, match=r"unknown name 'law'|which no formula may hold"):
        evaluate_formula("law.delta", values)


def test_all_columns_are_told() -> None:
    told = {name for names in COLUMNS for name in names.split(", ")}
    assert told == {*NUMBERS, *WORDS, SOFTEST, "frequency1", "squared1", "PATH", "NAME"}
    page = (ROOT / "docs" / "branches.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in page for name in (*NUMBERS, *WORDS, SOFTEST))


def test_help_tells_all_columns(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parser().parse_args(["continue", "--help"])
    said = " ".join(capsys.readouterr().out.split())
    for name, text in COLUMNS.items():
        assert f"{name} {' '.join(text.split())}" in said
