"""Every key of a scene or study is described once, by its class, with examples that are valid."""

from collections.abc import Iterator
from dataclasses import fields
from functools import cache
from typing import Any, get_args

import pytest
from jsonschema import Draft202012Validator

from ribbonopt.scene import Scene, json_schema
from ribbonopt.scene.schema.annotations import hints, only_in_python, written_keys
from ribbonopt.scene.schema.described import described, prose
from ribbonopt.scene.schema.found import Fault
from ribbonopt.scene.schema.validation import check_of
from ribbonopt.studies.batch.written import StudyFile, study_schema


def held_by(annotation: Any) -> Iterator[type]:
    if only_in_python(annotation):
        return
    if isinstance(annotation, type) and hasattr(annotation, "__dataclass_fields__"):
        yield annotation
    for argument in get_args(annotation):
        yield from held_by(argument)


@cache
def classes(root: type) -> tuple[type, ...]:
    """All classes that a file may hold, each once."""
    found: dict[type, None] = {root: None}
    todo = [root]
    while todo:
        cls = todo.pop()
        for key in written_keys(cls):
            new = [held for held in held_by(hints(cls)[key]) if held not in found]
            found |= dict.fromkeys(new)
            todo += new
    return tuple(found)


def all_classes() -> list[type]:
    return list(dict.fromkeys((*classes(Scene), *classes(StudyFile))))


def keyed() -> list[tuple[type, str]]:
    return [(cls, key) for cls in all_classes() for key in written_keys(cls)]


def objects(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        if "properties" in schema and "title" in schema:
            yield schema
        schema = list(schema.values())
    for part in schema if isinstance(schema, list) else ():
        yield from objects(part)


def test_the_classes_are_found() -> None:
    names = {cls.__name__ for cls in all_classes()}
    assert {"Scene", "End", "Turn", "Sano", "Table", "PointLoad", "Helix", "Spacing"} <= names
    assert len(keyed()) > 180


@pytest.mark.parametrize("cls", all_classes(), ids=lambda cls: cls.__name__)
def test_keys_described_are_those_there_are(cls: type) -> None:
    keys = {member.name.removesuffix("_") for member in fields(cls)} - {"type"}
    assert set(described(cls)) == keys
    assert all(said.text.endswith((".", ")")) for said in described(cls).values())
    assert prose(cls).endswith(".")


@pytest.mark.parametrize("make", [json_schema, study_schema])
def test_every_key_of_the_schema_is_described(make: Any) -> None:
    bare = [
        f"{found['title']}.{key}"
        for found in objects(make())
        for key, member in found["properties"].items()
        if len(member.get("description", "")) < 10
    ]
    assert bare == []


@pytest.mark.parametrize("cls", classes(Scene), ids=lambda cls: cls.__name__)
def test_examples_are_valid(cls: type) -> None:
    for key, said in described(cls).items():
        for value in said.examples:
            faults: list[Fault] = []
            check_of(hints(cls)[key])(value, (), faults)
            assert faults == []


@pytest.mark.parametrize("make", [json_schema, study_schema])
def test_examples_are_valid_to_editors(make: Any) -> None:
    schema = make()
    for found in objects(schema):
        for member in found["properties"].values():
            checker = Draft202012Validator({**member, "$defs": schema.get("$defs", {})})
            for value in member.get("examples", ()):
                checker.validate(value)


def test_most_keys_have_an_example_or_a_choice() -> None:
    members = [m for found in objects(json_schema()) for m in found["properties"].values()]
    told = [m for m in members if {"examples", "enum", "const", "default"} & set(m)]
    assert len(told) > 0.97 * len(members)


def test_an_example_is_no_part_of_the_text() -> None:
    said = described(Scene)["law"]
    assert said.text.endswith("no numbers are needed.")
    assert said.examples == ({"type": "sadowsky"}, "wunderlich")
