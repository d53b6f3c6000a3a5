"""What a summary says of one of all equilibria of a scene, beyond what tells it from the others."""

from __future__ import annotations

from typing import Any

from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.checks.stability import negative_within_plane, second_variation
from ribbonopt.checks.zero_moment import lacks_linearisation
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.sought import Sought


def among_all(solution: Solution, sought: Sought) -> dict[str, Any]:
    """Return its images, symmetry and stability, its bar, and what led to it; None for unknown."""
    found = second_variation(solution)
    unknown = alone(solution) or lacks_linearisation(solution)
    return {
        "image_of": sought.image_of,
        "symmetry": sought.symmetry,
        "found_by": sought.found_by,
        "negative": None if isinstance(found, str) else found.negative,
        "negative_in_plane": negative_within_plane(solution),
        "stability": f"not known: {found}" if isinstance(found, str) else found.verdict,
        "error": None if unknown else relative_error(solution)[0],
    }
