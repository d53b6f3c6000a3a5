"""Pictures of examples: the figure that a cell ends with, as in a notebook."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

DPI = 110
LAST = "___"  # what Sphinx-Gallery calls the value of a cell


def figures(block: Any, variables: dict[str, Any], settings: dict[str, Any]) -> str:
    """Save the figure of a cell, if it is one; return what shows it."""
    last = variables["example_globals"].get(LAST)
    if not isinstance(last, Figure):
        return ""
    path = next(variables["image_path_iterator"])
    last.savefig(path, dpi=DPI, bbox_inches="tight")
    return str(figure_rst([path], settings["src_dir"]))
