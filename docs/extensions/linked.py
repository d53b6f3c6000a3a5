"""Sphinx extension: what Markdown links to outside of these pages is named, not linked.

Pages are read on GitHub as well, where links to `../configs/...` lead there; built pages go without
the rest of the repository. Links to the README, CONTRIBUTING and CHANGELOG lead to their pages.
"""

from __future__ import annotations

import re
from pathlib import Path, PurePosixPath

from sphinx.application import Sphinx

LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(((?:\.\./)+[^)#\s]+|results/[^)#\s]+)(#[^)\s]*)?\)")
PAGES = {"CHANGELOG.md": "changes.md", "CONTRIBUTING.md": "extending.md", "README.md": "index.md"}


def unlink(app: Sphinx, docname: str, source: list[str]) -> None:
    """Write the path of a file in the place of a link to it."""
    here = Path(app.srcdir, docname).parent

    def told(match: re.Match[str]) -> str:
        words, target = match[1], match[2]
        path = (here / target).resolve()
        if path.is_relative_to(app.srcdir) and "results" not in path.parts:
            return match[0]
        if not path.exists():
            raise FileNotFoundError(f"{docname}: links to {target}, which is not there")
        name = path.relative_to(Path(app.srcdir).parent).as_posix()
        if name in PAGES:
            up = "../" * (len(PurePosixPath(docname).parts) - 1)
            return f"[{words}]({up}{PAGES[name]})"
        return words if words.strip("`") in name else f"{words} (`{name}`)"

    source[0] = LINK.sub(told, source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Register it for all pages."""
    app.connect("source-read", unlink)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
