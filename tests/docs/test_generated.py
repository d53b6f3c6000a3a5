"""Pages that the documentation makes of the code: nothing of it is left out, no table is broken.

That links lead somewhere is seen by the strict build (`scripts/docs`), which needs Sphinx.
"""

import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

import ribbonopt
from ribbonopt import json_schema
from ribbonopt.cli.arguments import VERBS, parser
from ribbonopt.solvers import Status
from ribbonopt.studies.batch.written import study_schema

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def pages() -> Iterator[dict[str, str]]:
    before = list(sys.path)
    sys.path.insert(0, str(DOCS / "extensions"))
    try:
        names = ("schema_pages", "verbs", "statuses", "interface")
        made = [import_module(name).pages(DOCS) for name in names]
        yield {name: text for some in made for name, text in some.items()}
    finally:
        sys.path[:] = before


def objects(schema: Any) -> Iterator[dict[str, Any]]:
    if isinstance(schema, dict):
        if "properties" in schema and "title" in schema:
            yield schema
        schema = list(schema.values())
    for part in schema if isinstance(schema, list) else ():
        yield from objects(part)


@pytest.mark.parametrize(
    ("name", "schema"),
    [("scene", json_schema()), ("study", {**study_schema(), "$defs": {}})],
    ids=["scene", "study"],
)
def test_every_key_has_its_place(pages: dict[str, str], name: str, schema: Any) -> None:
    text = pages[f"{name}-reference.md"]
    sections = text.split("\n## ")[1:]
    told = [
        frozenset(re.findall(r"^`([^`]+)`(?:  required)?\n: ", part, re.MULTILINE))
        for part in sections
    ]
    wanted = {frozenset(found["properties"]) for found in objects(schema)}
    assert set(told) == wanted
    assert text.count("\n: by default") == 0
    anchors = re.findall(r"^\((.*)\)=$", text, re.MULTILINE)
    assert len(anchors) == len(set(anchors)) == len(sections)
    assert set(re.findall(r"\]\(#(.*?)\)", text)) <= set(anchors)


def test_a_key_says_what_it_is_and_may_be(pages: dict[str, str]) -> None:
    text = pages["scene-reference.md"]
    expected = (
        "`degree`\n: Degree K of the polynomials.\n"
        ": Whole number ≥ 1, ≤ 10; by default `6`; for example `8`."
    )
    assert expected in text
    assert "`name`  required\n: Name of the scene" in text
    assert "List of 3: number or formula" in text


def test_every_option_has_its_row(pages: dict[str, str]) -> None:
    text = pages["options.md"]
    verbs = next(action for action in parser()._actions if action.dest == "verb").choices
    assert isinstance(verbs, dict)
    for verb in VERBS:
        section = text.partition(f"\n## `ribbonopt {verb}`")[2].partition("\n## ")[0]
        assert section
        for action in verbs[verb]._actions:
            for option in action.option_strings:
                assert option in section or action.dest == "help"


def test_tables_are_sound(pages: dict[str, str]) -> None:
    rows = [line for text in pages.values() for line in text.splitlines() if line[:1] == "|"]
    assert len(rows) > 100
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {3}


def test_every_status_and_every_public_name_is_told(pages: dict[str, str]) -> None:
    for status in Status:
        assert f"| `{status.name.lower()}` | {status.value} |" in pages["statuses.md"]
    for name in ribbonopt.__all__:
        assert name.startswith("__") or f":: ribbonopt.{name}\n" in pages["interface.md"]
