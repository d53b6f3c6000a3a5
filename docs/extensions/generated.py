"""Sphinx extension: pages made at build time, of what the code says of itself; none is stored.

Each maker returns pages by name; they are written to `docs/generated/` where they differ, so that a
second build reads only what has changed.
"""

from __future__ import annotations

from pathlib import Path

import interface
import scene_gallery
import schema_pages
import statuses
import verbs
from sphinx.application import Sphinx

MAKERS = (schema_pages.pages, verbs.pages, statuses.pages, interface.pages, scene_gallery.pages)


def make(app: Sphinx) -> None:
    """Write all pages, and remove those that nothing makes any more."""
    folder = Path(app.srcdir, "generated")
    made: set[Path] = set()
    for pages in MAKERS:
        for name, text in pages(folder).items():
            path = folder / name
            made.add(path)
            path.parent.mkdir(parents=True, exist_ok=True)
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                path.write_text(text, encoding="utf-8")
    for path in folder.rglob("*.md"):
        if path not in made:
            path.unlink()


def setup(app: Sphinx) -> dict[str, bool]:
    """Make the pages before any is read."""
    app.connect("builder-inited", make)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
