"""Pages of the reference: every key of scenes and of studies, from their JSON schemas."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from pieces import code, page

from ribbonopt import json_schema
from ribbonopt.studies.batch.written import study_schema

Schema = dict[str, Any]
LIMITS = (
    ("exclusiveMinimum", ">"),
    ("minimum", "≥"),
    ("exclusiveMaximum", "<"),
    ("maximum", "≤"),
)
PLAIN = {
    "number": "number",
    "integer": "whole number",
    "string": "text",
    "boolean": "true or false",
    "null": "null",
}
SCENES = """\
Every key of a scene: what it is, what it may be, what it is by default. This page is made of the
schema that editors use (`ribbonopt schema`). [How a scene is written](../scenes.md) says what
belongs together.

Where a *formula* may stand, it is one of the scene's `parameters`, of `pi`, `deg` and functions
such as `sqrt` and `sin`; along the ribbon it may have the arclength `s` as well. A key of which no
default is told may be left out.
"""
STUDIES = """\
Every key of a study file, which `ribbonopt batch` solves. This page is made of the schema that
editors use (`ribbonopt schema study`). [Batches](../batches.md) says how studies are solved and
what they write.
"""


def pages(folder: Path) -> dict[str, str]:
    """Return the pages of both kinds of files."""
    scene, study = Reference("scene", json_schema()), Reference("study", study_schema())
    return {
        "scene-reference.md": page("# Scene reference", SCENES, *scene.sections()),
        "study-reference.md": page("# Study reference", STUDIES, *study.sections()),
    }


class Reference:
    """The objects of a schema, each told once: equal ones are one."""

    def __init__(self, name: str, schema: Schema) -> None:
        self.name, self.schema = name, schema
        self.found: dict[str, str] = {}  # what an object is, as text, and its anchor
        self.paths: dict[str, list[str]] = {}
        self.todo: list[tuple[str, Schema, str]] = []

    def sections(self) -> list[str]:
        """Return a section for each object, in the order in which they are met."""
        self._met(self.schema, "", self.schema["description"])
        told = []
        while self.todo:
            anchor, schema, says = self.todo.pop(0)
            keys = [self._key(anchor, schema, key) for key in schema["properties"]]
            told.append((anchor, schema, says, keys))
        return [self._section(*parts) for parts in told]

    def _section(self, anchor: str, schema: Schema, says: str, keys: list[str]) -> str:
        paths = self.paths[anchor]
        where = ", ".join(code(path) for path in paths[:4]) + (", ..." if len(paths) > 4 else "")
        return page(
            f"({anchor})=",
            f"## {_named(schema)}",
            f"Under {where}." if paths[0] else "",
            says,
            *keys,
        )

    def _key(self, anchor: str, schema: Schema, key: str) -> str:
        """Return a key as a term with its definitions: what it is, and what it may be."""
        member, base = schema["properties"][key], self.paths[anchor][0]
        if key == "type":
            return f"{code(key)}\n: {code(member['const'])}"
        term = code(key) + ("  required" if key in schema.get("required", ()) else "")
        words = member["description"].partition("\n\n")[0]
        examples = " or ".join(code(_yaml(value)) for value in member.get("examples", ()))
        kind = self.kind(member, f"{base}.{key}" if base else key, held=True)
        facts = [kind[0].upper() + kind[1:] if kind[0].isalpha() else kind]
        if "default" in member:
            facts.append(f"by default {code(json.dumps(member['default']))}")
        if examples:
            facts.append(f"for example {examples}")
        return f"{term}\n: {words}\n: {'; '.join(facts)}."

    def kind(self, schema: Schema, path: str, held: bool = False) -> str:
        """Return what a value may be, in words; objects are links to their sections."""
        if "$ref" in schema:
            return "[a scene](scene-reference.md)"
        if "const" in schema:
            return code(str(schema["const"]))
        if "enum" in schema:
            return ", ".join(code(str(value)) for value in schema["enum"])
        if "oneOf" in schema:
            named = {
                some["properties"]["type"]["const"]
                for some in schema["oneOf"]
                if "type" in some.get("properties", ())
            }
            kinds = [
                "one of these names alone"
                if named and named == set(some.get("enum", [some.get("const")]))
                else self.kind(some, path)
                for some in schema["oneOf"]
                if not _null(some)
            ]
            words = " or ".join(dict.fromkeys(kinds))
            return words.replace("number or text", "number or formula")
        if "properties" in schema:
            says = schema["description"]
            return self._met(schema, path, says.partition("\n\n")[2] if held else says)
        if schema.get("type") == "object":
            return (
                f"mapping of names to {self.kind(schema['additionalProperties'], f'{path}.NAME')}"
            )
        if schema.get("type") == "array":
            return self._array(schema, path)
        if "type" not in schema:
            return "any value"
        limits = [f"{sign} {schema[word]:g}" for word, sign in LIMITS if word in schema]
        return " ".join([PLAIN[schema["type"]], ", ".join(limits)]).strip()

    def _array(self, schema: Schema, path: str) -> str:
        if "prefixItems" not in schema:
            return f"list of: {self.kind(schema['items'], f'{path}.0')}"
        kinds = [self.kind(item, path) for item in schema["prefixItems"]]
        if len(set(kinds)) == 1:
            return f"list of {len(kinds)}: {kinds[0]}"
        return f"list: {', '.join(kinds)}"

    def _met(self, schema: Schema, path: str, says: str) -> str:
        """Remember an object and where it is; return a link to it."""
        title, members = schema["title"], json.dumps(schema["properties"], sort_keys=True)
        same = f"{title} {members}"
        if same not in self.found:
            taken = [anchor for anchor in self.found.values() if anchor.endswith(title.lower())]
            anchor = f"{self.name}-{'again-' * len(taken)}{title.lower()}"
            self.found[same], self.paths[anchor] = anchor, []
            self.todo.append((anchor, schema, says))
        anchor = self.found[same]
        if path not in self.paths[anchor]:
            self.paths[anchor].append(path)
        return f"[{_named(schema)}](#{anchor})"


def _named(schema: Schema) -> str:
    """Return the name of an object: the type that picks it, or the name of its class."""
    kind = schema["properties"].get("type", {}).get("const")
    return code(kind) if kind else str(schema["title"])


def _null(schema: Schema) -> bool:
    return schema.get("type") == "null"


def _yaml(value: Any) -> str:
    """Return an example as one writes it: YAML in one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(some)}" for key, some in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_yaml, value)) + "]"
    if isinstance(value, str) and set(value) & set("*:,()<>#{}[]"):
        return json.dumps(value)
    return value if isinstance(value, str) else json.dumps(value)
