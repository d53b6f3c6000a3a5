"""What is wrong with a scene, as data, and how it is told: one message for all problems of a file.

A problem knows the path of its key; only the reader of a file knows lines, so the two meet here.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ribbonopt.text import one_line, shortened

KeyPath = tuple[str | int, ...]

_LONGEST = 60
_LONGEST_KEY, _LONGEST_FAULT = 120, 2000
_LONGEST_GUESSED = 60  # letters of a word that may be another misspelt
_MOST = 20  # problems that are told one by one


class Problem(NamedTuple):
    """One fault of a scene.

    Attributes
    ----------
    path
        Keys and list indices that lead to the faulty value.
    message
        What was expected, or what is wrong, and the remedy where it is not obvious.
    found
        The faulty value as shown to the user; empty where nothing was found or it does not help.
    """

    path: KeyPath
    message: str
    found: str = ""

    def __str__(self) -> str:
        """Return what was found and what is wrong with it."""
        return f"found {self.found}, {self.message}" if self.found else self.message


class InvalidSceneError(Exception):
    """Carries all problems of a scene to the reader that can name their lines."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("; ".join(f"{dotted(p.path)}: {p}" for p in self.problems))


class Place(NamedTuple):
    """Where a value was written: a line of the file, or an override on the command line."""

    line: int = 0
    override: str = ""

    def __str__(self) -> str:
        """Return the place as messages cite it."""
        if self.override:
            return f"--set {quotable(self.override)}"
        return f"line {self.line}"


def dotted(path: KeyPath) -> str:
    """Return a path in the notation of overrides, such as `boundary.end.position.2`."""
    return ".".join(str(key) for key in path)


def quotable(words: str, most: int = _LONGEST_KEY) -> str:
    """Return what a user wrote (a key, an override) as messages quote it: on one line, bounded."""
    return one_line(shortened(words, most))


def shown(value: object) -> str:
    """Return a value as a YAML user knows it, on one line and not too long."""
    words = {"None": "null", "True": "true", "False": "false"}
    try:
        text = repr(value)
    except ValueError:  # what Python refuses to write in decimals
        text = "a number of thousands of digits"
    text = words.get(text, text)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 4]} ..."


def suggestion(word: str, known: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the known word nearest to `word`, or an empty text."""
    near = nearest(word, known)
    return f"; did you mean {near!r}?" if near else ""


def nearest(word: str, known: Iterable[str]) -> str:
    """Return the known word that `word` was probably meant to be, or an empty text."""
    if len(word) > _LONGEST_GUESSED:
        return ""
    # Imported late: only a mistake pays for it.
    from difflib import get_close_matches

    # Of two letters, one in common must do: d4 for d1.
    near = get_close_matches(word, list(known), n=1, cutoff=0.5 if len(word) < 4 else 0.6)
    return near[0] if near else ""


def report(source: str, problems: Iterable[Problem], places: Mapping[KeyPath, Place]) -> str:
    """Return the one message that names every problem with its line or override.

    Parameters
    ----------
    source
        Name of the file, or another word for where the scene came from.
    problems
        What is wrong; told in the order of the file.
    places
        Where values were written; a missing key is placed at the key of what lacks it.
    """
    placed = sorted(
        ((_place(problem.path, places), problem) for problem in problems),
        key=lambda pair: (bool(pair[0].override), pair[0].line),
    )
    source = one_line(source)
    lines = [_line(place, problem) for place, problem in placed[:_MOST]]
    if len(lines) == 1:
        separator = ", " if placed[0][0] != Place() else ": "
        return f"{source}{separator}{lines[0]}"
    if len(placed) > _MOST:
        lines.append(f"and {len(placed) - _MOST:,} more")
    return "\n  ".join([f"{source}: {len(placed):,} problems", *lines])


def _place(path: KeyPath, places: Mapping[KeyPath, Place]) -> Place:
    for length in range(len(path), 0, -1):
        if path[:length] in places:
            return places[path[:length]]
    return Place()


def _line(place: Place, problem: Problem) -> str:
    key = dotted(problem.path)
    where = [] if place == Place() else [str(place)]
    # An override that sets this very key has already named it.
    if key and not (place.override and place.override.split("=")[0].strip() == key):
        where.append(quotable(key))
    told = quotable(str(problem), _LONGEST_FAULT)
    return ": ".join(part for part in (", ".join(where), told) if part)
