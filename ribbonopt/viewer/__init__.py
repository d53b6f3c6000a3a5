"""Pages to look at ribbons from all sides: self-contained HTML for browsers and notebooks.

Importing this room loads none of its modules.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ribbonopt.solution.solution import Solution

__all__ = ["embedded"]

HEIGHT = 640  # pixels


def embedded(solution: Solution, height: int = HEIGHT) -> str:
    """Return HTML that shows a solution in a part of another page, such as a notebook.

    Parameters
    ----------
    solution
        Verified or not; other equilibria of its scene can be chosen.
    height
        In pixels.
    """
    from .page import framed, page_of
    from .solutions import view_of

    return framed(page_of(view_of(solution)), height)
