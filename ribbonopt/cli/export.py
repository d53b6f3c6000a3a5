"""Verb `export`: saved results, branches and batches as files that other programs open."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ribbonopt.errors import ModelError, SceneError
from ribbonopt.reading import is_file

from .common import say_left_out
from .terminal import complain, say_line
from .values import count, size, words

if TYPE_CHECKING:
    from ribbonopt.exports.settings import Settings
    from ribbonopt.exports.writing import Gathered

FOLDER = "exports"  # in that of a result
MOST_LINES = 12  # files that are listed one by one


def export(options: argparse.Namespace) -> int:
    """Write files of a result, a branch or a batch."""
    from ribbonopt.exports.formats import FORMATS
    from ribbonopt.exports.settings import MOST_ACROSS, MOST_ROWS, MOST_WIDE, Settings, place_in
    from ribbonopt.exports.writing import gather, write

    result, formats = Path(options.result), words(options.format) or []
    if unknown := [name for name in formats if name not in FORMATS]:
        known = ", ".join(FORMATS)
        raise SceneError(f"--format: found {unknown[0][:40]!r}; expected some of {known}")
    out = Path(options.out) if options.out else None
    half_width = size("--half-width", options.half_width, most=MOST_WIDE)
    rows = count("--rows", options.rows, MOST_ROWS)
    across = count("--across", options.across, MOST_ACROSS)
    try:
        folder, name, chosen = place_in(out or Path(), formats)
        settings = Settings(
            chosen or ("vtp",), half_width, rows, across, options.color, not options.piece
        ).checked()
    except ModelError as error:
        raise SceneError(f"--{error}") from error
    gathered = gather(result, settings)
    say_left_out(gathered.left_out)
    if unsure := [r for r in gathered.ribbons if not r.solution.verified]:
        first = f"{unsure[0].solution.scene.name}{unsure[0].words}"
        more = f" and {len(unsure) - 1} more" if len(unsure) > 1 else ""
        complain(f"not verified, exported all the same: {first}{more}")
    if out is None:
        paths = _beside(result, gathered, settings)
    else:
        paths = write(gathered, folder, name, settings)
    shown = paths if len(paths) <= MOST_LINES else [p for p in paths if p.suffix == ".pvd"]
    for path in shown:
        say_line(str(path))
    if len(shown) < len(paths):
        say_line(f"{'and ' * bool(shown)}{len(paths) - len(shown)} files in {paths[0].parent}")
    return 0


def _beside(result: Path, gathered: Gathered, settings: Settings) -> list[Path]:
    """Export into a folder in that of the result, which is told that it is one of its own."""
    from ribbonopt.exports.writing import write
    from ribbonopt.output.claims import claimed
    from ribbonopt.output.declared import declare

    with claimed(result.parent if is_file(result) else result, (), alone=False) as place:
        declare(place, (FOLDER,))
        return write(gathered, place / FOLDER, None, settings)
