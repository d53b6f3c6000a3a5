"""What a saved file must say, declared as a dataclass: checked when it is read, in one message."""

from __future__ import annotations

from typing import Any, TypeVar

from ribbonopt.reading import Kind
from ribbonopt.scene.faults import InvalidSceneError, Problem, dotted, shown
from ribbonopt.scene.schema.annotations import hints
from ribbonopt.scene.schema.validation import validate

T = TypeVar("T")


def checked(cls: type[T], data: Any, source: str, kind: Kind) -> T:
    """Return what plain data say of the fields of a dataclass.

    Parameters
    ----------
    cls
        The dataclass, whose annotations are what is expected; fields with a default may be missing.
    data
        A mapping; keys that are no fields are left alone, for other versions may write them.
    source
        The file, and where in it, for the message.
    kind
        What kind of file that is; its error names the first key that is wrong, what was found there
        and what was expected.
    """
    if not isinstance(data, dict):
        raise kind.damaged(source, f"found {shown(data)}, expected a mapping of keys")
    fields: type = cls
    try:
        return validate(cls, {key: data[key] for key in hints(fields) if key in data})
    except InvalidSceneError as error:
        first, *others = error.problems
        raise kind.damaged(source, _told(first, len(others))) from None


def _told(problem: Problem, others: int) -> str:
    more = f", and {others} more" if others else ""
    return f"{dotted(problem.path)}: {problem}{more}"
