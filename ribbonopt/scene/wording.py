"""Words of the checks: vectors as a scene writes them, and lists as a sentence does."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields, is_dataclass
from typing import Any


def given(value: Any) -> dict[str, Any]:
    """Return what is given of an end or a vector, by key; a triple stands for x, y, z."""
    if not is_dataclass(value):
        return dict(zip("xyz", value or (), strict=False))
    pairs = ((field.name, getattr(value, field.name)) for field in fields(value))
    return {key: part for key, part in pairs if part is not None}


def written(vector: Any) -> str:
    """Return a vector as a scene writes it."""
    if is_dataclass(vector):
        return f"{{{', '.join(f'{key}: {_plain(part)}' for key, part in given(vector).items())}}}"
    return f"[{', '.join(map(_plain, vector))}]"


def listed(words: Iterable[str], last: str = "and") -> str:
    """Return words as a sentence lists them."""
    *before, final = words
    return f"{', '.join(before)} {last} {final}" if before else final


def _plain(value: Any) -> str:
    if is_dataclass(value) or isinstance(value, tuple):
        return written(value)
    return f"{value:.12g}" if isinstance(value, float) else str(value)
