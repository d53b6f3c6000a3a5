"""The short report of a solve, from its summary: what was found, with bars, and what to doubt.

How it was found, what else is conserved and what it cost is in the long one (`report`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .lines import (
    head,
    law,
    loads_and_strains,
    others,
    phases,
    reactions,
    recorded,
    row,
    stability,
    symmetry,
)


def brief(summary: Mapping[str, Any], verdict: str = "") -> str:
    """Return the short report of a summary; `verdict` is on stability, "" where it is not told.

    Whatever is to be doubted of an answer is in it: why it is not verified, notes, warnings.
    """
    s = summary
    return "\n".join(
        [
            *head(s),
            f"  {law(s)}; units {s['units']}",
            *loads_and_strains(s),
            row("energy", s["energy"], s["error_estimate"]["energy"]),
            *symmetry(s),
            *recorded(s),
            *reactions(s),
            *phases(s),
            *stability(verdict),
            *others(s["equilibria"], s.get("search")),
            *(f"  warning: {text}" for text in s["warnings"]),
        ]
    )
