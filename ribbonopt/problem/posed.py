"""A posed scene: everything that mechanics, solvers and studies ask of it, made once.

A `Scene` is what a user wrote; `Posed` is what it means: in units Dw = L = 1, its conditions, its
loads, and every number by name (theta). All that follows takes this object, so that nothing is
converted, evaluated or built a second time.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.ends.boundary import conditions_of, start_frame, start_position
from ribbonopt.mechanics.ends.conditions import Condition
from ribbonopt.mechanics.laws.asymmetry import changed_by_flip, leaves_plane, never_bent
from ribbonopt.mechanics.laws.catalogue import bends_alone, fields_of, membrane_numbers, numbers_of
from ribbonopt.mechanics.loads.load import Load
from ribbonopt.scene import Loads, Scene
from ribbonopt.scene.planes import held
from ribbonopt.scene.sized import OfWidth
from ribbonopt.scene.units import Units, in_special_units, units_of

if TYPE_CHECKING:
    from ribbonopt.mechanics.stations import Station

#: force and moment at the start where they are not unknowns but follow from costates
RECOVERED = tuple(f"recovered.{name}" for name in ("nx", "ny", "nz", "mx", "my", "mz"))

NO_LOADS, SPECIAL = Loads(), Units()

Place = tuple[Array, Array]  # position (3,) and frame (3, 3), lab


@dataclass(frozen=True, eq=False)
class Posed:
    """A scene, its conditions, its loads and its numbers.

    Attributes
    ----------
    given : Scene
        As the user wrote it; of a loop whose piece is `auto` that of the piece.
    scene : Scene
        The same in units Dw = L = 1.
    conditions : tuple of Condition
        What it prescribes at the ends, in the order of its file.
    loads : tuple of Load
        What acts along the ribbon.
    units : Units
        Units of the scene as it was given, in units Dw = L = 1.
    stations : tuple of Station
        What acts, and holds, at single places between the ends.
    like : Posed or None
        The same but for the numbers of its law: what does not depend on these is taken from there.
    undivided : str
        Of a loop whose piece is `auto`, why no smaller one than the scene's is solved, in words.
    """

    given: Scene
    scene: Scene
    conditions: tuple[Condition, ...]
    loads: tuple[Load, ...]
    units: Units = SPECIAL
    stations: tuple[Station, ...] = ()
    like: Posed | None = None
    undivided: str = ""

    @classmethod
    def of(cls, scene: Scene, units: Units | None = None) -> Posed:
        """Pose a scene; in units of another one where they are to be compared number by number."""
        undivided, loop = "", scene.boundary.loop
        if scene.symmetric is not False or (loop is not None and loop.piece == "auto"):
            from ribbonopt.mechanics.ends.smallest import divided  # few scenes ask for it

            scene, undivided = divided(scene)
        scene, units = held(scene), units or units_of(scene)
        special = in_special_units(scene, units)
        loads: tuple[Load, ...] = ()
        if special.loads != NO_LOADS or special.gravity is not None:
            from ribbonopt.mechanics.loads.catalogue import loads_of  # few scenes have any

            loads = loads_of(special)
        stations: tuple[Station, ...] = ()
        if special.loads.points or special.supports:
            from ribbonopt.mechanics.loads.points import stations_of  # as above

            stations = stations_of(special)
        conditions = conditions_of(special)
        return cls(scene, special, conditions, loads, units, stations, undivided=undivided)

    def moved(self, scene: Scene, units: Units | None = None) -> Posed:
        """Pose a scene that has come from this one by other numbers, in its units unless given.

        Where the law alone has others, its ends and loads are not evaluated again.
        """
        scene, units = held(scene), units or units_of(scene)
        special, before = in_special_units(scene, units), self.scene
        kept = (
            value is vars(before)[name] for name, value in vars(special).items() if name != "law"
        )
        # How a loop closes, and what edges there are, depends on the numbers of a law.
        own = isinstance(special.law, OfWidth) or special.boundary.loop is not None
        if own or type(special.law) is not type(before.law) or not all(kept):
            return Posed.of(scene, units)
        first = self.like or self
        return Posed(scene, special, self.conditions, self.loads, units, self.stations, first)

    def under(self, **changes: Any) -> Posed:
        """Return the same ribbon, at the same ends, under other settings of the special scene.

        `changes` are fields of the scene other than boundary and interval: another law, another
        formulation. Numbers that stay are not evaluated again. States named here are those wanted.
        """
        planar = self.scene.planar and "states" not in changes
        special = replace(self.scene, **{"planar": planar, **changes})
        conditions, before = self.conditions, self.scene
        looped = special.boundary.loop is not None and special.formulation != before.formulation
        # A loop closes otherwise where energy is minimised; some laws have edges, others none.
        if looped or isinstance(special.law, OfWidth) != isinstance(before.law, OfWidth):
            conditions = conditions_of(special)
        return Posed(special, special, conditions, self.loads, stations=self.stations)

    @cached_property
    def theta(self) -> dict[str, float]:
        """Every number of the scene, in units Dw = L = 1, by name and in order."""
        values = {f"law.{name}": value for name, value in numbers_of(self.scene.law).items()}
        if self.like is not None and values.keys() <= self.like.theta.keys():
            return {**self.like.theta, **values}
        scene, (position, _) = self.scene, self.start
        for along in fields_of(scene):
            values |= along.numbers()
        values |= membrane_numbers(scene)
        values |= {"interval.start": scene.interval[0], "interval.end": scene.interval[1]}
        values |= {f"reference.{axis}": float(position[i]) for i, axis in enumerate("xyz")}
        values |= {f"parameters.{name}": value for name, value in scene.parameters.items()}
        for load in self.loads:
            values |= load.numbers()
        for station in self.stations:
            for action in station.actions:
                values |= action.numbers()
        for condition in self.conditions:
            values |= condition.theta()
        if scene.formulation == "energy":
            values |= dict.fromkeys(self.recovered, 0.0)
        return values

    @property
    def recovered(self) -> tuple[str, ...]:
        """Names of what follows from costates: n and m at the start, and all reactions."""
        unknown = (name for station in self.stations for name in station.unknown)
        return (*RECOVERED, *(f"recovered.{name}" for name in unknown))

    @property
    def loaded(self) -> bool:
        """Whether anything acts on the ribbon between its ends."""
        return bool(self.loads or self.stations)

    @property
    def places(self) -> Array:
        """Fractions (k,) of the length at which the stations are."""
        start, _ = self.scene.interval
        return np.array([(station.at - start) / self.length for station in self.stations])

    @cached_property
    def values(self) -> Array:
        """The numbers theta (nt,)."""
        return np.array(list(self.theta.values()))

    @cached_property
    def structure(self) -> tuple[object, ...]:
        """What scenes share that differ in numbers only, which serve one built program."""
        return self.scene.transcription, self.scene.solver, *self.equations

    @cached_property
    def equations(self) -> tuple[object, ...]:
        """What scenes share whose equations are the same, whatever solves them."""
        scene, like = self.scene, self.like
        # In a plane natural strains of a law may take it out of that.
        same = scene.states != "planar" or never_bent(scene)
        if like is not None and same and self.theta.keys() == like.theta.keys():
            return like.equations
        conditions = tuple(
            (type(c).__name__, *(v for v in vars(c).values() if isinstance(v, str)))
            for c in self.conditions
        )
        loads: tuple[object, ...] = tuple(load.structure_key for load in self.loads)
        loads += tuple(tuple(type(a) for a in station.actions) for station in self.stations)
        settings = type(scene.law), scene.formulation, scene.states
        # In a plane, which conditions are left depends on what plane it is; natural strains tell
        # whether there is one, what law holds in it, and whether a piece stands for all of a loop.
        plane: tuple[object, ...] = ()
        if scene.states == "planar":
            plane = *self.start[1][:, 1].round().tolist(), leaves_plane(scene, self.theta)
            plane = *plane, bends_alone(scene)
        plane = *plane, changed_by_flip(scene, self.theta)
        along = tuple(field.structure for field in fields_of(scene))
        return *settings, tuple(self.theta), conditions, along, loads, scene.boundary.also, plane

    @cached_property
    def start(self) -> Place:
        """Position and frame of the start, those of the lab where they are not prescribed."""
        boundary, parameters = self.scene.boundary, self.scene.parameters
        return start_position(boundary, parameters), start_frame(boundary, parameters)

    @property
    def length(self) -> float:
        """Length of the ribbon, in units Dw = L = 1."""
        start, end = self.scene.interval
        return end - start
