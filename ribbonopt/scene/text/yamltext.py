"""YAML text to plain data that remembers its lines, with the scalars of YAML 1.2.

PyYAML follows YAML 1.1, where `1e-2` is text, `off` is a truth value and `1:30` a number. Only its
parser is used: scalars are resolved here by the core schema of YAML 1.2 (section 10.3.2).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import yaml

from ribbonopt.scene.faults import KeyPath, Place, Problem, quotable, shown

_DEEPEST = 50
_MOST_VALUES = 100_000
# Python refuses to convert thousands of digits; as a float such a number is infinite anyway.
_LONGEST_INT = 400

_CORE = "tag:yaml.org,2002:"
_WORDS: dict[str, bool | float | None] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
_OF_NUMBERS = frozenset("0123456789+-.eE")


class YamlTextError(Exception):
    """Text that is no YAML, or YAML that is no plain data: one message, with its line if known."""

    def __init__(self, message: str, line: int = 0) -> None:
        super().__init__(quotable(message, 300))
        self.line = line


class PlainData(NamedTuple):
    """What a YAML text says: data, the places of its values, and faults that hide no others."""

    data: Any
    places: dict[KeyPath, Place]
    problems: list[Problem]


def read(text: str) -> PlainData:
    """Read YAML text into dicts, lists, texts, numbers, truth values and None.

    Raises
    ------
    YamlTextError
        If the text is not YAML, nests too deeply or repeats itself without end.
    """
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return _Reader(yaml.parse(text, Loader=loader), [], {}).document()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = error.problem or error.context or "cannot be read"
        if mark is None:
            raise YamlTextError(f"not YAML: {problem}") from None
        faulty = text.splitlines()[mark.line : mark.line + 1]
        hint = "; indent with spaces, not tabs" if "\t" in "".join(faulty) else ""
        raise YamlTextError(f"not YAML: {problem}{hint}", mark.line + 1) from None
    except yaml.YAMLError as error:
        reason = getattr(error, "reason", "") or str(error).splitlines()[0]
        raise YamlTextError(f"not YAML: {reason}") from None
    except UnicodeEncodeError:
        raise YamlTextError("not YAML: holds characters that UTF-8 cannot write") from None


def scalar(text: str) -> str | int | float | bool | None:
    """Return what a plain (unquoted) scalar means in the core schema of YAML 1.2."""
    if text in _WORDS:
        return _WORDS[text]
    number = _number(text)
    return text if number is None else number


def plain_number(text: str) -> int | float | None:
    """Return the number that a text says as YAML where it says one and nothing else.

    None where that is not seen from its characters: it may be a number then, too.
    """
    return _number(text) if text and _OF_NUMBERS.issuperset(text) else None


def _number(text: str) -> int | float | None:
    digits = text[1:] if text[0] in "+-" else text
    try:
        if digits.isascii() and digits.isdigit() and len(digits) < _LONGEST_INT:
            return int(text)
        if text.startswith(("0o", "0x")) and "_" not in text:
            return int(text, 0) if len(text) < _LONGEST_INT else math.inf
        return float(text) if _OF_NUMBERS.issuperset(text) else None
    except ValueError:
        return None


def _line_of(event: Any) -> int:
    line: int = event.start_mark.line
    return line + 1


class _Reader:
    """Turns the parser's events into data; the events, unlike its nodes, are not recursive."""

    def __init__(
        self, events: Iterator[Any], problems: list[Problem], anchors: dict[str, Any]
    ) -> None:
        self.events, self.problems, self.anchors = events, problems, anchors
        self.places: dict[KeyPath, Place] = {}
        self.values = 0

    def document(self) -> PlainData:
        data = None
        documents = 0
        for event in self.events:
            if isinstance(event, yaml.DocumentStartEvent):
                documents += 1
                if documents > 1:
                    line = _line_of(event)
                    raise YamlTextError("a second document begins; a scene is one document", line)
                data = self._value(next(self.events), ())
        return PlainData(data, self.places, self.problems)

    def _value(self, event: Any, path: KeyPath) -> Any:
        line = _line_of(event)
        self.places.setdefault(path, Place(line))
        self.values += 1
        if len(path) > _DEEPEST or self.values > _MOST_VALUES:
            raise YamlTextError("nests too deeply or holds too many values for a scene", line)
        if isinstance(event, yaml.AliasEvent):
            return self._alias(event, line)
        # A name that is being defined anew cannot be used inside its own definition.
        self.anchors.pop(event.anchor, None)
        if event.tag not in (None, "!", _CORE + "str", _CORE + "seq", _CORE + "map"):
            tag = event.tag.replace(_CORE, "!!")
            self.problems.append(Problem(path, f"tag {tag} is refused; a scene is plain data"))
        data: Any
        if isinstance(event, yaml.ScalarEvent):
            data = scalar(event.value) if event.implicit[0] else event.value
        elif isinstance(event, yaml.SequenceStartEvent):
            data = self._sequence(path)
        else:
            data = self._mapping(path)
        if event.anchor is not None:
            self.anchors[event.anchor] = data
        return data

    def _sequence(self, path: KeyPath) -> list[Any]:
        items: list[Any] = []
        while not isinstance(event := next(self.events), yaml.SequenceEndEvent):
            items.append(self._value(event, (*path, len(items))))
        return items

    def _mapping(self, path: KeyPath) -> dict[str, Any]:
        data: dict[str, Any] = {}
        while not isinstance(event := next(self.events), yaml.MappingEndEvent):
            line = _line_of(event)
            key = self._aside(event, path)
            value_event = next(self.events)
            place = (*path, key if isinstance(key, str) else shown(key))
            if not isinstance(key, str):
                self.places.setdefault(place, Place(line))
                self.problems.append(Problem(place, "is no text; write such a key in quotes"))
                self._aside(value_event, place)
            elif key in data:
                self.problems.append(Problem(place, f"given again in line {line}; keep one"))
                self._aside(value_event, place)
            else:
                self.places[place] = Place(line)
                data[key] = self._value(value_event, place)
        return data

    def _aside(self, event: Any, path: KeyPath) -> Any:
        """Read what is no value of the scene (a key, a duplicate): its places do not count."""
        aside = _Reader(self.events, self.problems, self.anchors)
        return aside._value(event, (*path, "?"))

    def _alias(self, event: Any, line: int) -> Any:
        if event.anchor not in self.anchors:
            raise YamlTextError("an alias (*) is not defined before it, or repeats itself", line)
        return self._copy(self.anchors[event.anchor], line)

    def _copy(self, data: Any, line: int) -> Any:
        """Copy what an alias repeats: an override of one place must not change the other."""
        self.values += 1
        if self.values > _MOST_VALUES:
            raise YamlTextError("its aliases repeat too many values", line)
        if isinstance(data, dict):
            return {key: self._copy(value, line) for key, value in data.items()}
        if isinstance(data, list):
            return [self._copy(value, line) for value in data]
        return data
