"""What workers do for a map: follow the branches on a line, follow a locus, count shapes.

Each takes the scene of a job and gives what its row says beside its inputs. What is found is
written to the job's folder, which is there as a whole or not at all.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from ribbonopt.classes import dataclass
from ribbonopt.output.results import save_solution
from ribbonopt.output.staging import staged_result
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.plain import Row
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import with_value
from ribbonopt.scene.stages import ends_of, stages_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.batch.branches import OWN
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.files import BranchFolder
from ribbonopt.studies.continuation.walk.points import POINT

from .counted import counted
from .jobs import LINE, LOCUS, SHAPES
from .seeds import branches_of, is_known, seeds_at

MOST = 200  # branches of a line, shapes at a point: numbers are names of their folders
NUMBERED = frozenset(str(number) for number in range(1, MOST + 1))
DONE: Row = {"status": "converged", "verified": True, "message": ""}
Prepare = Callable[[Scene], Prepared]


@dataclass(frozen=True)
class Place:
    """The folder of a job: that of the map, its name in it, seconds to wait for a dead worker."""

    root: Path
    name: str
    wait: float

    @property
    def path(self) -> Path:
        """The folder."""
        return self.root / self.name


def follow_line(scene: Scene, prepare: Prepare, place: Place, inputs: Row) -> Row:
    """Follow the branches of all equilibria at both ends of a line and in its middle.

    Those that another one has led to are not followed again. Its row says of all special points
    where they are, in which folder, and the number of their points there.
    """
    along = inputs["along"]
    (stage,) = stages_of(scene)
    low, high = sorted((stage.from_ or 0.0, *ends_of(stage)))
    bare = replace(scene, continuation=None)
    prepared, rows, told, count = prepare(bare), list[list[Row]](), list[str](), 0
    specials: list[Row] = []
    with staged_result(place.path, NUMBERED, wait=place.wait, durable=False) as staged:
        for at, to in ((low, high), (high, low), ((low + high) / 2, (low, high))):
            seeds, below = seeds_at(with_value(bare, along, at), prepared, along, (low, high))
            # Without a limit a branch may go through the folds of all modes there are.
            limit = () if below is None else (f"energy > {below!r}",)
            asked = replace(stage, from_=at, to=to, stop=limit)
            there = replace(scene, continuation=asked)
            for seed in seeds:
                count += 1
                if is_known(seed, rows, along, at) or len(told) == MOST:
                    continue
                name = str(len(told) + 1)
                found, ending = _followed(there, prepared, staged.folder / name, seed)
                rows += branches_of(found)
                told.append(ending)
                said: Row = {**inputs, "folder": f"{place.name}/{name}"}
                specials += [
                    {**said, **row, "near": _beside(found, i, along)}
                    for i, row in enumerate(found)
                    if row["kind"] != POINT
                ]
        staged.commit()
    return {
        **DONE,
        "branches": len(told),
        "seeds": count,
        "endings": told,
        "specials": specials,
    }


def follow_locus(scene: Scene, prepare: Prepare, place: Place, inputs: Row) -> Row:
    """Follow a locus both ways; its row says where all its points are, way by way."""
    prepared = prepare(replace(scene, continuation=None))
    near = Branch.load(place.root / inputs["folder"])[inputs["point"]]
    with staged_result(place.path, OWN, wait=place.wait, durable=False) as staged:
        found, ending = _followed(scene, prepared, staged.folder, near)
        staged.commit()
    points = [row for row in found if row["stage"]]
    if not points:
        return {**DONE, "status": "not_followed", "verified": False, "message": ending}
    return {**DONE, "ending": ending, "points": points}


def count_shapes(scene: Scene, prepare: Prepare, place: Place, inputs: Row) -> Row:
    """Look for all equilibria at a point, and save each of them."""
    solutions, row = counted(scene, prepare(scene))
    with staged_result(place.path, NUMBERED, wait=place.wait, durable=False) as staged:
        for number, solution in enumerate(solutions[:MOST], start=1):
            folder = staged.folder / str(number)
            folder.mkdir()
            save_solution(solution, folder)
        staged.commit()
    return {**DONE, **row}


def _beside(rows: Sequence[Row], i: int, along: str) -> Row:
    """Return the regular point next to the special point i on its branch: number and value."""
    same = ("stage", "branch")
    for other in (*reversed(rows[:i]), *rows[i + 1 :]):
        if other["kind"] == POINT and all(other[key] == rows[i][key] for key in same):
            return {"point": other["number"], "value": other[along]}
    return {"point": rows[i]["origin"] or 0, "value": rows[i][along]}


TASKS: dict[str, Callable[[Scene, Prepare, Place, Row], Row]] = {
    LINE: follow_line,
    LOCUS: follow_locus,
    SHAPES: count_shapes,
}


def _followed(
    scene: Scene, prepared: Prepared, folder: Path, near: Solution | None = None
) -> tuple[list[Row], str]:
    """Follow what a scene continues into a folder; return the rows, and how it has ended."""
    folder.mkdir(exist_ok=True)
    continuation = Continuation(scene, prepared)
    continuation.near = near
    with closing(BranchFolder(folder, scene, resume=False)) as files:
        for _ in files.follow(continuation):
            pass
        return files.rows, continuation.ending.reason
