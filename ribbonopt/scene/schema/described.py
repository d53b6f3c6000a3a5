"""What the docstring of a dataclass says of its keys: its section "Attributes", as data.

That section is the one home of these descriptions: editors show it (the JSON schema), the reference
of the documentation is made of it, `help` prints it. A key is described as

    name, other
        What it is. Example: `0.5` or `[0, 1]`

whose examples are YAML.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from inspect import cleandoc
from typing import Any, NamedTuple

from ribbonopt.scene.text.yamltext import read

from .annotations import key_of

_SECTION = re.compile(r"^(\w+)\n-+$", re.MULTILINE)
_EXAMPLES = re.compile(r"\s*Example: ((?:`[^`]+`(?: or )?)+)$")


class Described(NamedTuple):
    """What is said of a key: a text of one line, and values that it may have."""

    text: str
    examples: tuple[Any, ...]


@cache
def described(cls: type) -> dict[str, Described]:
    """Return what the docstring of a dataclass says of its keys, by key."""
    return dict(_entries(_parts(cls).get("Attributes", "")))


def prose(cls: type) -> str:
    """Return what a docstring says before its sections: paragraphs, each on one line."""
    paragraphs = _parts(cls)[""].split("\n\n")
    return "\n\n".join(
        " ".join(text.replace("``", "`").split()) for text in paragraphs if text.strip()
    )


def _parts(cls: type) -> dict[str, str]:
    """Return the sections of a docstring by their names, "" for what comes before them."""
    before, *named = _SECTION.split(cleandoc(cls.__doc__ or ""))
    return {"": before, **dict(zip(named[::2], named[1::2], strict=True))}


def _entries(section: str) -> Iterator[tuple[str, Described]]:
    for entry in re.split(r"\n(?=\S)", section.strip("\n")):
        names, _, body = entry.partition("\n")
        for name in filter(None, names.split(", ")):
            yield (
                key_of(name.partition(" : ")[0]),
                _described(" ".join(body.replace("``", "`").split())),
            )


def _described(text: str) -> Described:
    found = _EXAMPLES.search(text)
    if found is None:
        return Described(text, ())
    values = re.findall(r"`([^`]+)`", found[1])
    return Described(text[: found.start()], tuple(read(value).data for value in values))
