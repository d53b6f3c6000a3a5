"""Named outputs of a cross section and the quantities conserved along the ribbon (section 7).

Without loads n and n . m are constant for any law; H = W_Leg + n3 only where the law has an energy.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

from .ends.conditions import CrossSection
from .laws.law import ConstitutiveLaw, Stress
from .section import Section

OWN = "own."  # before the name of a state of the law's own
SLOPE = "slope"  # at most 1 where one sheet allows the strains; in its absence |eta| tells


def outputs(
    section: CrossSection, law: ConstitutiveLaw, u: ca.SX, work: ca.SX | float = 0.0
) -> dict[str, ca.SX]:
    """Expressions to sample on a solution, by name; vectors in the lab frame but u (directors).

    `u` (3,) are the strains of the formulation, `section` holds those of the inverse law. `work` is
    that of the loads per length.
    """
    rod = section.rod
    stress = rod.stress
    energy, complementary = law.densities(stress, u)
    switch = law.switching(stress)
    result = {name: getattr(rod, name) for name in ("r", "d1", "d2", "d3", "n", "m")}
    result["u"] = u
    result |= {f"u{i + 1}": u[i] for i in range(3)}
    result["eta"] = u[2] / ca.if_else(u[1] == 0, ca.inf, u[1])
    result |= {f"n{i + 1}": stress.n[i] for i in range(3)}
    result |= {f"m{i + 1}": stress.m[i] for i in range(3)}
    result["extension"] = ca.SX(rod.extension)
    result["energy"] = energy
    result["potential"] = energy - work
    result["H"] = stress.n[2] + complementary
    result["n_dot_m"] = ca.dot(rod.n, rod.m)
    result |= {"switching": switch.value, "leap": switch.leap}
    slope = law.sheet_slope(stress, u)
    if slope is not None:
        result[SLOPE] = slope
    result["law_residual"] = ca.norm_2(u - section.u)
    result["orthonormality"] = _gram_error(rod)
    result |= dict(zip(map(own_name, law.states), ca.vertsplit(rod.own), strict=True))
    return result


def sheet_slopes(values: Mapping[str, Array]) -> Array:
    """Return what is at most 1 where one sheet allows the strains: |eta|, or what its law says.

    `values` are outputs by name, as they are sampled on a solution.
    """
    return np.abs(values[SLOPE if SLOPE in values else "eta"])


def singular(law: ConstitutiveLaw, stress: Stress) -> ca.SX:
    """Where a law is singular at complex s, rows (re, im, size, fades): `laws.law.Singular`."""
    rows = [ca.horzcat(*where) for where in law.singular(stress)]
    return ca.vertcat(ca.SX(0, 4), *rows)


def own_name(state: str) -> str:
    """Name of the output that holds a state of the law's own."""
    return OWN + state


def _gram_error(rod: Section) -> ca.SX:
    """Largest departure of the products d_i . d_j from those of an orthonormal frame."""
    d = ca.horzcat(rod.d1, rod.d2, rod.d3)
    gram = d.T @ d - ca.SX.eye(3)
    return ca.norm_inf(ca.vec(ca.densify(gram)))
