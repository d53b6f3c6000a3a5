"""The schemas for editors: what they refuse, the reader refuses; what it reads, they accept."""

import json
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from ribbonopt import load_study
from ribbonopt.errors import SceneError
from ribbonopt.scene import json_schema
from ribbonopt.scene.yamlio import plain_yaml
from ribbonopt.studies.batch.draws import DISTRIBUTIONS
from ribbonopt.studies.batch.inputs import KINDS
from ribbonopt.studies.batch.sweep import KEYS, SAVE
from ribbonopt.studies.batch.written import study_schema

CONFIGS = Path(__file__).parents[2] / "configs"
HEAD = "# yaml-language-server: $schema="
FILES = sorted(CONFIGS.rglob("*.yaml"))
STUDY = """\
name: some
scene: {name: one, law: sadowsky, boundary: {loop: {half_twists: 1}}}
"""


def of_study(path: Path) -> bool:
    return "study.schema" in path.read_text(encoding="utf-8").partition("\n")[0]


@pytest.fixture(scope="module")
def checkers() -> dict[str, Draft202012Validator]:
    schemas = {"scene": json_schema(), "study": study_schema()}
    for schema in schemas.values():
        Draft202012Validator.check_schema(schema)
    return {name: Draft202012Validator(schema) for name, schema in schemas.items()}


def test_the_stored_schema_of_studies_is_the_one_of_the_code() -> None:
    text = (CONFIGS / "study.schema.json").read_text(encoding="utf-8")
    assert json.loads(text) == study_schema()


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_file_names_its_schema_and_fits_it(
    path: Path, checkers: dict[str, Draft202012Validator]
) -> None:
    text = path.read_text(encoding="utf-8")
    first = text.partition("\n")[0]
    assert first.startswith(HEAD)
    named = (path.parent / first.removeprefix(HEAD)).resolve()
    assert named in (CONFIGS / "scene.schema.json", CONFIGS / "study.schema.json")
    data = plain_yaml(text, str(path))
    assert of_study(path) == ("scene" in data or "sweep" in data)
    checkers["study" if of_study(path) else "scene"].validate(data)


def test_the_schema_knows_the_words_of_the_reader() -> None:
    told = study_schema()["properties"]
    assert set(told) == set(KEYS)
    assert set(told["sweep"]["properties"]) == set(KINDS)
    assert set(told["save"]["enum"]) == set(SAVE)
    over = told["sweep"]["properties"]["random"]["properties"]["over"]["additionalProperties"]
    assert {word for some in over["oneOf"] for word in some["properties"]} == set(DISTRIBUTIONS)


RIGHT = [
    "",
    "set: null",
    "set: {tolerance: 1e-6}\nsave: none\ntime_limit: 1",
    "sweep: {grid: {tolerance: [1e-6, 1e-8]}}",
    "sweep: {grid: {tolerance: {from: 1e-8, to: 1e-6, count: 3, scale: log}}}",
    "sweep: {list: [{tolerance: 1e-6}, {tolerance: 1e-8, seed: 1}]}",
    "sweep: {random: {count: 3, over: {seed: {uniform: [1, 2]}, starts: {normal: [1, 0]}}}}",
    "sweep: {zip: {tolerance: [1e-6, 1e-8], seed: [1, 2]}}",
]
WRONG = [
    "colour: red",
    "save: some",
    "time_limit: 0",
    "time_limit: 1e7",
    "time_limit: long",
    "continue: 1",
    "set: [1]",
    "sweep:",
    "sweep: {}",
    "sweep: {gird: {tolerance: [1e-6]}}",
    "sweep: {grid: {tolerance: 1e-6}}",
    "sweep: {grid: {tolerance: {from: 1, to: 2}}}",
    "sweep: {grid: {tolerance: {from: 1, to: 2, count: 0}}}",
    "sweep: {grid: {tolerance: {from: 1, to: 2, count: 3, scale: odd}}}",
    "sweep: {list: {tolerance: 1e-6}}",
    "sweep: {list: [1e-6]}",
    "sweep: {random: {count: 3}}",
    "sweep: {random: {count: 3.5, over: {seed: {uniform: [1, 2]}}}}",
    "sweep: {random: {count: 3, over: {seed: {poisson: [1, 2]}}}}",
    "sweep: {random: {count: 3, over: {seed: {uniform: [1, 2, 3]}}}}",
    "sweep: {random: {count: 3, over: {seed: {log_uniform: [0, 2]}}}}",
    "sweep: {random: {count: 3, over: {seed: {normal: [0, -2]}}}}",
    "sweep: {random: {count: 3, over: {seed: {uniform: [0, 1], normal: [0, 1]}}}}",
    "sweep: {csv: 3}",
    "sweep: {csv: null}",
]


def read(folder: Path, text: str) -> Any:
    path = folder / "study.yaml"
    path.write_text(STUDY + text, encoding="utf-8")
    load_study([path])
    return plain_yaml(STUDY + text, "study.yaml")


@pytest.mark.parametrize("text", RIGHT)
def test_studies_that_are_read_are_accepted(
    text: str, tmp_path: Path, checkers: dict[str, Draft202012Validator]
) -> None:
    checkers["study"].validate(read(tmp_path, text))


@pytest.mark.parametrize("text", WRONG)
def test_wrong_studies_are_refused_by_both(
    text: str, tmp_path: Path, checkers: dict[str, Draft202012Validator]
) -> None:
    assert not checkers["study"].is_valid(plain_yaml(STUDY + text, "study.yaml"))
    with pytest.raises(SceneError):
        read(tmp_path, text)


def test_wrong_scenes_in_a_study_are_refused(checkers: dict[str, Draft202012Validator]) -> None:
    wrong = plain_yaml(STUDY.replace("half_twists: 1", "half_twists: x"), "study.yaml")
    assert not checkers["study"].is_valid(wrong)
    assert not checkers["study"].is_valid({"name": "some"})


def test_a_scene_in_a_study_may_leave_to_set_what_it_misses(
    tmp_path: Path, checkers: dict[str, Draft202012Validator]
) -> None:
    text = STUDY.replace("law: sadowsky, ", "") + "set: {law: sadowsky}\n"
    checkers["study"].validate(plain_yaml(text, "study.yaml"))
    (tmp_path / "study.yaml").write_text(text, encoding="utf-8")
    load_study([tmp_path / "study.yaml"]).check()
