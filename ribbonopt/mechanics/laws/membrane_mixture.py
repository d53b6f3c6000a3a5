"""Arcs of both sheets of a ribbon that gives in its own plane: as of a rigid one, otherwise loaded.

Along a mixture T = m2 + K stays zero, K of the natural strains, so that its drift
D = -T' = (1 + e) n1 + m1 u3 - u1 m3 + c2 - K' is zero: as if n1 were n1* = (1 + e) n1 - u1 m3. In
D' the strain u2 has the factor -(n3* + m3 u3 - m1^2 t), t = du3 / dm3, with

    n3* = (1 + e) n3 - n1^2 / EA - (m3^2 - m1^2) / B1,

and all else that is new there acts as a load along d1. So entering conditions, margins and the
strain u2 are those that the law of the rigid ribbon has at another stress.
"""

from __future__ import annotations

import casadi as ca

from .law import ConstitutiveLaw, Stress


def rigid_stress(
    rigid: ConstitutiveLaw, soft: ca.SX, long: ca.SX, position: ca.SX, stress: Stress
) -> Stress:
    """Return the stress under which a rigid mixture is what one that gives is.

    Parameters
    ----------
    rigid
        The mixture of the ribbon that is rigid in its plane.
    soft, long
        Compliances 1 / B1 and 1 / EA, expressions of the arclength `position`.
    stress
        Of the ribbon that gives; its couples c (3,) along the directors and loads f (3,) as
        `problem.imposed.loaded_stress` has them.
    """
    n, m, own, load, couple = stress
    moment = ca.SX.sym("m", 3)
    torsion = rigid.strain(stress._replace(m=moment))[2]
    along = ca.jtimes(torsion, moment, ca.SX([0.0, 0.0, 1.0]))
    u3, t = ca.substitute([torsion, along], [moment], [m])
    u1, e = soft * m[0], long * n[2]
    f, c = (ca.SX.zeros(3) if some is None else some for some in (load, couple))
    n1 = (1 + e) * n[0] - u1 * m[2]
    n3 = (1 + e) * n[2] - long * n[0] ** 2 - soft * (m[2] ** 2 - m[0] ** 2)
    soft_rate, long_rate = (ca.jacobian(some, position) for some in (soft, long))
    new = e * (2 * n[1] * u3 - f[0])
    new += n[0] * (long_rate * n[2] - long * (u1 * n[1] + f[2]))
    new += soft * m[2] * (c[0] - u3 * m[1] - (1 + e) * n[1]) + u1 * (2 * c[2] + u1 * m[1])
    new -= m[0] * (t * u1 * m[1] + soft_rate * m[2])
    force = ca.vertcat(f[0] - new, f[1], f[2])
    return Stress(ca.vertcat(n1, n[1], n3), m, own, force, couple)
