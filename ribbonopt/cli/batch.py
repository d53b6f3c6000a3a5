"""The verb `batch`: all ribbons of a study, row by row."""

from __future__ import annotations

import argparse
import gc
import time
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from datetime import timedelta
from typing import TYPE_CHECKING, Any

from ribbonopt.errors import SceneError
from ribbonopt.scene.limits import JOBS

from .batch_report import report, took
from .common import (
    INTERRUPTED,
    NOT_CONVERGED,
    default_folder,
    drawn,
    pairs_of,
    refuse_idle_verbose,
)
from .progress import ProgressLine
from .terminal import complain, say, say_json
from .values import count

if TYPE_CHECKING:
    from pathlib import Path

    from ribbonopt.studies.batch.files import BatchFolder
    from ribbonopt.views.paper_style import Style

    from .drawing import Wanted

HUGE = 100_000  # ribbons, beyond which a study may be a mistake
MANY = 5_000  # ribbons, beyond which it takes a while until the first one is begun


def batch(options: argparse.Namespace) -> int:
    """Solve all ribbons of a study."""
    refuse_idle_verbose(options)
    pairs, begun = pairs_of(options.plot), time.perf_counter()
    from ribbonopt.studies.batch.batch import run_batch
    from ribbonopt.studies.batch.files import BatchFolder
    from ribbonopt.studies.batch.sweep import load_study

    if options.retry and not options.resume:
        raise SceneError("--retry: goes on with rows that are there; give --resume too")
    gc.enable()  # many rows, and threads that serve the workers
    jobs = None if options.jobs is None else count("--jobs", options.jobs, JOBS)
    study = load_study(options.study, options.set)
    study.check()
    if study.count > HUGE and not options.yes:
        raise SceneError(f"{study.name}: {study.count:,} ribbons; say --yes if that is meant")
    pairs = None if pairs is None else _columns(pairs, study.columns)
    if options.scheduler:
        from ribbonopt.studies.batch.cluster import check_cluster

        check_cluster(options.scheduler)  # before anything is written
    folder = BatchFolder(
        options.out or default_folder(study.name, "batch"),
        study,
        resume=options.resume,
        retry=options.retry,
    )
    try:
        with closing(folder):
            rows = run_batch(
                study,
                jobs=jobs,
                scheduler=options.scheduler,
                known=folder.known,
                folder=str(folder.folder.absolute()),
            )
            line, before = ProgressLine(quiet=options.quiet), folder.done
            with closing(rows), closing(line):
                if study.count > MANY:
                    line.show(f"ordering {study.count:,} ribbons")
                for row in rows:
                    folder.append(row)
                    if line.due or folder.done == study.count:
                        line.show(_progress(folder, line.rate(folder.done - before)))
            folder.finish()
            named, place = (study.name, study.count, study.keys), folder.folder
            status = drawn(lambda: _draw(*named, list(folder.rows), place, pairs, study.called))
    except KeyboardInterrupt:
        complain(
            f"interrupted; {len(folder.rows)} of {study.count} rows kept in {folder.folder}, "
            "--resume goes on from there"
        )
        return INTERRUPTED
    return _tell(options, folder, time.perf_counter() - begun) or status


def draw(result: Path, out: Path, pairs: list[tuple[str, str]], asked: Wanted) -> list[Path]:
    """Write report and figures of a batch folder again and return where."""
    from ribbonopt.studies.batch.files import load_batch

    study, rows = load_batch(result)
    from ribbonopt.studies.batch.special import with_columns

    columns = list(dict.fromkeys(name for row in rows for name in with_columns(row)))
    pairs = _columns(pairs, columns)
    from .drawing import column_named

    style = replace(asked.style, color=column_named(asked.style.color, columns))
    asked.refuse("figures of a batch show no ribbons", "camera", "half_width")
    asked.refuse(f"{result} is a batch, and no branch", "inset", "animate")
    named, labels = (study["name"], study["ribbons"], study["inputs"]), study.get("labels", {})
    return _draw(*named, rows, out, pairs, labels, style)


def _columns(pairs: list[tuple[str, str]], columns: Sequence[str]) -> list[tuple[str, str]]:
    """Return columns by their full names; SceneError for one that no row has."""
    from ribbonopt.studies.columns import column_of

    try:
        return [(column_of(x, columns), column_of(y, columns)) for x, y in pairs]
    except SceneError as error:
        raise SceneError(f"--plot: {error}") from None


def _draw(
    name: str,
    count: int,
    inputs: Sequence[str],
    rows: list[dict[str, Any]],
    out: Path,
    pairs: list[tuple[str, str]] | None,
    labels: Mapping[str, str],
    style: Style | None = None,
) -> list[Path]:
    """Write the report, and the figures where they are wanted, and return where."""
    from ribbonopt.studies.batch.special import with_columns
    from ribbonopt.viewer.report import write_report

    rows = [with_columns(row) for row in rows]
    report = write_report(rows, inputs, out / "report.html", name=name, count=count)
    if pairs is None:
        return [report]
    from ribbonopt.views.batch import save_batch_figures  # matplotlib
    from ribbonopt.views.paper_style import PLAIN

    return [report, *save_batch_figures(rows, inputs, out, pairs, labels, style or PLAIN)]


def _tell(options: argparse.Namespace, folder: BatchFolder, seconds: float) -> int:
    failed = [row for row in folder.rows if not row["verified"]]
    statuses = Counter(row["status"] for row in folder.rows)
    if options.json:
        say_json(
            {
                "name": folder.study.name,
                "status": "converged" if not failed else "some_failed",
                "verified": not failed,
                "ribbons": folder.study.count,
                "statuses": dict(statuses),
                "folder": str(folder.folder),
            }
        )
    elif not options.quiet:
        say(report(folder))
        if options.verbose:
            say(took(folder, seconds))
    if not failed:
        return 0
    first = min(failed, key=lambda row: int(row["number"]))
    complain(
        f"{folder.study.name}: {len(failed)} of {len(folder.rows)} ribbons failed; the "
        f"first is number {first['number']}: {why_failed(first)}"
    )
    return NOT_CONVERGED


def why_failed(row: Mapping[str, Any]) -> str:
    """Return how a ribbon failed, its status said once."""
    status, message = str(row["status"]), str(row["message"])
    return message if message.startswith(f"{status}: ") else f"{status}: {message}"


def _progress(folder: BatchFolder, rate: float) -> str:
    """Return how far a batch is: done, failed, rows a second, time left."""
    done, total = folder.done, folder.study.count
    left = f"{timedelta(seconds=round((total - done) / rate))} left"
    return f"{done}/{total} done, {folder.rows.failed} failed, {rate:.1f}/s, {left}"
