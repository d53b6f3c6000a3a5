"""A posed scene's mechanics as CasADi expressions: what every formulation starts from.

All numbers of the scene become parameters theta of the problem, by name, so that another scene of
the same structure is another theta, not another problem.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.mechanics.ends.conditions import Condition, CrossSection
from ribbonopt.mechanics.laws.catalogue import held_law, relation_of
from ribbonopt.mechanics.laws.law import ConstitutiveLaw, Stress
from ribbonopt.mechanics.loads.load import Load
from ribbonopt.mechanics.model import RodModel, full_model, least_model
from ribbonopt.mechanics.section import Section
from ribbonopt.scene.planes import said

from .posed import Posed

if TYPE_CHECKING:
    from ribbonopt.mechanics.stations import Station

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
    stations : tuple of Station
        What acts, and holds, at single places between the ends.
    """

    model: RodModel
    law: ConstitutiveLaw
    conditions: tuple[Condition, ...]
    loads: tuple[Load, ...]
    theta: Mapping[str, ca.SX]
    position: ca.SX
    idle: frozenset[str] = frozenset()
    stations: tuple[Station, ...] = ()
    _passed: ca.SX | None = None
    _kept: dict[Callable[..., Any], Any] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, posed: Posed) -> Ribbon:
        """Return the mechanics of a posed scene, its numbers as symbols."""
        theta, position = {name: ca.SX.sym(name) for name in posed.theta}, ca.SX.sym("s")
        law = held_law(posed.scene, relation_of(posed.scene, theta.__getitem__, position))
        law = law.direct() if posed.scene.formulation == "energy" else law
        model = _model_of(posed, theta)
        parts = posed.conditions, posed.loads, theta, position
        return cls(model, law, *parts, stations=posed.stations)

    @property
    def least(self) -> Ribbon:
        """The same with the fewest unknowns."""
        if not self.model.redundant:
            return self
        model = least_model(self.loads, self.theta.__getitem__, self.stations)
        return replace(self, model=model, _kept={})

    @property
    def marked(self) -> Ribbon:
        """The same with symbols for which stations are passed, to write equations of phases with.

        Itself if it has no stations.
        """
        if not self.stations:
            return self
        passed = ca.SX.sym("passed", len(self.stations))
        return replace(self, model=self.model.with_passed(passed), _passed=passed, _kept={})

    @property
    def passed(self) -> ca.SX:
        """The symbols of `marked`, one for each station: 1 behind it, 0 before."""
        return ca.SX(0, 1) if self._passed is None else self._passed

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
        loaded = self.loads or self.stations
        return ("H",) if self.law.variational and self.uniform and not loaded else ()

    @cached_property
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
        more = (self._passed,) if self._passed is not None else ()
        r, d1, d2, d3, n, m, own, u, e, *stepped = self.section_function(
            x, c, self.parameters, s, *more
        )
        rod = Section(r, d1, d2, d3, n, m, s, own, stepped[0] if stepped else None, e)
        return CrossSection(self.model, x[:count], rod, u)

    @cached_property
    def section_function(self) -> ca.Function:
        """Function (x, c, theta, s) of r, d1, d2, d3, n, m, own states, strains u, extension.

        With stations also of the force (3,) of what acts up to s. Calling it beats rebuilding it.
        """
        x, c = ca.SX.sym("x", len(self.states)), ca.SX.sym("c", len(self.constants))
        count = len(self.model.states)
        rod = self.model.section(x[:count], c, self.position, self.reference, x[count:])
        u, e = self.law.strain(rod.stress), self.law.extension(rod.stress)
        vectors = [rod.r, rod.d1, rod.d2, rod.d3, rod.n, rod.m, rod.own, u, e]
        vectors += [] if rod.stepped is None else [rod.stepped]
        outputs = [ca.densify(vector) for vector in vectors]
        more = [] if self._passed is None else [self._passed]
        inputs = [x, c, self.parameters, self.position, *more]
        return ca.Function("section", inputs, outputs)

    def rates(self, section: CrossSection, u: ca.SX, own: ca.SX | None = None) -> ca.SX:
        """Return dx/ds of the states of model and law for strains u (3,).

        `own` are those of the law where its strains alone do not tell them.
        """
        model = self.model.rates(section.x, section.rod, u)
        own = self.law.rates(section.rod.stress, u) if own is None else own
        # What the law's states and its strains have in common is worked out once.
        return ca.cse(ca.vertcat(model, own)) if self.law.states else model

    def work(self, rod: Section) -> ca.SX:
        """Return the work per length of the loads that have a potential."""
        theta = self.theta.__getitem__
        known = [load for load in self.loads if not load.without_potential]
        return sum((load.work(rod, theta) for load in known), ca.SX(0))


def _model_of(posed: Posed, theta: Mapping[str, ca.SX]) -> RodModel:
    """Return the model that a scene names by `states`."""
    states, parts = posed.scene.states, (posed.loads, theta.__getitem__)
    stations = posed.stations
    if states == "planar":
        from ribbonopt.mechanics.planar import Plane, planar_model  # few scenes are in a plane

        plane = Plane.of(posed.start[1], said(posed.scene))
        return planar_model(*parts, plane, stations)
    return full_model(*parts, stations) if states == "full" else least_model(*parts, stations)
