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

from ribbonopt.errors import ConvergenceError, WorkerError
from ribbonopt.plain import Row
from ribbonopt.studies.machine import cores

from .chunks import Chunk, chunks_of
from .processes import FEWER, WorkerProcess
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
    WorkerError
        If no process can be started that solves anything.
    ConvergenceError
        If the scheduler, or all processes, are lost on the way.
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


Work = tuple[Chunk, Mapping[int, str]]


def _on_this_machine(
    study: Study, chunks: list[Chunk], jobs: int, known: Mapping[int, str], folder: str
) -> Generator[Row, None, None]:
    work: queue.SimpleQueue[Work] = queue.SimpleQueue()
    for chunk in chunks:
        work.put((chunk, known))
    rows: queue.SimpleQueue[Row | Exception | None] = queue.SimpleQueue()
    workers = [WorkerProcess(study.save, folder, study.time_limit) for _ in range(jobs)]
    wanted = threading.Event()
    wanted.set()

    def serve(worker: WorkerProcess) -> None:
        try:
            worker.begin()
            with suppress(queue.Empty):
                while wanted.is_set():
                    _serve(worker, work, rows)
        except Exception as error:  # of a thread: raised where the rows are asked for
            rows.put(error)
        finally:
            rows.put(None)

    threads = [threading.Thread(target=serve, args=(worker,), daemon=True) for worker in workers]
    lost, count = None, 0
    try:
        running = _started(threads)
        while running:
            row = rows.get()
            if isinstance(row, WorkerError) and count:
                lost = row  # the others go on
            elif isinstance(row, Exception):
                raise row
            elif row is None:
                running -= 1
            else:
                count += 1
                yield row
        if lost is not None and not work.empty():
            raise ConvergenceError(
                f"{lost}; rows so far are kept, --resume goes on from there", "workers_lost"
            )
    finally:
        wanted.clear()
        for worker in workers:
            worker.close()
        for thread in threads:
            if thread.ident is not None:
                thread.join()


def _serve(
    worker: WorkerProcess,
    work: queue.SimpleQueue[Work],
    rows: queue.SimpleQueue[Row | Exception | None],
) -> None:
    """Take a chunk and give its rows; what is left of it goes back where no process is to be had.

    queue.Empty says that there is none.
    """
    chunk, known = work.get_nowait()
    done = {}
    try:
        for row in worker.rows(chunk, known):
            done[row["number"]] = row["status"]
            rows.put(row)
    except WorkerError:
        work.put((chunk, {**known, **done}))
        raise


def _started(threads: list[threading.Thread]) -> int:
    """Start threads and return how many there are."""
    try:
        for thread in threads:
            thread.start()
    except RuntimeError as error:
        raise WorkerError(f"no threads for {len(threads)} workers ({error}); {FEWER}") from None
    return len(threads)
