"""Named outputs of a cross section and the quantities conserved along the ribbon (section 7).

n and n . m are constant for any law without loads; H = W_Leg + n3 only where the law has an
energy. The regularised laws have none: for them both energies are replaced by m . u / 2, to which
W and W_Leg are equal for every 2-homogeneous energy, and the drift of H tells how far the law is
from having one.
"""

from __future__ import annotations

import casadi as ca

from .ends.conditions import CrossSection
from .laws.catalogue import ConstitutiveLaw
from .rod import RodState


def outputs(section: CrossSection, law: ConstitutiveLaw, u2: ca.SX, u3: ca.SX) -> dict[str, ca.SX]:
    """Expressions to sample on a solution, by name; vectors in the lab frame but u (directors).

    `u2`, `u3` are the strains of the formulation, `section` holds those of the inverse law.
    """
    rod = section.rod
    n, m = rod.along(rod.n), rod.along(rod.m)
    work = (m[1] * u2 + m[2] * u3) / 2
    w_leg = law.complementary_energy(m[1], m[2])
    result = {name: getattr(rod, name) for name in ("r", "d1", "d2", "d3", "n", "m")}
    result["u"] = ca.vertcat(0, u2, u3)
    result |= {"u1": ca.SX(0), "u2": u2, "u3": u3, "eta": u3 / ca.if_else(u2 == 0, ca.inf, u2)}
    result |= {f"n{i + 1}": n[i] for i in range(3)} | {f"m{i + 1}": m[i] for i in range(3)}
    result["energy"] = work
    result["H"] = n[2] + (work if w_leg is None else w_leg)
    result["n_dot_m"] = ca.dot(rod.n, rod.m)
    result["law_residual"] = ca.norm_2(ca.vertcat(u2 - section.u2, u3 - section.u3))
    result["orthonormality"] = _gram_error(rod)
    return result


def _gram_error(rod: RodState) -> ca.SX:
    """Largest departure of the products d_i . d_j from those of an orthonormal frame."""
    d = ca.horzcat(rod.d1, rod.d2, rod.d3)
    gram = d.T @ d - ca.SX.eye(3)
    return ca.norm_inf(ca.vec(ca.densify(gram)))
