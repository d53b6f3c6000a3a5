"""Where a law that is smooth for small moments is not: beyond the convexity of its energy."""

from __future__ import annotations

import numpy as np

from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.solution.solution import Solution

SHOWN = 4  # places in a message


def leap_problems(solution: Solution) -> list[str]:
    """Say where strains leap of a law that is linear at small moments.

    Its energy is not convex there, nor its model any better than that of the ribbon without width
    that always leaps.
    """
    law = capabilities(solution.scene)
    if not (law.kinked and law.linear_at_zero and solution.sheets):
        return []
    name, (start, end) = solution.scene.law.type, solution.scene.interval
    turns = list(solution.trajectory.turns)
    places = start + (end - start) * solution.trajectory.ends[turns]
    leaping = places[solution.outputs(places)["leap"] > 0] if turns else places
    if 0 not in solution.sheets and not len(leaping):
        return []
    where = ", ".join(f"{place:.4g}" for place in leaping[:SHOWN])
    where = f"at s = {where}" if len(leaping) else "along the ribbon"
    where += " and elsewhere" if len(leaping) > SHOWN else ""
    reach = float(np.abs(solution.at_stages["leap"]).max())
    return [
        f"beyond the convexity of the energy of the law {name}: {law.switch_name} changes sign "
        f"where the twisting moment is too large for it (by up to {reach:.3g} along the ribbon), "
        f"and strains leap {where}, as those of law sadowsky; a wide ribbon has a thin layer there "
        "(law: wunderlich)"
    ]
