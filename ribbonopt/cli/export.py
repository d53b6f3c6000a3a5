"""Verb `export`: saved results, branches and batches as files that other programs open."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from ribbonopt.errors import SceneError
from ribbonopt.reading import is_file

from .common import say_left_out
from .terminal import complain, say_line
from .values import count, size, words

if TYPE_CHECKING:
    from ribbonopt.exports.export import Exported
    from ribbonopt.exports.settings import Settings

FOLDER = "exports"  # in that of a result
MOST_LINES = 12  # files that are listed one by one
MOST_WIDE = 1e300


def export(options: argparse.Namespace) -> int:
    """Write files of a result, a branch or a batch."""
    from ribbonopt.exports.formats import FORMATS
    from ribbonopt.exports.settings import MOST_ACROSS, MOST_ROWS, Settings, place_in

    result, formats = Path(options.result), words(options.format) or []
    if unknown := [name for name in formats if name not in FORMATS]:
        known = ", ".join(FORMATS)
        raise SceneError(f"--format: found {unknown[0][:40]!r}; expected some of {known}")
    out = Path(options.out) if options.out else None
    folder, name, chosen = place_in(out or Path(), formats)
    settings = Settings(
        chosen or ("vtp",),
        size("--half-width", options.half_width, most=MOST_WIDE),
        count("--rows", options.rows, MOST_ROWS),
        count("--across", options.across, MOST_ACROSS),
        options.color,
        not options.piece,
    ).checked()
    done = _beside(result, settings) if out is None else _into(result, folder, name, settings)
    say_left_out(done.left_out)
    if done.unverified:
        more = f" and {len(done.unverified) - 1} more" if len(done.unverified) > 1 else ""
        complain(f"not verified, exported all the same: {done.unverified[0]}{more}")
    if len(done.paths) <= MOST_LINES:
        for path in done.paths:
            say_line(str(path))
    else:
        say_line(f"{len(done.paths)} files in {done.paths[0].parent}, the last {done.paths[-1]}")
    return 0


def _into(result: Path, folder: Path, name: str | None, settings: Settings) -> Exported:
    from ribbonopt.exports.export import export_files

    return export_files(result, folder, name, settings)


def _beside(result: Path, settings: Settings) -> Exported:
    """Export into a folder in that of the result, which is told that it is one of its own."""
    from ribbonopt.exports.export import export_files
    from ribbonopt.exports.found import opened
    from ribbonopt.output.claims import claimed
    from ribbonopt.output.declared import declare

    found = opened(result)  # before anything is written
    place = result.parent if is_file(result) else result
    with claimed(place, (), alone=False) as place:
        declare(place, (FOLDER,))
        return export_files(found, place / FOLDER, None, settings)
