"""What errors of a comparison are measured against: a reference, or the best solution of all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.scene import Collocation, Scene

from .measure import Measurement, measure
from .pairs import Pair
from .profile import Profile
from .rows import row_of

FINE = Pair("inverted", "reduced", "gauss")
FINE_INTERVALS = (24, 96, 384)
UNKNOWN = "unknown: nothing solved"

Numbers = Sequence[float]


@dataclass(frozen=True)
class SourcedLoads:
    """Known n, m (lab frame, units of the scene) at the start, and where they come from."""

    n0: Numbers
    m0: Numbers
    source: str = "the reference given"


@dataclass(frozen=True, eq=False)
class Truth:
    """What errors are measured against, where it comes from, and how well it is known."""

    profile: Profile
    source: str
    error: float = 0.0


def reference_of(scene: Scene) -> SourcedLoads | None:
    """Return the truth that a scene states, if it does."""
    known = scene.reference
    return None if known is None else SourcedLoads(known.n0, known.m0, "the reference of the scene")


def fine_solves(scene: Scene, wanted: float) -> list[Measurement]:
    """Solve the inverted form on fine meshes until its own estimate is well below what is wanted.

    Where m2 changes sign the order is low and the first mesh is not enough.
    """
    found = []
    for intervals in FINE_INTERVALS:
        mesh = Collocation(scheme="gauss", degree=10, intervals=intervals)
        found.append(measure(FINE, scene, mesh)[0])
        if found[-1].refused or (found[-1].estimate or 1.0) < wanted / 10:
            break
    return found


def truth_of(found: Sequence[Measurement], reference: SourcedLoads | None = None) -> Truth | None:
    """Return the reference, or the verified solution whose own estimate is smallest.

    A reference says nothing of u along s: that comes from the best solution in any case.
    """
    best, profile = None, None
    for one in found:
        if one.verified and one.estimate is not None and one.profile is not None:
            if best is None or one.estimate < (best.estimate or 0.0):
                best, profile = one, one.profile
    if best is None or profile is None:
        return None
    if reference is None:
        row = row_of(best, None)
        source = f"{row.name}, {row.mesh}, by its own estimate within {best.estimate:.0e}"
        return Truth(profile, source, best.estimate or 0.0)
    given = replace(profile, n0=np.array(reference.n0), m0=np.array(reference.m0))
    return Truth(given, reference.source)
