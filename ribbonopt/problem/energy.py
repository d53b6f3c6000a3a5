"""The energy formulation: direct optimal control, minimise the strain energy over the controls.

States r and the unit quaternion; conditions on positions and directors only. What is prescribed of
forces and moments must be natural (zero work): it is not imposed but verified on the costates, from
which n and m(0) are recovered. Controls:

- smooth laws: (m2, m3), u = dW_Leg/dm, cost m . u - W_Leg;
- Sadowsky: (u2, u3, k) with -k <= u2 <= k and cost (k + u3^2 / k)^2 / 2, whose minimum over k is
  the convexified energy W_F.

Sign: with equations x_{e+1} - x_e - ... = 0 and the Lagrangian cost + lambda . equations, lambda is
the derivative of the energy with respect to a shift of the rest of the ribbon, which is n; a turn
by dt of the rest changes q by dt q / 2, hence m . e_k = lambda_q . (e_k q) / 2.
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.conditions import Component
from ribbonopt.mechanics.invariants import outputs
from ribbonopt.mechanics.rotations import product
from ribbonopt.scene import Scene

from .contract import BoundaryValueProblem, Phase
from .ribbon import RECOVERED, Ribbon


def energy(ribbon: Ribbon, scene: Scene) -> BoundaryValueProblem:
    """Return the optimal-control problem of a ribbon.

    Raises
    ------
    ModelError
        If the law has no energy, loads are prescribed that do work, or the states are not reduced.
    """
    _refuse(ribbon, scene)
    theta, model = ribbon.theta, ribbon.model
    x = ca.SX.sym("x", len(model.states))
    # Force and moment for outputs and verification only: they follow from the costates.
    loads = ca.vertcat(*(theta[name] for name in RECOVERED))
    section = ribbon.section(x, loads)
    local = ca.SX.sym("m", 2)
    strain = ribbon.law.strain(local[0], local[1])
    if ribbon.law.smooth:
        z = ca.SX.sym("m", 2)
        u2, u3 = ribbon.law.strain(z[0], z[1])
        cost = z[0] * u2 + z[1] * u3 - _legendre(ribbon, z)
        path, estimate = ca.SX(0, 1), local
    else:
        z = ca.SX.sym("u", 3)
        u2, u3, k = z[0], z[1], z[2]
        cost = (k + u3**2 / k) ** 2 / 2
        path = ca.vertcat(u2 - k, -u2 - k)
        estimate = ca.vertcat(*strain, ca.fmax(ca.fabs(strain[0]), ca.fabs(strain[1])))
    phase = Phase(
        dynamics=model.rates(x, section.rod, ca.vertcat(0, u2, u3)),
        length=theta["interval.end"] - theta["interval.start"],
        outputs=outputs(section, ribbon.law, u2, u3),
        path=path,
        cost=cost,
    )
    points = ca.SX.sym("start", x.numel()), ca.SX.sym("end", x.numel())
    costate = ca.SX.sym("costate", x.numel())
    return BoundaryValueProblem(
        position=ca.SX.sym("s"),
        state=x,
        algebraic=z,
        constants=ca.SX(0, 1),
        parameters=ca.vertcat(*theta.values()),
        start=theta["interval.start"],
        phases=(phase,),
        points=points,
        conditions=ribbon.residuals(*points, loads, kinematic_only=True),
        state_names=model.states,
        constant_names=(),
        parameter_names=tuple(theta),
        local=local,
        estimate=estimate,
        costate=costate,
        recovered=dict(zip(RECOVERED, _loads(points[0], costate, ribbon.reference), strict=True)),
    )


def _legendre(ribbon: Ribbon, z: ca.SX) -> ca.SX:
    value = ribbon.law.complementary_energy(z[0], z[1])
    assert value is not None  # `_refuse` let only laws with an energy pass
    return value


def _loads(start: ca.SX, costate: ca.SX, reference: ca.SX) -> list[ca.SX]:
    """Force and moment about the reference (lab frame) from the costates at the start."""
    n, q = costate[:3], ca.vertsplit(start[3:7])
    basis = ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
    m = ca.vertcat(*(ca.dot(costate[3:7], ca.vertcat(*product(e, q))) / 2 for e in basis))
    return ca.vertsplit(ca.vertcat(n, m - ca.cross(n, start[:3] - reference)))


def _refuse(ribbon: Ribbon, scene: Scene) -> None:
    if not ribbon.law.variational:
        raise ModelError(
            f"formulation energy: the law {scene.law.type} has no energy; use law variational "
            "(smooth, with an energy) or another formulation",
            "formulation",
        )
    if scene.states != "reduced":
        raise ModelError(
            "formulation energy: costates of nine director components are not unique; use "
            "states: reduced",
            "formulation",
        )
    for condition in ribbon.conditions:
        if isinstance(condition, Component) and not condition.kinematic and condition.value:
            raise ModelError(
                f"formulation energy: {condition.name} = {condition.value:g} does work that the "
                "strain energy does not hold; use another formulation",
                condition.name,
            )
