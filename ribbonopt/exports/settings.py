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
MOST_WIDE = 1e30  # which single precision can say
MOST_POINTS = 1_000_000  # of a surface, about: some formats take kilobytes for each


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
        if (points := self.rows * (self.across + 1)) > MOST_POINTS:
            raise ModelError(
                f"rows: found {self.rows:,} rows of {self.across + 1:,} points, {points:,} in all; "
                f"expected at most {MOST_POINTS:,}"
            )
        width = self.half_width
        if width is not None and not 0 < width <= MOST_WIDE:
            raise ModelError(
                f"half_width: found {width}, expected a positive length, at most {MOST_WIDE:g}"
            )
        return self


def place_in(path: Path, formats: Sequence[str]) -> tuple[Path, str | None, tuple[str, ...]]:
    """Return the folder that a path means, the name of files if it gives one, and the formats.

    A path with the ending of a format is that of a file in that format.

    Raises
    ------
    ModelError
        If other formats are given for such a file, or none and it has another ending.
    """
    ending, formats = path.suffix[1:].lower(), tuple(dict.fromkeys(formats))
    if ending not in FORMATS:
        if ending and not formats and not path.is_dir():
            raise ModelError(
                f"out: found the ending .{shortened(one_line(ending), 20)}, expected one of "
                f"{', '.join(FORMATS)}; or a folder of that name, and its formats by `format`"
            )
        return path, None, formats
    if formats not in ((), (ending,)):
        shown = shortened(one_line(", ".join(formats)), 60)
        raise ModelError(
            f"format: found {shown} for the file {path.name}; expected {ending}, or a folder for "
            "files of several formats"
        )
    return path.parent, path.stem, (ending,)


def _one_of(what: str, found: str, known: Sequence[str]) -> None:
    if found not in known:
        shown = shortened(one_line(found), 40)
        near = suggestion(found, known)
        raise ModelError(f"{what}: found {shown!r}, expected one of {', '.join(known)}{near}")
