"""Scenes that differ in some numbers only: these are set in one that is there.

Each number is validated by what the annotation of its place says, as in a whole scene. Where there
is anything out of the ordinary there is no such scene: who asked validates the whole, whose
messages name what is wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any, get_origin

from ribbonopt.classes import dataclass

from .checks.whole import Sound, check
from .faults import InvalidSceneError, KeyPath
from .lens import replaced
from .model import Scene
from .schema.annotations import branches, inside, key_of
from .schema.found import Fault
from .schema.validation import check_of
from .schema.values import Check
from .validated import as_written, completed, says_interval

if TYPE_CHECKING:
    from .text.overrides import Kind, Overridden

Numbers = Sequence[int | float]


@dataclass(frozen=True)
class Slot:
    """A place in a scene: names and indices that lead to it, and what it takes."""

    steps: KeyPath
    check: Check

    @classmethod
    def at(cls, scene: Scene, keys: KeyPath) -> Slot | None:
        """Return the place of a value that is written under these keys; None if it has none."""
        value: Any = scene
        annotation: Any = Scene
        steps: KeyPath = ()
        step: str | int
        for key in keys:
            annotation = inside(_branch(annotation, value), key)
            if is_dataclass(value):
                names = [f.name for f in fields(value) if key_of(f.name) == key]
                if not names:
                    return None
                value, step = getattr(value, names[0]), names[0]
            elif isinstance(value, tuple | dict):
                holder: Any = value
                value, step = holder[key], key
            else:
                return None
            steps = (*steps, step)
        if annotation is None or isinstance(value, bool) or not isinstance(value, int | float):
            return None
        return cls(steps, check_of(annotation))


class Alike:
    """Scenes of one text and one kind of overrides: all but numbers are the same, at their places.

    The first two are validated as a whole; if the second is what the first becomes by numbers that
    are set, so are those to come.
    """

    def __init__(
        self, kind: Kind, said: Overridden, numbers: Numbers, scene: Scene, folder: str
    ) -> None:
        """Begin with the first one: what it says, its numbers, and the scene that this is."""
        self.kind = kind
        self._said, self._numbers, self._folder = said, numbers, folder
        self._first, self._compared = scene, False
        self._sound: Sound | None = None
        self._written: Scene = scene
        self._slots: tuple[Slot, ...] = ()

    def scene(self, numbers: Numbers) -> Scene | None:
        """Return the scene with these numbers; None if it is not sound, or not known to be so."""
        if self._sound is None:
            return None
        scene = self._with(numbers)
        return None if scene is None or check(scene, self._sound) else scene

    def compare(self, numbers: Numbers, scene: Scene) -> None:
        """Learn from another one that was validated as a whole; the second decides."""
        if self._compared:
            return
        self._compared = True
        self._written = as_written(self._said.data)
        slots = [Slot.at(self._written, keys) for keys in self._places()]
        self._slots = tuple(slot for slot in slots if slot is not None)
        if len(self._slots) == len(self._numbers):
            first = self._with(self._numbers)
            if first is not None and first == self._first and self._with(numbers) == scene:
                self._sound = Sound.of(first)  # which shares its parts with those to come

    def _places(self) -> list[KeyPath]:
        """Return the keys of the numbers; none if an override undoes one before it."""
        put = [steps for steps, _ in self._said.put]
        for i, steps in enumerate(put):
            if any(steps[: len(later)] == later for later in put[i + 1 :]):
                return []
        return [steps for steps, (_, text) in zip(put, self.kind, strict=True) if text is None]

    def _with(self, numbers: Numbers) -> Scene | None:
        """Return the scene with these numbers, not checked as a whole; None if one has no place."""
        scene = self._written
        for slot, number in zip(self._slots, numbers, strict=True):
            faults: list[Fault] = []
            value = slot.check(number, (), faults)
            if faults:
                return None
            scene = replaced(scene, slot.steps, value)
        try:
            return completed(scene, says_interval(self._said.data), self._folder)
        except InvalidSceneError:
            return None


def _branch(annotation: Any, value: Any) -> Any:
    """Return the branch of a union to which a value that holds others belongs."""
    if is_dataclass(value):
        return type(value)
    kind = type(value)
    options = branches(annotation).values()
    return next((some for some in options if get_origin(some) is kind), annotation)
