"""Batches: all ribbons of a study, on all cores of one machine, or on a Dask cluster.

    for row in run_batch(load_study(["arches.yaml"]), jobs=2):
        print(row["number"], row["status"])

Rows come as they are ready. Each depends on its chunk alone, so that they are the same whatever the
number of workers.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Generator, Mapping
from contextlib import suppress

from ribbonopt.plain import Row
from ribbonopt.studies.machine import cores

from .chunks import Chunk, chunks_of
from .processes import WorkerProcess
from .study import Study


def run_batch(
    study: Study,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    known: Mapping[int, str] | None = None,
    folder: str = "",
) -> Generator[Row, None, None]:
    """Yield the rows of a study, in the order in which they are ready.

    Parameters
    ----------
    study
        What to solve.
    jobs
        Worker processes; by default one for each core that this process may use.
    scheduler
        Address of a Dask scheduler, whose workers are used instead.
    known
        Statuses of ribbons whose rows are there already, by number.
    folder
        Where full solutions go, in `solutions/NUMBER`; "" for nowhere.

    Raises
    ------
    SceneError
        If the scheduler cannot be reached, or its workers cannot run this.
    ConvergenceError
        If the scheduler is lost on the way.
    """
    done = dict(known or {})
    chunks = [
        chunk for chunk in chunks_of(study) if any(r.number not in done for r in chunk.ribbons)
    ]
    if scheduler is not None:
        from .cluster import rows_of_cluster  # the extra `distributed`

        yield from rows_of_cluster(study, chunks, scheduler, done, folder)
        return
    count = min(jobs or cores(), len(chunks))
    yield from _on_this_machine(study, chunks, count, done, folder)


def _on_this_machine(
    study: Study, chunks: list[Chunk], jobs: int, known: Mapping[int, str], folder: str
) -> Generator[Row, None, None]:
    work: queue.SimpleQueue[Chunk] = queue.SimpleQueue()
    for chunk in chunks:
        work.put(chunk)
    rows: queue.SimpleQueue[Row | Exception | None] = queue.SimpleQueue()
    workers = [WorkerProcess(study.save, folder, study.time_limit) for _ in range(jobs)]
    wanted = threading.Event()
    wanted.set()

    def serve(worker: WorkerProcess) -> None:
        try:
            with suppress(queue.Empty):
                while wanted.is_set():
                    for row in worker.rows(work.get_nowait(), known):
                        rows.put(row)
        except Exception as error:  # of a thread: raised where the rows are asked for
            rows.put(error)
        finally:
            rows.put(None)

    threads = [threading.Thread(target=serve, args=(worker,), daemon=True) for worker in workers]
    for thread in threads:
        thread.start()
    running = len(threads)
    try:
        while running:
            row = rows.get()
            if isinstance(row, Exception):
                raise row
            if row is None:
                running -= 1
            else:
                yield row
    finally:
        wanted.clear()
        for worker in workers:
            worker.close()
        for thread in threads:
            thread.join()
