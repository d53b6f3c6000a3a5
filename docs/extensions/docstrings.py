"""Sphinx extension: docstrings are plain text to those who read code, and stay as they are.

`|x|` is a size, not a substitution; and what stands before a colon in the sentence that describes a
property is no type, as Napoleon would have it.
"""

from __future__ import annotations

import re

from sphinx.application import Sphinx

COLON, STANDS_FOR = ":", "\ue000"  # of the private use area: no docstring has it

#: what is code, and a bar outside of it
BAR = re.compile(r"(``.*?``|`[^`]*`)|\\?\|")


def hide(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Hide colons of properties and attributes before Napoleon sees them."""
    if what in ("property", "attribute"):
        lines[:] = [line.replace(COLON, STANDS_FOR) for line in lines]


def show(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    """Put them back, and make bars what they are."""
    shown = (line.replace(STANDS_FOR, COLON) for line in lines)
    lines[:] = [BAR.sub(lambda found: found[1] or r"\|", line) for line in shown]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register both, on either side of Napoleon (500)."""
    app.connect("autodoc-process-docstring", hide, priority=100)
    app.connect("autodoc-process-docstring", show, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
