"""The JSON schema of scene files, from the same schema that validates them."""

from __future__ import annotations

from dataclasses import is_dataclass
from typing import Any, get_args

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import PydanticOmit
from pydantic_core.core_schema import IsInstanceSchema

from .annotations import hints
from .validation import schema_of


def json_schema_of(cls: type) -> dict[str, Any]:
    """Return the JSON schema of a dataclass and of all that it contains."""
    schema = _tidied(_Generator().generate(schema_of(cls)), _descriptions(cls))
    return {"$schema": GenerateJsonSchema.schema_dialect, **schema}


class _Generator(GenerateJsonSchema):
    """Leaves out what no file can say."""

    def is_instance_schema(self, schema: IsInstanceSchema) -> JsonSchemaValue:
        raise PydanticOmit


def _descriptions(annotation: Any) -> dict[str, str]:
    """Return the first line of the docstring of every dataclass in an annotation, by its name."""
    descriptions: dict[str, str] = {}
    parts = get_args(annotation)
    if is_dataclass(annotation) and isinstance(annotation, type):
        descriptions[annotation.__name__] = (annotation.__doc__ or "").partition("\n")[0]
        parts = tuple(hints(annotation).values())
    for part in parts:
        descriptions |= _descriptions(part)
    return descriptions


def _tidied(schema: Any, descriptions: dict[str, str]) -> Any:
    """Forbid unknown keys, as validation does; describe classes; drop defaults that say nothing."""
    if isinstance(schema, list):
        return [_tidied(item, descriptions) for item in schema]
    if not isinstance(schema, dict):
        return schema
    tidied = {
        key: _tidied(value, descriptions) for key, value in schema.items() if key != "properties"
    }
    if tidied.get("default", 0) is None or isinstance(tidied.get("default"), dict):
        del tidied["default"]
    if "properties" in schema:
        members = schema["properties"].items()
        tidied["properties"] = {name: _tidied(member, descriptions) for name, member in members}
        tidied["additionalProperties"] = False
        tidied["description"] = descriptions[schema["title"]]
    return tidied
