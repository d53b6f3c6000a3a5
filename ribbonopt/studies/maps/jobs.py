"""The work of a map, a piece each for a worker: branches on a line, a locus, shapes at a point.

A piece is a ribbon of a batch with a task of its own: what happens to a worker, and to the rows
that it gives, is known there.
"""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.classes import dataclass
from ribbonopt.plain import Row
from ribbonopt.scene import ContinuationStage, Scene, dump_scene
from ribbonopt.scene.equilibria import Equilibria
from ribbonopt.scene.lens import with_value
from ribbonopt.scene.maps import MapPlan
from ribbonopt.studies.batch.study import Source, StudyRibbon

LINES, LOCI, POINTS = "map-branches", "map-loci", "map-points"
FOLDERS = (LINES, LOCI, POINTS)
LINE, LOCUS, SHAPES = "line", "locus", "shapes"
BEYOND = 3.0  # times the way from the point before to a special one: where a branch would go
EDGE = 1e-9  # of a range: what is on its end


@dataclass(frozen=True)
class Job:
    """A piece of work.

    Attributes
    ----------
    place : str
        Its folder in that of the map, such as `map-loci/2`; no other piece has it.
    task : str
        What is done: one of the names in `tasks`.
    scene : Scene
        What it is done to.
    inputs : dict
        What tells it from others, in its row as well.
    """

    place: str
    task: str
    scene: Scene
    inputs: Row

    def ribbon(self, number: int) -> StudyRibbon:
        """Return it as a worker takes it."""
        source = Source(self.scene.name, dump_scene(self.scene))
        return StudyRibbon(number, source, {}, self.inputs, place=self.place, task=self.task)


def line(scene: Scene, plan: MapPlan, number: int, along: str, value: float) -> Job:
    """Return the branches in one number, `along`, at a value of the other one."""
    other = plan.y if along == plan.x else plan.x
    begin, end = plan.parameters[along]
    stage = ContinuationStage(
        parameter=along,
        from_=begin,
        to=end,
        largest=plan.largest * (end - begin),
        switch=plan.switch,
    )
    there = replace(with_value(_bare(scene), other, value), continuation=stage)
    return Job(f"{LINES}/{number}", LINE, there, {"along": along, other: value})


def locus(scene: Scene, plan: MapPlan, number: int, begin: Row) -> Job:
    """Return the locus through a special point, both ways to the border of the map.

    It begins with the branch from the regular point before the special one up to this.

    Parameters
    ----------
    scene, plan
        The scene and its map.
    number
        Of the locus.
    begin
        What a line's row says of the point: its kind, its values, the number along which the branch
        goes that it is on, its folder, and which point is before.
    """
    along = begin["along"]
    other = plan.y if along == plan.x else plan.x
    low, high = plan.parameters[other]
    there, value, near = begin[other], begin[along], begin["near"]
    branch = ContinuationStage(
        parameter=along,
        from_=near["value"],
        to=value + BEYOND * (value - near["value"]),
        stop=(begin["kind"],),
    )
    inside = [end for end in (low, high) if abs(end - there) > EDGE * (high - low)]
    followed = ContinuationStage(
        parameter=(along, other),
        of=begin["kind"],
        between=plan.parameters[along],
        to=(inside[0], inside[1]) if len(inside) > 1 else inside[0],
        largest=plan.largest * (high - low),
    )
    bare = with_value(with_value(_bare(scene), along, value), other, there)
    inputs = {"kind": begin["kind"], "folder": begin["folder"], "point": near["point"]}
    return Job(f"{LOCI}/{number}", LOCUS, replace(bare, continuation=(branch, followed)), inputs)


def shapes(scene: Scene, plan: MapPlan, number: int, x: float, y: float) -> Job:
    """Return the count of all equilibria at a point of the map."""
    there = with_value(with_value(_bare(scene), plan.x, x), plan.y, y)
    if not isinstance(there.equilibria, Equilibria):
        there = replace(there, equilibria=Equilibria(along=(plan.x, plan.y)))
    return Job(f"{POINTS}/{number}", SHAPES, there, {plan.x: x, plan.y: y})


def _bare(scene: Scene) -> Scene:
    """Return a scene without what is followed in it."""
    return replace(scene, continuation=None, map=None)
