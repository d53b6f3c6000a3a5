"""Verb `view`: a page on which a saved result, branch or batch is looked at."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from .common import say_left_out
from .terminal import complain, say_line
from .values import size

if TYPE_CHECKING:
    from pathlib import Path


def view(options: argparse.Namespace) -> int:
    """Write the page of a folder and say where it is."""
    half_width = size("--half-width", options.half_width)
    from ribbonopt.viewer.files import page_place, write_page
    from ribbonopt.viewer.looking import saved_view

    place = page_place(options.result, options.out)
    shown = saved_view(options.result, half_width, options.modes)
    path = write_page(shown, place)
    say_left_out(shown.left_out)
    say_line(str(path))
    if options.open:
        _open(path)
    return 0


def _open(path: Path) -> None:
    """Show a page in the browser of this machine; say so where there is none."""
    import webbrowser

    if not webbrowser.open(path.resolve().as_uri()):
        complain("--open: no browser was found; the page is written")
