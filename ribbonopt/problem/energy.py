"""The energy formulation: direct optimal control, minimise the strain energy over the controls.

States r and the unit quaternion; conditions on positions and directors only. What is prescribed of
forces and moments must be natural (zero work): it is not imposed but verified on the costates, from
which n and m(0) are recovered. Controls:

- smooth laws: the moments, u = dW_Leg/dm, cost m . u - W_Leg;
- where the centre line stretches n3 as well, e = dW_Leg/dn3, cost that and n3 e;
- Sadowsky: (u2, u3, k) with -k <= u2 <= k and cost (k + u3^2 / k)^2 / 2, whose minimum over k is
  the convexified energy W_F.

Sign: with equations x_{e+1} - x_e - ... = 0 and the Lagrangian cost + lambda . equations, lambda is
the derivative of the energy with respect to a shift of the rest of the ribbon, which is n; a turn
by dt of the rest changes q by dt q / 2, hence m . e_k = lambda_q . (e_k q) / 2. Dead loads f along
the ribbon are in the cost as -f . r, so that the costate of r is n all along it, whether the start
is free to move or not; a dead force Q at an end, or at a place beyond s, is there as -Q . r', and
that costate is n - Q.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.conditions import Component
from ribbonopt.mechanics.ends.placement import LoadAlong
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.mechanics.laws.parts import Relaxed
from ribbonopt.mechanics.outputs import outputs, own_name, singular
from ribbonopt.mechanics.section import Section
from ribbonopt.scene.planes import said

from .contract import BoundaryValueProblem, Phase
from .equilibrium import local_stress
from .held import held_between
from .imposed import residuals
from .posed import RECOVERED, Posed
from .potentials import Refusal, is_dead_force, without_potential
from .ribbon import Ribbon

REDUCED = "use states: reduced"
WITHOUT = {
    "full": "costates of nine director components are not unique",
    "planar": "it is stated in space, where the scene's ends may not determine it",
}


def energy(ribbon: Ribbon, posed: Posed) -> BoundaryValueProblem:
    """Return the optimal-control problem of a ribbon.

    Raises
    ------
    ModelError
        If the law has no energy, loads are prescribed that are not natural, or the states are not
        reduced.
    """
    refused = refusal(ribbon, posed)
    if refused is not None:
        raise ModelError(f"formulation energy: {refused.reason}; {refused.remedy}", refused.key)
    return minimum(ribbon)


def minimum(ribbon: Ribbon) -> BoundaryValueProblem:
    """Return the problem of least energy under the conditions on positions and directors.

    All other conditions but dead forces are left out, natural or not.
    """
    count, held = len(ribbon.states), held_between(ribbon)
    x = ca.SX.sym("x", count + len(held.names))
    # Force and moment for outputs and verification only: they follow from the costates.
    names = [f"recovered.{name}" for name in ribbon.constants]
    loads = ca.vertcat(*(ribbon.theta[name] for name in names))
    section, (start, end) = ribbon.section(x[:count], loads), ribbon.interval
    beyond = dead_force(ribbon) + ribbon.model.beyond(ribbon.position)
    program = _program(ribbon.law, section.rod.stress, held.estimate)
    rod = replace(section.rod, extension=program.extension)
    section, work = replace(section, rod=rod), ribbon.work(rod)
    phase = Phase(
        dynamics=ca.vertcat(ribbon.rates(section, program.u, program.rates), held.rates(rod)),
        length=end - start,
        outputs=outputs(section, ribbon.law, program.u, work) | program.outputs(rod, work),
        path=program.path,
        singular=_singular(ribbon.law, rod.stress),
        cost=program.cost - ca.dot(beyond, rod.tangent) - work,
    )
    points = ca.SX.sym("start", x.numel()), ca.SX.sym("end", x.numel())
    costate = ca.SX.sym("costate", x.numel())
    at_start = ca.substitute(beyond, ribbon.position, start)
    first, last = (point[:count] for point in points)
    conditions = residuals(ribbon, first, last, loads, kinematic_only=True)
    conditions |= held.conditions(*points)
    dead = at_start + held.force(costate)
    at_reference = ribbon.model.of_costates(points[0], costate, dead, ribbon.reference)
    known = dict(zip(RECOVERED, ca.vertsplit(at_reference), strict=True))  # in a plane too many
    found = [known[name] for name in names if name in known] + held.reactions(costate)
    return BoundaryValueProblem(
        position=ribbon.position,
        state=x,
        algebraic=program.controls,
        constants=ca.SX(0, 1),
        parameters=ribbon.parameters,
        start=start,
        phases=(phase,),
        points=points,
        conditions=conditions,
        state_names=(*ribbon.states, *held.names),
        constant_names=(),
        parameter_names=tuple(ribbon.theta),
        local=program.local,
        estimate=program.estimate,
        costate=costate,
        recovered=dict(zip(names, found, strict=False)),
        completed=held.completed(x, loads[len(RECOVERED) :]),
    )


class _Program(NamedTuple):
    """Controls along the ribbon, and strains, cost and inequalities as expressions of them."""

    controls: ca.SX
    u: ca.SX
    cost: ca.SX
    path: ca.SX
    local: ca.SX
    estimate: ca.SX
    extension: ca.SX | float = 0.0
    rates: ca.SX | None = None
    told: Relaxed | None = None

    def outputs(self, rod: Section, work: ca.SX) -> dict[str, ca.SX]:
        """Return those outputs of which only these controls tell, by name."""
        if self.told is None or self.told.strain is None or self.told.complementary is None:
            return {}
        return {
            "energy": self.cost,
            "potential": self.cost - work,
            "H": rod.stress.n[2] + self.told.complementary,
            "law_residual": ca.norm_2(self.u - self.told.strain),
            **{own_name(name): value for name, value in self.told.own.items()},
        }


def _program(law: ConstitutiveLaw, at: Stress, more: ca.SX) -> _Program:
    """Return the program of a law at a stress; `more` is where to start states behind its own."""
    local, known = local_stress(law)
    r, guessed = law.relaxed(at), law.relaxed(known)
    if r is not None and guessed is not None:
        start = ca.vertcat(known.own, more, guessed.estimate)
        return _Program(r.controls, r.u, r.cost, r.path, local, start, r.extension, r.rates, r)
    estimate = law.controls_at(known)
    z = ca.SX.sym("m", estimate.numel())
    stress = law.stress_of(z, at.own)
    u = law.strain(stress)
    cost, _ = law.densities(stress, u)
    start = ca.vertcat(known.own, more, estimate)
    return _Program(z, u, cost, ca.SX(0, 1), local, start, law.extension(stress))


def _singular(law: ConstitutiveLaw, stress: Stress) -> ca.SX:
    """Where a law is singular, and where its strains jump: here no phase ends there."""
    found = singular(law, stress)
    if law.smooth or law.fades:
        return found
    switch = law.switching(stress)
    return ca.vertcat(found, ca.horzcat(switch.value, 0, switch.leap / 2, -1))


def dead_force(ribbon: Ribbon) -> ca.SX:
    """Force (3,), lab frame, prescribed at an end that is free to follow it; zero elsewhere."""
    given = {
        c.axis: ribbon.theta[c.name]
        for c in ribbon.conditions
        if isinstance(c, Component) and is_dead_force(ribbon.conditions, c)
    }
    force = ca.vertcat(*(given.get(axis, ca.SX(0)) for axis in "xyz"))
    for condition in ribbon.conditions:
        if isinstance(condition, LoadAlong):
            force += condition.dead(ribbon.theta)
    return force


def refusal(ribbon: Ribbon, posed: Posed) -> Refusal | None:
    """Return why a scene's equilibrium cannot be stated as a minimum; None if it can."""
    if not ribbon.law.variational:
        return Refusal(
            f"the law {posed.scene.law.type} has no energy",
            "use law variational (smooth, with an energy) or another formulation",
            "formulation",
        )
    if posed.scene.states in WITHOUT:
        instead = said(posed.scene).instead if posed.scene.states == "planar" else REDUCED
        return Refusal(WITHOUT[posed.scene.states], instead, "formulation")
    return without_potential(ribbon)
