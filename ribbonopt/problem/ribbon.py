"""A posed scene's mechanics as CasADi expressions: what every formulation starts from.

All numbers of the scene become parameters theta of the problem, by name, so that another scene of
the same structure is another theta, not another problem.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

import casadi as ca

from ribbonopt.mechanics.ends.conditions import Condition, Context, CrossSection, EndName
from ribbonopt.mechanics.laws.catalogue import relation_of
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.mechanics.loads.load import Load
from ribbonopt.mechanics.model import RodModel, full_model, least_model
from ribbonopt.mechanics.section import Section

from .posed import Posed

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Ribbon:
    """Model, law, conditions, loads and parameters of one structure of scenes.

    Attributes
    ----------
    model, law : RodModel, ConstitutiveLaw
        The mechanics, all numbers being symbols.
    conditions, loads : tuples
        What scenes prescribe at the ends, and what acts between them.
    theta : mapping of str to SX
        Symbol of every parameter by name.
    position : SX symbol
        Arclength s, on which laws and loads may depend.
    idle : set of str
        Conditions that hold by themselves, since the model cannot do otherwise.
    """

    model: RodModel
    law: ConstitutiveLaw
    conditions: tuple[Condition, ...]
    loads: tuple[Load, ...]
    theta: Mapping[str, ca.SX]
    position: ca.SX
    idle: frozenset[str] = frozenset()
    _kept: dict[Callable[..., Any], Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, posed: Posed) -> Ribbon:
        """Return the mechanics of a posed scene, its numbers as symbols."""
        theta, position = {name: ca.SX.sym(name) for name in posed.theta}, ca.SX.sym("s")
        law = relation_of(posed.scene, theta.__getitem__, position)
        model = _model_of(posed, theta)
        return cls(model, law, posed.conditions, posed.loads, theta, position)

    @property
    def least(self) -> Ribbon:
        """The same with the fewest unknowns."""
        if not self.model.redundant:
            return self
        return replace(self, model=least_model(self.loads, self.theta.__getitem__), _kept={})

    def kept(self, make: Callable[[Ribbon], T]) -> T:
        """Return what is made of these mechanics, such as functions: made once, kept with them."""
        if make not in self._kept:
            self._kept[make] = make(self)
        found: T = self._kept[make]
        return found

    @property
    def parameters(self) -> ca.SX:
        """All parameters theta in one column."""
        return ca.vertcat(*self.theta.values())

    @property
    def reference(self) -> ca.SX:
        """Point (3,) on which the constant moment acts, in the lab frame."""
        return ca.vertcat(*(self.theta[f"reference.{axis}"] for axis in "xyz"))

    @property
    def interval(self) -> tuple[ca.SX, ca.SX]:
        """Arclengths of both ends."""
        return self.theta["interval.start"], self.theta["interval.end"]

    @cached_property
    def uniform(self) -> bool:
        """Whether the law is the same all along the ribbon, so that H is an invariant of it."""
        own = ca.SX.sym("own", len(self.law.states))
        strain = self.law.strain(Stress(ca.SX.sym("n", 3), ca.SX.sym("m", 3), own))
        return not ca.depends_on(strain, self.position)

    @property
    def conserved(self) -> tuple[str, ...]:
        """Outputs that stay constant: H of a uniform law with an energy, without loads."""
        return ("H",) if self.law.variational and self.uniform and not self.loads else ()

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states along s: those of the model, then those of the law."""
        return (*self.model.states, *self.law.states)

    @property
    def constants(self) -> tuple[str, ...]:
        """Names of the unknown constants."""
        return self.model.constants

    def section(self, x: ca.SX, c: ca.SX, s: ca.SX | None = None) -> CrossSection:
        """Cross section at states x, constants c and an arclength (the position unless given).

        With the strains of the inverse law.
        """
        s = self.position if s is None else s
        count = len(self.model.states)
        r, d1, d2, d3, n, m, own, u = self.section_function(x, c, self.parameters, s)
        return CrossSection(self.model, x[:count], Section(r, d1, d2, d3, n, m, s, own), u)

    @cached_property
    def section_function(self) -> ca.Function:
        """Function (x, c, theta, s) of r, d1, d2, d3, n, m, own states and strains u (3,).

        Calling it beats rebuilding it.
        """
        x, c = ca.SX.sym("x", len(self.states)), ca.SX.sym("c", len(self.constants))
        count = len(self.model.states)
        rod = self.model.section(x[:count], c, self.position, self.reference, x[count:])
        u = self.law.strain(rod.stress)
        vectors = [rod.r, rod.d1, rod.d2, rod.d3, rod.n, rod.m, rod.own, u]
        outputs = [ca.densify(vector) for vector in vectors]
        return ca.Function("section", [x, c, self.parameters, self.position], outputs)

    def rates(self, section: CrossSection, u: ca.SX) -> ca.SX:
        """Return dx/ds of the states of model and law for strains u (3,)."""
        model = self.model.rates(section.x, section.rod, u)
        return ca.vertcat(model, self.law.rates(section.rod.stress, u))

    def work(self, rod: Section) -> ca.SX:
        """Return the work f . r per length of the loads that have a potential."""
        theta = self.theta.__getitem__
        known = [load for load in self.loads if not load.without_potential]
        return sum((ca.dot(load.force(rod, theta), rod.r) for load in known), ca.SX(0))

    def residuals(
        self, start: ca.SX, end: ca.SX, c: ca.SX, *, kinematic_only: bool = False
    ) -> dict[str, ca.SX]:
        """All conditions by name, those that give states of model and law their meaning included.

        `kinematic_only` leaves out what is prescribed of loads.
        """
        context = self.context(start, end, c)
        sections = context.ends
        own = self.model.start_conditions(sections["start"].x)
        meaning = {f"start: {name}": value for name, value in own.items()}
        laws = [self._of_law(name, section) for name, section in sections.items()]
        chosen = [c for c in self.conditions if c.kinematic or not kinematic_only]
        found = _merge(meaning, *laws, *(condition.residuals(context) for condition in chosen))
        return {name: value for name, value in found.items() if name not in self.idle}

    def _of_law(self, end: EndName, section: CrossSection) -> dict[str, ca.SX]:
        """Return the law's own conditions at an end, by name."""
        rod = section.rod
        found = self.law.end_conditions(end, rod.stress).items()
        return {f"{end}: {name}": ca.substitute(v, self.position, rod.s) for name, v in found}

    def verdicts(self, start: ca.SX, end: ca.SX, c: ca.SX) -> dict[str, ca.SX]:
        """Return what to verify on a solution, by name."""
        context = self.context(start, end, c)
        return _merge(*(cond.verdicts(context) for cond in self.conditions))

    @cached_property
    def verdicts_function(self) -> tuple[tuple[str, ...], ca.Function]:
        """Names, and function (start, end, c, theta) of what to verify, built once."""
        start, end = (ca.SX.sym(name, len(self.states)) for name in ("start", "end"))
        c = ca.SX.sym("c", len(self.constants))
        verdicts = self.verdicts(start, end, c)
        inputs = [start, end, c, self.parameters]
        return tuple(verdicts), ca.Function("verdicts", inputs, [ca.vertcat(*verdicts.values())])

    def margins_function(self, kind: int) -> tuple[tuple[str, ...], int, ca.Function]:
        """Names, how many are margins, and function (x, c, theta, s) along a phase of a kind.

        Its values (k,) are the margins of the law, then minus the sizes of what must be zero.
        """
        x, c = ca.SX.sym("x", len(self.states)), ca.SX.sym("c", len(self.constants))
        stress = self.section(x, c).rod.stress
        margins = self.law.margins(kind, stress, self.law.branch(kind).strain(stress))
        zeros = self.law.zeros(kind, stress)
        values = *margins.values(), *(-ca.fabs(value) for value in zeros.values())
        inputs = [x, c, self.parameters, self.position]
        function = ca.Function("margins", inputs, [ca.densify(ca.vertcat(*values))])
        return (*margins, *zeros), len(margins), function

    def context(self, start: ca.SX, end: ca.SX, c: ca.SX) -> Context:
        """Both ends, for conditions."""
        names: tuple[EndName, EndName] = ("start", "end")
        states = zip(names, (start, end), self.interval, strict=True)
        sections = {name: self.section(x, c, s) for name, x, s in states}
        return Context(sections, self.theta.__getitem__)


def _model_of(posed: Posed, theta: Mapping[str, ca.SX]) -> RodModel:
    """Return the model that a scene names by `states`."""
    states, parts = posed.scene.states, (posed.loads, theta.__getitem__)
    if states == "planar":
        from ribbonopt.mechanics.planar import Plane, planar_model  # few scenes are in a plane

        return planar_model(*parts, Plane.of(posed.start[1]))
    return full_model(*parts) if states == "full" else least_model(*parts)


def _merge(*parts: Mapping[str, ca.SX]) -> dict[str, ca.SX]:
    """Join named expressions; a name that returns is numbered, so that none is lost."""
    result: dict[str, ca.SX] = {}
    for part in parts:
        for name, value in part.items():
            key, count = name, 2
            while key in result:
                key, count = f"{name} ({count})", count + 1
            result[key] = value
    return result
