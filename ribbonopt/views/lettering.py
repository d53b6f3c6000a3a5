"""Letters of panels, and words in lines of a page's width."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from .paper_style import sized

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLORBAR = "<colorbar>"  # as matplotlib calls the axes of one
LETTER = 0.56  # mean width of a letter, of the size of its type


def letter(figure: Figure) -> None:
    """Write (a), (b), ... over the panels of a figure that has several."""
    panels = [axes for axes in figure.axes if axes.get_label() != COLORBAR]
    if len(panels) < 2:
        return
    for i, axes in enumerate(panels):
        axes.annotate(
            lettered(i),
            (0, 1),
            (-4, 4),
            xycoords="axes fraction",
            textcoords="offset points",
            ha="right",
            va="bottom",
            fontsize=sized(10),
            fontweight="bold",
        )


def lettered(i: int) -> str:
    """Return (a) for 0, (b) for 1; after (z) comes (aa)."""
    name = ""
    i += 1
    while i:
        i, rest = divmod(i - 1, 26)
        name = chr(ord("a") + rest) + name
    return f"({name})"


def wrapped(text: str, width: float, size: float) -> str:
    """Return text in lines of at most about a width (inches), in type of a size (points).

    Formulas stay whole.
    """
    letters = int(width * 72 / (LETTER * size))
    lines = [""]
    for word in re.findall(r"(?:\$[^$]*\$|\S)+", text):
        if lines[-1] and _seen(lines[-1]) + 1 + _seen(word) > letters:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".lstrip()
    return "\n".join(lines)


def _seen(text: str) -> int:
    """Return about how many letters a text with formulas takes."""
    return len(re.sub(r"\\[a-z]+|[$_^{}\\]", "", text))
