"""The verb `map`: loci in the plane of two numbers, and how many shapes there are between them."""

from __future__ import annotations

import argparse
import gc
from contextlib import closing
from typing import TYPE_CHECKING

from ribbonopt.scene.limits import JOBS

from .common import INTERRUPTED, NOT_CONVERGED, default_folder, drawn, load
from .map_report import report
from .progress import ProgressLine
from .terminal import complain, say, say_json
from .values import count

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.studies.maps.map import Map

    from .drawing import Wanted


def mapped(options: argparse.Namespace) -> int:
    """Draw the map of a scene."""
    jobs = None if options.jobs is None else count("--jobs", options.jobs, JOBS)
    scene, _ = load(options)
    from ribbonopt.studies.maps.files import MapFolder
    from ribbonopt.studies.maps.map import Map
    from ribbonopt.studies.maps.run import plan_of, run_map

    gc.enable()  # threads that serve the workers
    plan_of(scene)  # before anything is written
    place = options.out or default_folder(scene.name, "map")
    folder, line = MapFolder(place, scene, resume=options.resume), ProgressLine(quiet=options.quiet)

    def told(what: str, done: int, total: int) -> None:
        if line.due or done in (0, total):
            line.show(f"{what}: {done} of {total}")

    try:
        with closing(folder):
            with closing(line):
                run_map(scene, folder, jobs, told)
            found = Map.load(folder.folder)
            status = drawn(lambda: _draw(found, folder.folder))
    except KeyboardInterrupt:
        complain(
            f"interrupted; what is done is kept in {folder.folder}, --resume goes on from there"
        )
        return INTERRUPTED
    return _tell(options, found) or status


def draw(result: Path, out: Path, asked: Wanted) -> list[Path]:
    """Draw the figure of a map's folder again and return where."""
    from ribbonopt.studies.maps.map import Map

    asked.refuse(f"{result} is a map, and no branch", "inset", "animate")
    return _draw(Map.load(result), out, asked)


def _draw(found: Map, out: Path, asked: Wanted | None = None) -> list[Path]:
    from ribbonopt.views.map import save_map
    from ribbonopt.views.paper_style import PLAIN

    from .common import say_left_out

    style = asked.style if asked else PLAIN
    figure = save_map(found.data, found.pictured(), out, style)
    say_left_out(figure.left_out)
    return figure.paths


def _tell(options: argparse.Namespace, found: Map) -> int:
    if options.json:
        say_json({**found.data, "folder": str(found.folder)})
    elif not options.quiet:
        say(report(found))
    if found.data["status"] == "converged":
        return 0
    complain(f"{found.name}: {found.data['message']}; what was found is kept in {found.folder}")
    return NOT_CONVERGED
