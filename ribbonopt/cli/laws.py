"""The verb `compare` with `--laws`: a scene, a branch or a study under several laws."""

from __future__ import annotations

import argparse
import gc
from collections.abc import Callable
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ribbonopt.errors import SceneError
from ribbonopt.scene.limits import JOBS

from .common import NOT_CONVERGED, drawn, load
from .progress import ProgressLine
from .terminal import complain, say, say_json
from .values import count, size, words

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.figure import Figure

    from ribbonopt.studies.laws.choice import Edges, Sizes
    from ribbonopt.studies.laws.files import Compared

#: options of the one way to compare that mean nothing to the other
OF_LAWS = ("width", "thickness", "poisson", "edges", "jobs")
OF_PAIRS = ("formulations", "transcriptions", "tolerances")
Told = Callable[[str], None]


def refuse_without(options: argparse.Namespace) -> None:
    """Refuse options that need `--laws`."""
    for name in OF_LAWS:
        if getattr(options, name) is not None:
            raise SceneError(f"--{name}: is for laws; say which, such as --laws all")


def laws(options: argparse.Namespace) -> int:
    """Solve a scene, a branch or a study under several laws."""
    for name in OF_PAIRS:
        if getattr(options, name) is not None:
            raise SceneError(f"--{name}: compares formulations; leave it or --laws out")
    names, sizes = _names(options.laws), _sizes(options)
    gc.enable()  # many solutions, each soon done with
    from ribbonopt.studies.batch.sweep import is_study

    if is_study(options.scene):
        return _study(options, names, sizes)
    if options.jobs is not None:
        raise SceneError("--jobs: is for studies, whose ribbons are solved by several processes")
    scene, _ = load(options)
    from ribbonopt.studies.laws.choice import choices

    list(choices(scene, names, sizes))  # before minutes are spent
    if scene.continuation is not None:
        from ribbonopt.studies.laws.branch_table import branch_table
        from ribbonopt.studies.laws.branches import compare_branches

        follow = partial(compare_branches, scene, names, sizes)
        return _told(options, follow, branch_table, "law_branches.plot_law_branches")
    from ribbonopt.studies.laws.compare import compare_laws
    from ribbonopt.studies.laws.table import table

    solve = partial(compare_laws, scene, names, sizes)
    return _told(options, solve, table, "laws.plot_laws")


def _study(options: argparse.Namespace, names: tuple[str, ...], sizes: Sizes) -> int:
    from ribbonopt.studies.batch.sweep import load_study
    from ribbonopt.studies.laws.batches import compare_study
    from ribbonopt.studies.laws.branch_table import study_table

    jobs = None if options.jobs is None else count("--jobs", options.jobs, JOBS)
    study = load_study([options.scene], options.set)
    study.check()
    run = partial(compare_study, study, names, sizes, jobs)
    return _told(options, run, study_table, "law_batches.plot_law_batches")


def _told(
    options: argparse.Namespace,
    run: Callable[[Told], Any],
    table: Callable[[Any], str],
    plot: str,
) -> int:
    """Run a comparison, write it where that is wanted, and say what it found."""
    if options.out:
        from ribbonopt.output.staging import staged_result
        from ribbonopt.studies.laws.files import FILES, save_laws

        # The place is known to be good before minutes are spent.
        with staged_result(options.out, FILES) as stage:
            study = _shown(options, run)
            save_laws(study, stage.folder)
            written = stage.commit()
            status = drawn(lambda: _draw(study, plot, written / FILES[-1]))
    else:
        study, status = _shown(options, run), 0
    if options.json:
        say_json(dict(study.plain()))
    elif not options.quiet:
        say(table(study))
    if study.solved:
        return status
    complain(f"{study.name}: no law gave a verified solution")
    return NOT_CONVERGED


def _shown(options: argparse.Namespace, run: Callable[[Told], Any]) -> Compared:
    """Run with a line of progress on a terminal."""
    line = ProgressLine(quiet=options.quiet)

    def told(text: str) -> None:
        if line.due:
            line.show(text)

    with closing(line):
        found: Compared = run(told)
    return found


def _draw(study: Compared, name: str, path: Path) -> None:
    from importlib import import_module

    from ribbonopt.views.style import draw_all

    module, function = name.split(".")
    plot: Callable[[Mapping[str, Any]], Figure]
    plot = getattr(import_module(f"ribbonopt.views.{module}"), function)
    draw_all({path.name: lambda: plot(study.with_curves())}, path.parent)


def _names(text: str) -> tuple[str, ...]:
    from ribbonopt.studies.laws.choice import names_of

    return names_of(words(text) or [])


def _sizes(options: argparse.Namespace) -> Sizes:
    from ribbonopt.studies.laws.choice import Sizes

    return Sizes(
        size("--width", options.width),
        size("--thickness", options.thickness),
        size("--poisson", options.poisson, -1.0, 0.5),
        _edges(options.edges),
    )


def _edges(text: str | None) -> Edges:
    """Read what the start and the end do to a ribbon's edge."""
    found = [] if text is None else words(text) or []
    if text is None:
        return (None, None)
    if len(found) != 2 or not set(found) <= {"straight", "free"}:
        shown = ", ".join(found)
        wanted = "expected straight or free for the start, and for the end: straight,free"
        raise SceneError(f"--edges: found {shown!r}; {wanted}")
    start, end = found
    return start, end  # type: ignore[return-value]
