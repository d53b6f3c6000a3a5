"""The energy formulation: direct optimal control, minimise the strain energy over the controls.

States r and the unit quaternion; conditions on positions and directors only. What is prescribed of
forces and moments must be natural (zero work): it is not imposed but verified on the costates, from
which n and m(0) are recovered. Controls:

- smooth laws: (m2, m3), u = dW_Leg/dm, cost m . u - W_Leg;
- Sadowsky: (u2, u3, k) with -k <= u2 <= k and cost (k + u3^2 / k)^2 / 2, whose minimum over k is
  the convexified energy W_F.

Sign: with equations x_{e+1} - x_e - ... = 0 and the Lagrangian cost + lambda . equations, lambda is
the derivative of the energy with respect to a shift of the rest of the ribbon, which is n; a turn
by dt of the rest changes q by dt q / 2, hence m . e_k = lambda_q . (e_k q) / 2. With the dead
force in the cost, the costate of r is n - F.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.conditions import Component
from ribbonopt.mechanics.ends.placement import LoadAlong
from ribbonopt.mechanics.outputs import outputs
from ribbonopt.mechanics.rotations import product
from ribbonopt.scene import Scene

from .contract import BoundaryValueProblem, Phase
from .ribbon import RECOVERED, Ribbon


def energy(ribbon: Ribbon, scene: Scene) -> BoundaryValueProblem:
    """Return the optimal-control problem of a ribbon.

    Raises
    ------
    ModelError
        If the law has no energy, loads are prescribed that are not natural, or the states are not
        reduced.
    """
    refused = refusal(ribbon, scene)
    if refused is not None:
        raise ModelError(f"formulation energy: {refused.reason}; {refused.remedy}", refused.key)
    return minimum(ribbon)


def minimum(ribbon: Ribbon) -> BoundaryValueProblem:
    """Return the problem of least energy under the conditions on positions and directors.

    All other conditions but dead forces are left out, natural or not.
    """
    theta, model = ribbon.theta, ribbon.model
    x = ca.SX.sym("x", len(model.states))
    # Force and moment for outputs and verification only: they follow from the costates.
    loads = ca.vertcat(*(theta[name] for name in RECOVERED))
    section = ribbon.section(x, loads)
    dead = dead_force(ribbon)
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
        cost=cost - ca.dot(dead, section.rod.d3),
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
        recovered=dict(zip(RECOVERED, _loads(points[0], costate, dead, ribbon), strict=True)),
    )


def dead_force(ribbon: Ribbon) -> ca.SX:
    """Force (3,), lab frame, prescribed at an end that is free to follow it; zero elsewhere."""
    given = {
        c.axis: ribbon.theta[c.name]
        for c in ribbon.conditions
        if isinstance(c, Component) and _is_dead_force(ribbon, c)
    }
    force = ca.vertcat(*(given.get(axis, ca.SX(0)) for axis in "xyz"))
    for condition in ribbon.conditions:
        if isinstance(condition, LoadAlong):
            force += condition.dead(ribbon.theta)
    return force


def _is_dead_force(ribbon: Ribbon, condition: Component) -> bool:
    held = [
        c
        for c in ribbon.conditions
        if isinstance(c, Component) and (c.quantity, c.axis) == ("position", condition.axis)
    ]
    return condition.quantity == "force" and condition.axis in "xyz" and len(held) < 2


def _legendre(ribbon: Ribbon, z: ca.SX) -> ca.SX:
    value = ribbon.law.complementary_energy(z[0], z[1])
    assert value is not None  # `refusal` let only laws with an energy pass
    return value


def _loads(start: ca.SX, costate: ca.SX, dead: ca.SX, ribbon: Ribbon) -> list[ca.SX]:
    """Force and moment about the reference (lab frame) from the costates at the start."""
    n, q = costate[:3] + dead, ca.vertsplit(start[3:7])
    basis = ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
    m = ca.vertcat(*(ca.dot(costate[3:7], ca.vertcat(*product(e, q))) / 2 for e in basis))
    return ca.vertsplit(ca.vertcat(n, m - ca.cross(n, start[:3] - ribbon.reference)))


class Refusal(NamedTuple):
    """Why a ribbon is no minimum of an energy, what to do, and the key of the scene to blame."""

    reason: str
    remedy: str
    key: str


def refusal(ribbon: Ribbon, scene: Scene) -> Refusal | None:
    """Return why a scene's equilibrium cannot be stated as a minimum; None if it can."""
    if not ribbon.law.variational:
        return Refusal(
            f"the law {scene.law.type} has no energy",
            "use law variational (smooth, with an energy) or another formulation",
            "formulation",
        )
    if scene.states != "reduced":
        return Refusal(
            "costates of nine director components are not unique",
            "use states: reduced",
            "formulation",
        )
    for condition in ribbon.conditions:
        if not isinstance(condition, Component) or condition.kinematic or not condition.value:
            continue
        if not _is_dead_force(ribbon, condition):
            return Refusal(
                f"{condition.name}, other than zero, has no potential here (only a dead force, in "
                "lab components, on an end free to follow it has)",
                "use another formulation",
                condition.name,
            )
    return None
