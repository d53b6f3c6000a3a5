"""Pieces of Markdown that generated pages are made of."""

from __future__ import annotations

from collections.abc import Sequence


def code(text: str) -> str:
    """Return a text in backquotes, whatever it holds."""
    ticks = "``" if "`" in text else "`"
    return f"{ticks}{text}{ticks}"


def cell(text: str) -> str:
    """Return a text as a cell of a table: on one line, its bars no borders."""
    return " ".join(text.split()).replace("|", "\\|")


def table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table."""
    lines = [heads, ["---"] * len(heads), *([cell(text) for text in row] for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def fenced(text: str, language: str = "text") -> str:
    """Return a block of code."""
    return f"```{language}\n{text.rstrip()}\n```"


def page(*parts: str) -> str:
    """Return a page of paragraphs."""
    return "\n\n".join(part for part in parts if part) + "\n"
