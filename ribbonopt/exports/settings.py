"""How something is exported: formats, width, rows, strips, colour; refused where nothing fits."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.scene.faults import suggestion
from ribbonopt.text import one_line, shortened
from ribbonopt.views.pieces import ROWS

from .colours import FIELD
from .formats import FORMATS
from .mesh import ACROSS
from .quantities import SCALARS

LEAST_ROWS, MOST_ROWS, MOST_ACROSS = 9, 100_000, 1000


@dataclass(frozen=True)
class Settings:
    """What a user may choose, see `export`; ModelError says what cannot be."""

    formats: tuple[str, ...]
    half_width: float | None = None
    rows: int = ROWS
    across: int = ACROSS
    color: str = FIELD
    complete: bool = True

    def checked(self) -> Settings:
        """Return them; ModelError where one of them cannot be."""
        for name in self.formats:
            _one_of("format", name, tuple(FORMATS))
        if not self.formats:
            raise ModelError(f"format: expected one or several of {', '.join(FORMATS)}")
        _one_of("color", self.color, SCALARS)
        for name, value, least, most in (
            ("rows", self.rows, LEAST_ROWS, MOST_ROWS),
            ("across", self.across, 1, MOST_ACROSS),
        ):
            if not least <= value <= most:
                raise ModelError(f"{name}: found {value}, expected from {least} to {most:,}")
        width = self.half_width
        if width is not None and not 0 < width < float("inf"):
            raise ModelError(f"half_width: found {width}, expected a positive length")
        return self


def place_in(path: Path, formats: Sequence[str]) -> tuple[Path, str | None, tuple[str, ...]]:
    """Return the folder that a path means, the name of files if it gives one, and the formats.

    A path with the ending of a format is that of a file, and that is its format unless others are
    given.
    """
    ending = path.suffix[1:].lower()
    if ending in FORMATS and (not formats or tuple(formats) == (ending,)):
        return path.parent, path.stem, (ending,)
    return path, None, tuple(dict.fromkeys(formats))


def _one_of(what: str, found: str, known: Sequence[str]) -> None:
    if found not in known:
        shown = shortened(one_line(found), 40)
        near = suggestion(found, known)
        raise ModelError(f"{what}: found {shown!r}, expected one of {', '.join(known)}{near}")
