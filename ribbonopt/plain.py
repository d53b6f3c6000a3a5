"""Plain data, as YAML and JSON have them: rows, which values are numbers, and what JSON can say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

Row = dict[str, Any]
"""What one ribbon of a study came to: plain values by the names of columns."""

Rows = Sequence[Row]


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
