"""Where a solve that did not converge resists: the condition, or the part of the ribbon."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Layout


def where_it_resists(residuals: Array, layout: Layout, solution: Solution) -> str:
    """One sentence that names the largest residual."""
    # An inequality resists only where it is positive.
    sizes = np.where(layout.is_inequality(), np.maximum(residuals, 0.0), np.abs(residuals))
    sizes = np.where(np.isfinite(residuals), sizes, np.inf)
    index = int(sizes.argmax())
    size = f"residual {sizes[index]:.2g}"
    if index >= layout.conditions_at:
        name = list(solution.problem.conditions)[index - layout.conditions_at]
        return f"What resists most is the condition {name} ({size})"
    element = index // layout.element_equations
    a, b = solution.nodes[element], solution.nodes[element + 1]
    return f"What resists most is the ribbon between s = {a:.4g} and s = {b:.4g} ({size})"
