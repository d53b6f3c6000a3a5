"""Inputs as text and back: YAML on one line, for overrides and for the cells of tables."""

from __future__ import annotations

import json
import re
from functools import lru_cache
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.scene.text.yamltext import YamlTextError, read
from ribbonopt.text import cell, quoted

PAIR = re.compile(r"\\u(d[89ab][0-9a-f]{2})\\u(d[c-f][0-9a-f]{2})")


def as_yaml(value: Any) -> str:
    """Return plain data as YAML on one line, which JSON is but for two words on one character."""
    return PAIR.sub(_joined, json.dumps(value))


def as_cell(value: Any) -> Any:
    """Return the input of a ribbon as a cell that `of_cell` reads as the same value."""
    if isinstance(value, str):
        return _as_cell(value)
    return as_yaml(value) if isinstance(value, dict | list | bool) else value


def of_cell(text: str, where: str) -> Any:
    """Return the input that a cell says; SceneError where it is no YAML, which quotes nothing."""
    try:
        return read(text).data
    except YamlTextError as error:
        raise SceneError(f"{where}: {error}") from None


@lru_cache(1000)  # texts of a column are few, or each is read once
def _as_cell(text: str) -> str:
    try:
        same = read(text).data == text and cell(text) == text
    except YamlTextError:
        same = False
    return text if same else quoted(text)


def _joined(pair: re.Match[str]) -> str:
    high, low = (int(word, 16) for word in pair.groups())
    return f"\\U{0x10000 + ((high - 0xD800) << 10) + low - 0xDC00:08x}"
