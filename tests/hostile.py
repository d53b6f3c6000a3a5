"""The hostile texts of the attacks, as tests use them."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "scripts"))

from attack_texts import (
    ALL,
    ESCAPES,
    FORMULAS,
    MARKUP,
    NAMES_KEPT,
    NAMES_REFUSED,
    file_names,
    texts,
)

__all__ = [
    "ALL",
    "ESCAPES",
    "FORMULAS",
    "MARKUP",
    "NAMES_KEPT",
    "NAMES_REFUSED",
    "acting",
    "file_names",
    "texts",
]

#: what makes a terminal act, by their numbers in the standards: C0 but line feed, C1, directions,
#: breaks of lines and paragraphs, halves of characters
CONTROLS = (
    *(set(range(0x00, 0x20)) - {0x0A}),
    *range(0x7F, 0xA0),
    *(0x061C, 0x200E, 0x200F, 0x2028, 0x2029),
    *range(0x202A, 0x202F),
    *range(0x2066, 0x206A),
    *range(0xD800, 0xE000),
)
_ACTING = frozenset(map(chr, CONTROLS))


def acting(text: str) -> set[str]:
    """Return the characters of a text that a terminal would obey, or cannot be given."""
    return _ACTING & set(text)
