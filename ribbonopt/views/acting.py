"""What acts on a ribbon and what holds it, to be drawn: at its ends, between them, along it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.mechanics.ends.boundary import held_position
from ribbonopt.mechanics.ends.frames import components, frame_of, number
from ribbonopt.scene import End, Scene
from ribbonopt.solution.acting import at_places, forces_along
from ribbonopt.solution.solution import Solution

from .pieces import Array

PLACES = 18  # of a load along the ribbon
QUIET = 1e-6  # of the force at an end: what is carried and has no direction to show
ACROSS = 0.5  # component of the unit vector across a plane, from which an axis is


@dataclass(frozen=True, eq=False)
class Site:
    """What holds, and what acts, at one place.

    Attributes
    ----------
    path, at : str, float
        Name in the scene, and arclength.
    force, moment, reaction : (3,) arrays
        On the ribbon, lab frame: what is given, and the force carried along the axes held.
    held, whole : str, bool
        Lab axes along which the position is held, and whether that is all of it.
    clamped : bool
        Whether the frame is held.
    guide : (3,) array or None
        The line along which a clamp slides.
    outward : int
        -1 at the start, 1 at the end, 0 between.
    """

    path: str
    at: float
    force: Array
    moment: Array
    reaction: Array
    held: str = ""
    whole: bool = False
    clamped: bool = False
    guide: Array | None = None
    outward: int = 0


@dataclass(frozen=True, eq=False)
class Acting:
    """What acts on a ribbon: sites, and forces per length (k, 3) at arclengths s (k,) by load.

    `string` says whether one holds the end to the start.
    """

    sites: tuple[Site, ...] = ()
    s: Array = field(default_factory=lambda: np.empty(0))
    along: tuple[Array, ...] = ()
    string: bool = False

    @property
    def ways(self) -> Array:
        """Directions (k, 3) of forces that are given: unit vectors."""
        each = [site.force for site in self.sites]
        forces = np.concatenate([np.empty((0, 3)), *([f] for f in each), *self.along])
        sizes = np.linalg.norm(forces, axis=1)
        return np.asarray(forces[sizes > 0] / sizes[sizes > 0, None])

    @property
    def largest(self) -> float:
        """The largest of given forces, zero if there is none."""
        return max((float(np.linalg.norm(site.force)) for site in self.sites), default=0.0)

    @property
    def strongest(self) -> float:
        """The largest of given moments, zero if there is none."""
        return max((float(np.linalg.norm(site.moment)) for site in self.sites), default=0.0)

    @property
    def densest(self) -> float:
        """The largest force per length, zero if there is none."""
        return max((float(np.linalg.norm(f, axis=1).max()) for f in self.along), default=0.0)

    @property
    def places(self) -> dict[float, str]:
        """What acts and holds between the ends, in words, by arclength."""
        found: dict[float, str] = {}
        for site in self.sites:
            if not site.outward:
                name = site.path.removeprefix("loads.")
                found[site.at] = f"{found[site.at]}, {name}" if site.at in found else name
        return found


def acting_of(solution: Solution, ends: bool) -> Acting:
    """Return what acts on a solution, its supports included; with its `ends`, if it has any."""
    scene, (start, end) = solution.scene, solution.scene.interval
    s = start + (end - start) * (np.arange(PLACES) + 0.5) / PLACES
    along = forces_along(solution, s).values()
    sites = [*_between(solution)]
    if ends:
        sites += [_at_end(solution, -1, scene.boundary.start)]
        sites += [_at_end(solution, 1, scene.boundary.end)]
    string = ends and scene.boundary.end.distance is not None
    return Acting(tuple(sites), s, tuple(f for f in along if np.abs(f).max() > 0), string)


def _between(solution: Solution) -> Iterable[Site]:
    scene, zero = solution.scene, np.zeros(3)
    for place in at_places(solution):
        if place.support:
            support = scene.supports[int(place.path.rpartition(".")[2])]
            held = "".join(components(support.position, scene.parameters))
            yield Site(place.path, place.at, zero, zero, place.force, held, _whole(solution, held))
        else:
            yield Site(place.path, place.at, place.force, place.moment, zero)


def _at_end(solution: Solution, outward: int, end: End) -> Site:
    """Return what holds and acts at an end; a scene gives n, at the start minus the force."""
    scene, row = solution.scene, -1 if outward > 0 else 0
    values = {name: solution.at_nodes[name][row] for name in ("n", "d1", "d2", "d3")}
    axes = {"x": np.eye(3)[0], "y": np.eye(3)[1], "z": np.eye(3)[2]} | values
    given = [components(load, scene.parameters) for load in (end.force, end.moment)]
    force, moment = (sum((v * axes[a] for a, v in g.items()), np.zeros(3)) for g in given)
    held = "".join(held_position(end, scene.parameters))
    carried = np.array([axis in held for axis in "xyz"]) * values["n"]
    if np.linalg.norm(carried) <= QUIET * np.linalg.norm(values["n"]):
        carried = np.zeros(3)
    frame = frame_of(end, scene.parameters) is not None
    # In a plane one director tells the frame.
    clamped = frame or (scene.states == "planar" and bool(end.d1 or end.d3))
    return Site(
        "boundary.end" if outward > 0 else "boundary.start",
        float(scene.interval[row]),
        outward * force,
        outward * moment,
        outward * carried,
        held,
        _whole(solution, held),
        clamped,
        _guide(end, scene, held),
        outward,
    )


def _whole(solution: Solution, held: str) -> bool:
    """Whether the position is held, where these axes are; across a plane it needs not be."""
    across = solution.at_nodes["d2"][0] if solution.scene.states == "planar" else np.zeros(3)
    return all(axis in held or abs(across[i]) > ACROSS for i, axis in enumerate("xyz"))


def _guide(end: End, scene: Scene, held: str) -> Array | None:
    if end.along is not None:
        return np.array([number(v, scene.parameters) for v in end.along])
    free = [axis for axis in "xyz" if axis not in held]
    return np.eye(3)["xyz".index(free[0])] if len(free) == 1 else None
