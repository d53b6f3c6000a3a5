"""What a column is called beside an axis: what a scene says, else the usual symbol, else its name.

What a scene says may hold formulas between $; one that matplotlib cannot read is shown as it is.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.text import drawn, one_line

LONGEST = 60  # letters of what a scene says
WIDEST = 40.0  # of a formula, in sizes of its type
PARAMETERS = "parameters."

SYMBOLS: Mapping[str, str] = {
    **{"energy": "energy $E$", "potential": r"potential $\Pi$", "H0": "$H(0)$"},
    **{"law.epsilon": r"$\epsilon$", "law.delta": r"$\delta$"},
    **{name: f"${name[0]}_{name[2]}(0)$" for names in START_VECTORS[:2] for name in names},
    **{name: f"${name[0]}_{name[1]}(0)$" for name in START_VECTORS[2]},
}


def symbol(column: str, labels: Mapping[str, str]) -> str:
    """Return what is written for a column."""
    said = labels.get(column, labels.get(column.removeprefix(PARAMETERS), ""))
    if said:
        return formula(said)
    return SYMBOLS.get(column) or drawn(column.removeprefix(PARAMETERS))


@cache
def formula(text: str) -> str:
    """Return text with formulas if it can be drawn so, else as it is, without any."""
    text = one_line(text)
    if len(text) > LONGEST or "$" not in text or not _readable(text):
        return drawn(text, LONGEST)
    return " " + text if text.startswith("_") else text  # which legends would leave out


def _readable(text: str) -> bool:
    """Whether matplotlib can draw a text with formulas, in the width of a label."""
    from matplotlib.cbook import is_math_text
    from matplotlib.font_manager import FontProperties
    from matplotlib.mathtext import MathTextParser

    from .page import quiet

    if not is_math_text(text):
        return False
    try:
        with quiet():
            found = MathTextParser("path").parse(text, 72, FontProperties(size=1))
    except (ValueError, RecursionError):
        return False
    return 0 < float(found[0]) < WIDEST and float(found[1]) < WIDEST
