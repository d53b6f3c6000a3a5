"""Pages as files: where they go, what they may replace."""

from __future__ import annotations

import os
from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.output.claims import DRAWN, claimed
from ribbonopt.output.declared import PAGE
from ribbonopt.output.staging import recovered, replacing
from ribbonopt.reading import is_file

from .page import GENERATOR, page_of
from .view import View

HEAD = 600  # bytes of a page in which it says who has made it
ENDINGS = (".html", ".htm")


def page_place(result: str | Path, out: str | Path | None = None) -> Path:
    """Return where the page of a result goes: `view.html` in its folder, unless `out` says.

    Raises
    ------
    OutputError
        If it is a folder, no HTML by its name, or another file than a page of ours.
    """
    if out is None:
        folder = recovered(result)
        place = (folder.parent if is_file(folder) else folder) / PAGE
    else:
        place = Path(out)
        if "\0" in str(out) or place.is_dir():
            raise OutputError(f"{str(out)!r}: expected a file for the page, such as {PAGE}")
        if place.suffix.lower() not in ENDINGS:
            raise OutputError(f"{place}: expected a name that ends in .html")
    if os.path.lexists(place) and not _is_ours(place):
        raise OutputError(f"{place}: is not a page of ribbonopt; choose another name by --out")
    return place


def write_page(view: View, place: Path) -> Path:
    """Write the page of a view and return where; an older page is replaced.

    Raises
    ------
    OutputError
        If it cannot be written, or another process writes to the folder.
    """
    text = page_of(view)
    with claimed(place.parent, {*DRAWN, place.name}, alone=False) as folder:
        try:
            # Half a character, which JSON can say and UTF-8 cannot, is no reason to fail.
            with replacing(folder / place.name, errors="xmlcharrefreplace") as file:
                file.write(text)
        except OSError as error:
            reason = error.strerror or error
            raise OutputError(
                f"{place}: cannot be written ({reason}); choose another place by --out"
            ) from error
    return place


def _is_ours(place: Path) -> bool:
    """Whether a file is a page that this module has written."""
    try:
        with open(place, "rb") as file:
            return f'content="{GENERATOR}"'.encode() in file.read(HEAD)
    except OSError:
        return False
