"""What the shape of an answer warns of: a plane that nothing holds it in, and itself in its way.

Neither is wrong: a planar equilibrium of a scene in space is one, but maybe not stable out of the
plane; a centre line may pass itself, since contact is not modelled.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.mechanics.widths import own_width, widths
from ribbonopt.solution.solution import Solution

from .approach import nearest_approach
from .polygons import MEETING
from .topology import closure

FLAT = 1e-9  # of the largest strain, or the tolerance where that is larger: it counts as zero
DRAWN = 1 / 10  # width of the ribbon, of the length drawn, where the scene does not say it
APART = 3.0  # widths along the ribbon between places that may be near one another
BEYOND = 3  # pieces of the centre line, the same for ribbons narrower than those
POINTS, PER_ELEMENT = 200, 4  # of the centre line, at least: many coils have many elements


def planar_problems(solution: Solution) -> list[str]:
    """Say that an answer is planar where its scene is not; nothing of one that is straight."""
    if solution.scene.states == "planar" or not is_planar(solution):
        return []
    return [
        "the answer lies in a plane, though nothing holds it there: others may leave the plane "
        "(try `starts`), and so does this one where it is not stable (`planar: true` says that the "
        "plane is meant)"
    ]


def is_planar(solution: Solution) -> bool:
    """Whether a bent ribbon stays in one plane: all its strains but one of bending vanish."""
    sizes = np.abs(solution.trajectory.at_stages["u"]).max(axis=0)
    zero = sizes <= max(FLAT, solution.scene.tolerance or 0.0) * sizes.max()
    return bool(sizes.max() > FLAT and zero[2] and (zero[0] or zero[1]))


def contact_problems(solution: Solution) -> list[str]:
    """Say where the centre line comes nearer to itself than the ribbon is wide."""
    band, (start, end) = closure(solution), solution.scene.interval
    points = max(POINTS, PER_ELEMENT * (len(solution.nodes) - 1))
    if band is None:
        length, closed = end - start, False
        r = solution.outputs(np.linspace(start, end, points + 1))["r"]
        if np.linalg.norm(r[0] - r[-1]) <= MEETING * length:  # ends that are held together
            r, closed = r[:-1], True
    else:
        length, closed, r = band.pieces * (end - start), True, band.line(points)
    own = own_width(solution.scene)
    width = DRAWN * length  # where it is widest
    if own is not None:
        along = widths(solution.scene, np.linspace(start, end, points + 1))
        width = own * float(along.max())
    apart = max(APART * width / length, BEYOND / len(r))  # pieces of the line always touch the next
    found = nearest_approach(r / length, width / length, apart, closed)
    if found is None:
        return []
    distance, *places = found
    where = " and s = ".join(f"{start + length * place:.4g}" for place in places)
    if distance <= MEETING:
        return [f"the centre line meets itself at s = {where}: self-contact is not modelled"]
    wide = f"{width:.3g}" if own is not None else f"{width:.3g} (as drawn: `ribbon` says it)"
    return [
        f"the centre line comes within {distance * length:.3g} of itself at s = {where}, nearer "
        f"than the width {wide}: self-contact is not modelled"
    ]
