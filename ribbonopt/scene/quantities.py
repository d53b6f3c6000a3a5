"""The named quantities of a ribbon: the one list that formulas, samples, files and units use.

A new one is one line here, and its expression in `ribbonopt.mechanics.outputs`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

Shape = Literal["scalar", "vector"]


class Named(NamedTuple):
    """What a name stands for.

    Attributes
    ----------
    means
        A few words.
    shape
        Vectors are in the lab frame, but u along the directors.
    length, force
        Exponents of its dimension: a moment is length 1, force 1.
    at_ends
        Whether equations of a scene may use it, at `(start)` or `(end)`.
    checks
        Whether it only tells how exact a solution is, and no formula may use it.
    """

    means: str
    shape: Shape = "scalar"
    length: int = 0
    force: int = 0
    at_ends: bool = False
    checks: bool = False


#: what a solution has at every arclength, by name
QUANTITIES: Mapping[str, Named] = {
    "r": Named("position", "vector", length=1, at_ends=True),
    "d1": Named("normal", "vector", at_ends=True),
    "d2": Named("direction across the width", "vector", at_ends=True),
    "d3": Named("tangent", "vector", at_ends=True),
    "n": Named("force", "vector", force=1, at_ends=True),
    "m": Named("moment", "vector", length=1, force=1, at_ends=True),
    "u": Named("strains", "vector", length=-1),
    "n1": Named("force along the normal", force=1, at_ends=True),
    "n2": Named("force across the width", force=1, at_ends=True),
    "n3": Named("force along the tangent", force=1, at_ends=True),
    "m1": Named("moment about the normal", length=1, force=1, at_ends=True),
    "m2": Named("bending moment", length=1, force=1, at_ends=True),
    "m3": Named("twisting moment", length=1, force=1, at_ends=True),
    "u1": Named("bending in the plane of the ribbon", length=-1, at_ends=True),
    "u2": Named("bending", length=-1, at_ends=True),
    "u3": Named("twist", length=-1, at_ends=True),
    "eta": Named("slope of the generatrices, u3 / u2"),
    "extension": Named("stretch of the centre line, |r'| - 1"),
    "energy": Named("strain energy per length", force=1),
    "potential": Named("energy per length less the work of loads along the ribbon", force=1),
    "H": Named("invariant W_Leg + n3", force=1),
    "n_dot_m": Named("invariant n . m", length=1, force=2),
    "switching": Named("what changes sign where the curvature may jump", length=1, force=1),
    "leap": Named("size of that jump, as a moment", length=1, force=1),
    "law_residual": Named("how far the strains are from the law", length=-1, checks=True),
    "orthonormality": Named("how far the directors are from a frame", checks=True),
}

#: those that formulas along the ribbon may use, with their shapes
OUTPUTS: Mapping[str, Shape] = {k: q.shape for k, q in QUANTITIES.items() if not q.checks}

#: those that equations may use at the ends, with their shapes
AT_ENDS: Mapping[str, Shape] = {k: q.shape for k, q in QUANTITIES.items() if q.at_ends}

#: vectors along the ribbon, which files of a solution hold
VECTORS = tuple(name for name, shape in OUTPUTS.items() if shape == "vector")

#: columns of a study: loads (lab frame) and strains at the start, a vector in each group ...
START_VECTORS = (("n0x", "n0y", "n0z"), ("m0x", "m0y", "m0z"), ("u1", "u2", "u3"))

#: ... and all numbers of an equilibrium
ANSWERS = ("energy", "potential", "H0", *(part for vector in START_VECTORS for part in vector))


def dimension(name: str) -> tuple[int, int]:
    """Return the exponents of (length, force); what has no name is a number without unit."""
    found = QUANTITIES.get(name)
    return (0, 0) if found is None else (found.length, found.force)
