"""A map from beginning to end: jobs on workers, rows kept as they come, the map written.

with closing(MapFolder("results/NAME-map", scene, resume=False)) as folder:
    run_map(scene, folder)
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import replace

from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.plain import Row
from ribbonopt.problem.wellposed.reach import refuse_far_goals
from ribbonopt.scene import ContinuationStage, Scene
from ribbonopt.scene.lens import with_value
from ribbonopt.scene.maps import MapPlan
from ribbonopt.studies.continuation.curve import Curve
from ribbonopt.studies.continuation.stage import refuse_idle

from .crew import Crew
from .files import MapFolder
from .jobs import Job
from .survey import Survey
from .written import data_of, rows_of

Told = Callable[[str, int, int], None]


def plan_of(scene: Scene) -> MapPlan:
    """Return the map that a scene asks for.

    Raises
    ------
    ModelError
        If it asks for none, one of the numbers changes nothing, or the ranges lead to where no
        ribbon reaches.
    """
    plan = scene.map
    if plan is None:
        raise ModelError(
            "map: the scene has none; add for example 'map: {parameters: {parameters.angle: "
            "[0, 60], parameters.distance: [0.05, 0.4]}}'",
            "map",
        )
    bare = replace(scene, map=None, continuation=None)
    for path, other in ((plan.x, plan.y), (plan.y, plan.x)):
        begin, end = plan.parameters[path]
        stage = ContinuationStage(parameter=path, from_=begin, to=end)
        problem = None
        for value in plan.parameters[other]:
            there = with_value(bare, other, value)
            try:
                for far in (stage, replace(stage, from_=end, to=begin)):
                    refuse_far_goals(replace(there, continuation=far))
                problem = problem or prepare(with_value(there, path, begin)).problem
                refuse_idle(Curve(there, stage), problem)
            except ModelError as error:
                told = re.sub(r"^continuation\.[a-z]+: ", "", str(error))
                raise ModelError(f"map.parameters: {told}", "map.parameters") from None
    return plan


def run_map(
    scene: Scene,
    folder: MapFolder,
    jobs: int | None = None,
    told: Told = lambda what, done, total: None,
) -> Survey:
    """Explore the map of a scene and write it into its folder; what is there is not done again.

    Parameters
    ----------
    scene, folder
        The scene, and where its map goes.
    jobs
        Worker processes; by default one for each core that this process may use.
    told
        Is told what is done, how many of it, and of how many.

    Raises
    ------
    ModelError
        If the scene has no map.
    WorkerError
        If no process can be started that does anything.
    ConvergenceError
        If processes are lost on the way.
    """
    plan = plan_of(scene)
    with closing(Crew(str(folder.folder.absolute()), jobs)) as crew:

        def do(what: str, asked: Sequence[Job]) -> list[Row]:
            rows = {i: row for i, job in enumerate(asked) if (row := folder.row_of(job))}
            todo = [i for i in range(len(asked)) if i not in rows]
            told(what, len(rows), len(asked))
            with closing(crew.rows([asked[i].ribbon(i) for i in todo])) as came:
                for row in came:
                    i = row["number"]
                    rows[i] = row
                    folder.keep(asked[i], row)
                    told(what, len(rows), len(asked))
            return [rows[i] for i in range(len(asked))]

        survey = Survey(scene, plan, do)
        survey.explore()
    folder.write(data_of(survey), list(rows_of(survey)))
    return survey
