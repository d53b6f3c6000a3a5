"""Pages to look at ribbons from all sides: self-contained HTML for browsers and notebooks.

Importing this room loads none of its modules.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ribbonopt.checks.modes import Modes
    from ribbonopt.solution.solution import Solution
    from ribbonopt.studies.batch.results import Batch
    from ribbonopt.studies.continuation.branch import Branch

__all__ = ["embedded"]

HEIGHT = 640  # pixels


def embedded(
    thing: Solution | Branch | Batch, height: int = HEIGHT, modes: Modes | None = None
) -> str:
    """Return HTML that shows something solved in a part of another page, such as a notebook.

    Parameters
    ----------
    thing
        A solution, verified or not, a branch or a batch.
    height
        In pixels.
    modes
        Of a solution: its small vibrations (`solution.modes()`), to be seen in motion.

    Raises
    ------
    ViewError
        If there is nothing to be seen, such as a branch without points.
    """
    from .looking import view_of
    from .page import framed, page_of

    return framed(page_of(view_of(thing, modes=modes)), height)
