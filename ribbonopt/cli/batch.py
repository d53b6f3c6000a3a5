"""The verb `batch`: all ribbons of a study, row by row."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from contextlib import closing
from typing import TYPE_CHECKING

from ribbonopt.arguments import count
from ribbonopt.errors import SceneError

from .common import INTERRUPTED, NOT_CONVERGED, print_json

if TYPE_CHECKING:
    from ribbonopt.studies.batch_files import BatchFolder

HUGE = 100_000  # ribbons, beyond which a study may be a mistake


def batch(options: argparse.Namespace) -> int:
    """Solve all ribbons of a study."""
    from ribbonopt.studies.batch import reach, run_batch
    from ribbonopt.studies.batch_files import BatchFolder
    from ribbonopt.studies.sweep import load_study

    jobs = None if options.jobs is None else count("--jobs", options.jobs)
    study = load_study(options.study, options.set)
    if study.count > HUGE and not options.yes:
        raise SceneError(f"{study.name}: {study.count} ribbons; say --yes if that is meant")
    study.check()
    if options.scheduler:
        reach(options.scheduler).close()  # before anything is written
    folder = BatchFolder(options.out or f"results/{study.name}", study, resume=options.resume)
    rows = run_batch(
        study,
        jobs=jobs,
        scheduler=options.scheduler,
        known=folder.known,
        folder=str(folder.folder.absolute()),
    )
    bar = _Bar(study.count, folder)
    try:
        with closing(rows):
            for row in rows:
                folder.append(row)
                bar.show()
    except KeyboardInterrupt:
        bar.clear()
        print(
            f"ribbonopt: interrupted; {len(folder.rows)} of {study.count} rows kept in "
            f"{folder.folder}, --resume goes on from there",
            file=sys.stderr,
        )
        return INTERRUPTED
    finally:
        folder.close()
    bar.clear()
    return _tell(options, folder)


def _tell(options: argparse.Namespace, folder: BatchFolder) -> int:
    failed = [row for row in folder.rows if not row["verified"]]
    statuses = Counter(row["status"] for row in folder.rows)
    if options.json:
        print_json(
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
        said = ", ".join(f"{number} {status}" for status, number in statuses.most_common())
        seconds = sum(row.get("seconds", 0.0) for row in folder.rows)
        print(
            f"{folder.study.name}: {len(folder.rows)} ribbons: {said}\n"
            f"  {seconds:.1f} s of solving\n"
            f"  written: {folder.folder}: rows.jsonl, table.csv, study.json"
        )
    if not failed:
        return 0
    first = min(failed, key=lambda row: int(row["number"]))
    print(
        f"ribbonopt: {folder.study.name}: {len(failed)} of {len(folder.rows)} ribbons failed; the "
        f"first is number {first['number']}: {first['status']}: {first['message']}",
        file=sys.stderr,
    )
    return NOT_CONVERGED


class _Bar:
    """Progress on a terminal: done, failed, rate, time left."""

    def __init__(self, total: int, folder: BatchFolder) -> None:
        self.total, self.folder, self.width = total, folder, 0
        self.started, self.before = time.perf_counter(), len(folder.rows)

    def show(self) -> None:
        if not sys.stderr.isatty():
            return
        done = len(self.folder.rows)
        failed = sum(not row["verified"] for row in self.folder.rows)
        rate = (done - self.before) / max(time.perf_counter() - self.started, 1e-9)
        left = (self.total - done) / rate if rate else 0.0
        line = f"{done}/{self.total} done, {failed} failed, {rate:.1f}/s, {left:.0f} s left"
        print("\r" + line.ljust(self.width), end="", file=sys.stderr, flush=True)
        self.width = len(line)

    def clear(self) -> None:
        if self.width:
            print("\r" + " " * self.width + "\r", end="", file=sys.stderr, flush=True)
