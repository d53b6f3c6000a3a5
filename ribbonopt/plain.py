"""Plain data, as YAML and JSON have them: rows, which values are numbers, what JSON can say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NoReturn

Row = dict[str, Any]
"""What one ribbon of a study came to: plain values by the names of columns."""

Rows = Sequence[Row]

SPECIALS = "specials"  # of the row of a branch: the rows of its special points, in order

DEEPEST = 60  # lists and mappings in each other, in JSON that is read


def is_number(value: Any) -> bool:
    """Whether a value is a finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number that no float can hold
        return False


def finite(value: Any) -> Any:
    """Return a copy with None for every number that JSON cannot say."""
    if isinstance(value, dict):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def json_text(value: Any) -> str:
    """Return what a file of JSON holds, on lines of its own; not for numbers JSON cannot say."""
    import json  # most commands print text

    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def parsed(text: str | bytes) -> Any:
    """Return what JSON says: no key twice, all numbers finite, nothing nested without end.

    Raises
    ------
    ValueError
        Says why it cannot be, and quotes nothing.
    """
    import json  # most commands read none

    try:
        text = text.decode("utf-8") if isinstance(text, bytes) else text
        found = json.loads(
            text, parse_constant=_no_number, parse_float=_finite, object_pairs_hook=_once
        )
    except json.JSONDecodeError as error:
        raise ValueError(f"no JSON at line {error.lineno}, column {error.colno}") from None
    except UnicodeDecodeError as error:
        raise ValueError(f"not a text in UTF-8 (byte {error.start})") from None
    except _UnsoundError:
        raise
    except ValueError:  # of Python's, on converting digits
        raise ValueError("a number of too many digits") from None
    except RecursionError:
        raise ValueError("lists in lists without end") from None
    if _deep(found):
        raise ValueError(f"lists or mappings in each other, more than {DEEPEST}")
    return found


class _UnsoundError(ValueError):
    """What JSON may say and no file of ours does."""


def _no_number(word: str) -> NoReturn:
    raise _UnsoundError("a number that is not finite")


def _finite(digits: str) -> float:
    number = float(digits)
    return number if abs(number) < float("inf") else _no_number(digits)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        raise _UnsoundError("a key that stands twice")
    return found


def _deep(value: Any) -> bool:
    level = [value]
    for _ in range(DEEPEST):
        level = [item for held in level for item in _held(held)]
        if not level:
            return False
    return True


def _held(value: Any) -> list[Any]:
    """Return the lists and mappings in one."""
    items = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [item for item in items if isinstance(item, dict | list)]
