"""What validation finds wrong, as data: `explain` puts it into words."""

from __future__ import annotations

from enum import Enum, auto
from typing import Any, NamedTuple

#: keys, indices and tags of unions that lead to a value
Loc = tuple[str | int, ...]


class Kind(Enum):
    """What is wrong: a value, a key that is missing, one that is not known, or is no text."""

    VALUE = auto()
    MISSING = auto()
    UNKNOWN = auto()
    KEY = auto()


class Fault(NamedTuple):
    """One fault of data.

    Attributes
    ----------
    kind
        What is wrong.
    loc
        Where: the keys and indices of the value, with the tags of unions on the way.
    found
        The faulty value; of a missing key what lacks it.
    """

    kind: Kind
    loc: Loc
    found: Any
