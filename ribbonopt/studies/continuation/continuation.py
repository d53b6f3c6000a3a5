"""Continuation: branches of equilibria as a parameter of the scene moves, stage after stage.

    for point in Continuation(scene):
        print(point.row["law.epsilon"], point.row["energy"])

One structure is built; every point is a verified solution. Where a stage ends short of its goal,
the iterator ends and `endings` says why.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.smallest import settled
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.pipeline.skipped import skipped
from ribbonopt.problem.wellposed.reach import refuse_far_goals
from ribbonopt.scene import Scene
from ribbonopt.scene.continuation import ContinuationStage
from ribbonopt.scene.lens import value_at
from ribbonopt.scene.stages import ends_of, followed_stages, stages_of
from ribbonopt.scene.units import units_of
from ribbonopt.solution.solution import Solution
from ribbonopt.text import one_line, shortened

from .curve import Curve
from .locus.stage import LocusStage
from .locus.surface import Surface, curve_of
from .recorded import Recorder
from .stage import RibbonStage, refuse_idle
from .walk.branches import History, Key, Nothing, Register
from .walk.points import Point
from .walk.stages import followed
from .walk.walk import Ending


class Continuation:
    """The points of all stages of a scene, in order.

    Attributes
    ----------
    scene : Scene
        The scene, whose `continuation` says what is followed.
    near : Solution or None
        An equilibrium, of another law perhaps, near which the first one is looked for before the
        automatic start; none unless it is set.
    """

    near: Solution | None = None

    def __init__(self, scene: Scene, prepared: Prepared | None = None) -> None:
        """Prepare; nothing is solved yet. `prepared` is the same structure, built before.

        Raises
        ------
        ModelError
            If the scene has no `continuation`, or cannot be continued.
        """
        self.scene, self.stages = (scene := settled(scene)), asked_of(scene)
        refuse_far_goals(scene)
        first, before = curve_of(scene, self.stages[0]), scene
        self.prepared = prepared or prepare(first.scene_at(first.begin))
        # The same along all stages, however long or stiff the ribbon becomes.
        self._units = None if scene.ribbon is not None else units_of(first.scene_at(first.begin))
        for stage in self.stages:
            curve = curve_of(before, stage, self._units)
            refuse_idle(curve, self.prepared.problem)
            before = curve.scene_at(curve.goals[-1])
        if not self.prepared.problem.square:
            raise ModelError(
                f"formulation: {self.scene.formulation} is not a square system of equations, which "
                "continuation needs; use inverted, differentiated, or algebraic without bounds",
                "formulation",
            )
        self.recorder, self.register = Recorder(scene), Register()

    def __iter__(self) -> Iterator[Point[Solution]]:
        """Follow all stages from the start."""
        return self.resume(Nothing())

    @property
    def first_scene(self) -> Scene:
        """The scene where the first stage begins."""
        curve = self.curve(0, self.scene)
        return curve.scene_at(curve.begin)

    def curve(self, stage: int, scene: Scene) -> Curve:
        """Return the curve of a stage that begins at a scene.

        Where the stage does not say from where, that is where the stages before have ended.
        """
        found, given = self.stages[stage], self._given[stage]
        if given.from_ is None and given.values is None:
            found = replace(found, from_=value_at(scene, found.moved))
        return curve_of(scene, found, self._units)

    @cached_property
    def _given(self) -> tuple[ContinuationStage, ...]:
        """The stages as the scene has them, one for each that is followed."""
        return tuple(stage for _, stage in followed_stages(self.scene))

    def resume(self, history: History[Solution]) -> Iterator[Point[Solution]]:
        """Go on where a history ends, as if there had been no break."""
        return followed(len(self.stages), self._stage, self.register, history)

    @property
    def skipped(self) -> tuple[str, ...]:
        """What its solves do not need and is therefore not made, each with its reason."""
        return skipped(self.prepared.posed(), self.prepared.problem)

    @property
    def endings(self) -> dict[Key, Ending]:
        """How each stage, and each branch switched to, has ended so far, by (stage, branch)."""
        return self.register.endings

    @property
    def ending(self) -> Ending:
        """How the whole has ended: as the first stage that did not reach its goal, or the last.

        Before that, as one that has not: it is not reached, and says how far it is.
        """
        ways = [max(1, len(ends_of(stage))) for stage in self.stages]
        mains = {key: e for key, e in self.endings.items() if key[1] < ways[key[0]]}
        reasons = [ending.reason for ending in mains.values() if not ending.reached]
        short = Ending(False, "; ".join(reasons)) if reasons else None
        last = mains.get((len(ways) - 1, ways[-1] - 1))
        if ending := short or last:
            return ending
        done = sum((stage, count - 1) in mains for stage, count in enumerate(ways))
        where = f"{done} of {len(ways)} stages have ended" if done else "no stage has ended"
        return Ending(False, f"not followed to the end yet: {where}")

    def __repr__(self) -> str:
        """Say what is followed, and how far, in one line."""
        name = shortened(one_line(self.scene.name), 40)
        ways = [
            f"{stage.moved} from {stage.from_:.6g} to {end:.6g}"
            for stage in self.stages
            for end in ends_of(stage)
        ]
        done = f"{self.register.number} points so far" if self.register.number else "not begun"
        return f"<Continuation {name}: {shortened('; '.join(ways), 160)}; {done}>"

    def _stage(
        self, number: int, before: Point[Solution] | None, special: Point[Solution] | None
    ) -> RibbonStage | LocusStage:
        """Return a stage that begins where the one before has ended."""
        solution = None if before is None else before.solution
        curve = self.curve(number, self.scene if solution is None else solution.scene)
        if isinstance(curve, Surface):
            return LocusStage(self.prepared, curve, self.recorder, before, special)
        near = self.near if number == 0 else None
        return RibbonStage(self.prepared, curve, self.recorder, solution, near)


def asked_of(scene: Scene) -> tuple[ContinuationStage, ...]:
    """Return the stages of a scene, one at least; refuse a scene that has none."""
    if stages := stages_of(scene):
        return stages
    raise ModelError(
        "continuation: the scene has none; add for example "
        "'continuation: {parameter: law.epsilon, to: 1e-4, scale: log}'"
    )
