"""A text that says a scene, read once: a scene for each set of overrides, in numbers only or more.

What is written is parsed, and refused, once; each scene is validated as if it stood alone.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from ribbonopt.errors import SceneError

from .faults import InvalidSceneError, nearest, report
from .model import Scene
from .schema.annotations import written_keys
from .text.yamltext import PlainData, YamlTextError, read
from .validated import validated

if TYPE_CHECKING:
    from .text.overrides import Overridden
    from .varied import Alike

LOOKED_AT, LONGEST = 20, 100  # keys that may be misspelt, of a file that may have any; letters
REMEMBERED = 64  # values of overrides that are no numbers, which rows of a study share


class Document:
    """YAML text of a scene; `source` names it in messages, and the folder of its tables."""

    def __init__(self, text: str, source: str = "<string>") -> None:
        """Read the text; SceneError if it says no scene."""
        self.text, self.source = text, source
        try:
            self._written = read(text)
        except YamlTextError as error:
            where = f"{source}, line {error.line}" if error.line else source
            raise SceneError(f"{where}: {error}") from None
        data = self._written.data
        if data is None:
            raise SceneError(f"{source}: is empty; expected a scene with name, law, boundary")
        if not isinstance(data, dict):
            kind = "a list" if isinstance(data, list) else "a single value"
            raise SceneError(f"{source}: is {kind}; expected keys such as name, law, boundary")
        refuse_foreign(self._written, source, written_keys(Scene))
        self._read = lru_cache(REMEMBERED)(read)
        self._alike: Alike | None = None

    def scene(self, overrides: Sequence[str] = ()) -> Scene:
        """Return the scene that it says with some values in place of its own.

        Raises
        ------
        SceneError
            For all problems of the scene together, each with its line or its override.
        """
        if not overrides:
            return self._whole(self._written)
        # Only scenes that are overridden pay for these.
        from .text.overrides import numbers_of, override
        from .varied import Alike

        kind, numbers = numbers_of(overrides)
        alike = self._alike
        if alike is not None and alike.kind == kind:
            found = alike.scene(numbers)
            if found is not None:
                return found
        plain = override(self._written, overrides, self._read)
        scene = self._whole(plain)
        if alike is None or alike.kind != kind:
            self._alike = Alike(kind, plain, numbers, scene, os.path.dirname(self.source))
        else:
            alike.compare(numbers, scene)
        return scene

    def _whole(self, plain: PlainData | Overridden) -> Scene:
        try:
            scene = validated(plain.data, os.path.dirname(self.source))
        except InvalidSceneError as error:
            problems = [*plain.problems, *error.problems]
            raise SceneError(report(self.source, problems, plain.places)) from None
        if plain.problems:
            raise SceneError(report(self.source, plain.problems, plain.places))
        return scene


def refuse_foreign(found: PlainData, source: str, known: Sequence[str]) -> None:
    """Refuse what has no key that it might have: no message is to quote what is no scene.

    Raises
    ------
    SceneError
        If all keys are foreign, and none is a known one misspelt.
    """
    keys = list(found.data) if isinstance(found.data, dict) else []
    if any(key in known for key in keys) or not (keys or found.problems):
        return
    if not any(nearest(key[:LONGEST], known) for key in keys[:LOOKED_AT]):
        raise SceneError(
            f"{source}: is no scene, none of its keys is one of a scene; expected keys such as "
            "name, law, boundary"
        )
