"""A scene's mechanics as CasADi expressions: what every formulation starts from.

All numbers of the scene become parameters theta of the problem, by name, so that another scene of
the same structure is another theta, not another problem.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.boundary import conditions_of, start_position
from ribbonopt.mechanics.ends.conditions import Condition, Context, CrossSection, EndName
from ribbonopt.mechanics.laws.catalogue import LAWS, ConstitutiveLaw
from ribbonopt.mechanics.rod import MODELS, RodModel, RodState
from ribbonopt.scene import Scene

#: force and moment at the start where they are not unknowns but follow from costates
RECOVERED = tuple(f"recovered.{name}" for name in MODELS["reduced"].constants)


@dataclass(frozen=True, eq=False)
class Ribbon:
    """Model, law, conditions and parameters of one scene.

    Attributes
    ----------
    model, law : RodModel, ConstitutiveLaw
        The mechanics, the numbers of the law being symbols.
    conditions : tuple of Condition
        What the scene prescribes.
    theta : mapping of str to SX
        Symbol of every parameter by name.
    """

    model: RodModel
    law: ConstitutiveLaw
    conditions: tuple[Condition, ...]
    theta: Mapping[str, ca.SX]

    @property
    def reference(self) -> ca.SX:
        """Point (3,) on which the constant moment acts, in the lab frame."""
        return ca.vertcat(*(self.theta[f"reference.{axis}"] for axis in "xyz"))

    def section(self, x: ca.SX, c: ca.SX) -> CrossSection:
        """Cross section at states x and constants c, with the strains of the inverse law."""
        *rod, u2, u3 = self.section_function(x, c, ca.vertcat(*self.theta.values()))
        return CrossSection(self.model, x, RodState(*rod), u2, u3)

    @cached_property
    def section_function(self) -> ca.Function:
        """Function (x, c, theta) of r, d1, d2, d3, n, m, u2, u3; calling it beats rebuilding it."""
        x = ca.SX.sym("x", len(self.model.states))
        c = ca.SX.sym("c", len(self.model.constants))
        rod = self.model.rod(x, c, self.reference)
        m = rod.along(rod.m)
        outputs = [rod.r, rod.d1, rod.d2, rod.d3, rod.n, rod.m, *self.law.strain(m[1], m[2])]
        return ca.Function("section", [x, c, ca.vertcat(*self.theta.values())], outputs)

    def residuals(
        self, start: ca.SX, end: ca.SX, c: ca.SX, *, kinematic_only: bool = False
    ) -> dict[str, ca.SX]:
        """All conditions by name, those that make the start's directors a frame included."""
        context = self.context(start, end, c)
        normalisation = {
            f"start: {name}": value for name, value in self.model.normalisation(start).items()
        }
        chosen = [c for c in self.conditions if c.kinematic or not kinematic_only]
        return _merge(normalisation, *(condition.residuals(context) for condition in chosen))

    def verdicts(self, start: ca.SX, end: ca.SX, c: ca.SX) -> dict[str, ca.SX]:
        """Return what to verify on a solution, by name."""
        context = self.context(start, end, c)
        return _merge(*(cond.verdicts(context) for cond in self.conditions))

    @cached_property
    def verdicts_function(self) -> tuple[tuple[str, ...], ca.Function]:
        """Names, and function (start, end, c, theta) of what to verify, built once."""
        start, end = (ca.SX.sym(name, len(self.model.states)) for name in ("start", "end"))
        c = ca.SX.sym("c", len(self.model.constants))
        verdicts = self.verdicts(start, end, c)
        inputs = [start, end, c, ca.vertcat(*self.theta.values())]
        return tuple(verdicts), ca.Function("verdicts", inputs, [ca.vertcat(*verdicts.values())])

    def context(self, start: ca.SX, end: ca.SX, c: ca.SX) -> Context:
        """Both ends, for conditions."""
        sections: dict[EndName, CrossSection] = {
            "start": self.section(start, c),
            "end": self.section(end, c),
        }
        return Context(sections, lambda name: self.theta[name])


def ribbon_of(scene: Scene) -> Ribbon:
    """Return the mechanics of a scene, its numbers as symbols."""
    symbols = {name: ca.SX.sym(name) for name in theta_of(scene)}
    kind = LAWS[scene.law.type]
    names = [f.name for f in fields(scene.law) if f.name != "type"]
    law = kind(**{name: symbols[f"law.{name}"] for name in names})
    return Ribbon(MODELS[scene.states], law, conditions_of(scene), symbols)


# One solve asks for the numbers of one scene again and again. Scenes do not change.
_latest: list[Any] = []


def theta_of(scene: Scene) -> dict[str, float]:
    """Return every number of a scene, in units Dw = L = 1, by name and in the order of theta."""
    return dict(_read(scene)[1])


def _read(scene: Scene) -> tuple[tuple[Condition, ...], dict[str, float]]:
    """Conditions and numbers of a scene."""
    if not _latest or _latest[0] is not scene:
        conditions = conditions_of(scene)
        _latest[:] = scene, (conditions, _theta_of(scene, conditions))
    found: tuple[tuple[Condition, ...], dict[str, float]] = _latest[1]
    return found


def _theta_of(scene: Scene, conditions: tuple[Condition, ...]) -> dict[str, float]:
    if scene.ribbon is not None:
        raise ModelError("this scene is in SI; convert it by `in_special_units` first", "ribbon")
    values = {
        f"law.{f.name}": float(getattr(scene.law, f.name))
        for f in fields(scene.law)
        if f.name != "type"
    }
    values |= {"interval.start": scene.interval[0], "interval.end": scene.interval[1]}
    reference = start_position(scene.boundary, scene.parameters)
    values |= {f"reference.{axis}": float(reference[i]) for i, axis in enumerate("xyz")}
    values |= {f"parameters.{name}": value for name, value in scene.parameters.items()}
    for condition in conditions:
        values |= condition.theta()
    if scene.formulation == "energy":
        values |= dict.fromkeys(RECOVERED, 0.0)
    return values


def structure_of(scene: Scene) -> tuple[object, ...]:
    """Return what scenes share that differ in numbers only, which serve one built problem."""
    posed, values = _read(scene)
    conditions = tuple(
        (type(c).__name__, *(v for v in vars(c).values() if isinstance(v, str))) for c in posed
    )
    settings = scene.law.type, scene.formulation, scene.states, scene.transcription, scene.solver
    return (*settings, tuple(values), conditions, scene.boundary.also)


def theta_values(scene: Scene) -> Array:
    """Return the parameters theta (nt,) of a scene."""
    return np.array(list(theta_of(scene).values()))


def _merge(*parts: dict[str, ca.SX]) -> dict[str, ca.SX]:
    """Join named expressions; a name that returns is numbered, so that none is lost."""
    result: dict[str, ca.SX] = {}
    for part in parts:
        for name, value in part.items():
            key, count = name, 2
            while key in result:
                key, count = f"{name} ({count})", count + 1
            result[key] = value
    return result
