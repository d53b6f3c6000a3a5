"""What the words of options mean: lists, numbers, counts; each refused with what was expected."""

from __future__ import annotations

import argparse

from ribbonopt.errors import SceneError


def chosen(options: argparse.Namespace) -> tuple[list[str] | None, list[str] | None]:
    """Names of formulations and transcriptions; None for all."""
    return words(options.formulations), words(options.transcriptions)


def numbers(option: str, text: str | None) -> list[float] | None:
    """Read a list of numbers between 0 and 1; SceneError for anything else."""
    try:
        found = None if text is None else [float(word) for word in text.split(",")]
    except ValueError:
        found = [0.0]
    if found is not None and not all(0 < number < 1 for number in found):
        wanted = "expected numbers between 0 and 1: 1e-6,1e-9"
        raise SceneError(f"{option}: found {_short(str(text))}; {wanted}")
    return found


def count(option: str, text: str, most: int, least: int = 1) -> int:
    """Read a whole number from `least`, 0 or 1, to a limit; SceneError for anything else."""
    digits = text.lstrip("0") or "0" * (1 - least)
    if not (text.isascii() and text.isdigit() and digits):
        raise SceneError(f"{option}: found {_short(text)}; expected a whole number from {least}")
    if len(digits) > len(str(most)) or int(digits) > most:
        raise SceneError(f"{option}: found {_short(text)}; expected at most {most:,}")
    return int(digits)


def size(option: str, text: str | None, least: float = 0.0, most: float = 1e9) -> float | None:
    """Read a number above `least`, at most `most`; SceneError for anything else."""
    if text is None:
        return None
    try:
        number = float(text)
    except ValueError:
        number = float("nan")
    if not least < number <= most:
        raise SceneError(
            f"{option}: found {_short(text)}; expected a number > {least:g}, at most {most:g}"
        )
    return number


def _short(text: str) -> str:
    return repr(text) if len(text) < 60 else f"{text[:56]!r} ..."


def words(text: str | None) -> list[str] | None:
    """Read a list of words; None where there is none."""
    return None if text is None else [word.strip() for word in text.split(",")]
