"""Batches: all ribbons of a study, on all cores of one machine, or on a Dask cluster.

    for row in run_batch(load_study(["arches.yaml"]), jobs=2):
        print(row["number"], row["status"])

Rows come as they are ready. Each depends on its chunk alone, so that they are the same whatever the
number of workers.
"""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Generator, Iterable
from typing import Any

from ribbonopt.errors import SceneError

from .chunks import Chunk, chunks_of
from .crew import Crew
from .sweep import Study

Row = dict[str, Any]


def run_batch(
    study: Study,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    known: Iterable[int] = (),
    folder: str = "",
) -> Generator[Row, None, None]:
    """Yield the rows of a study, in the order in which they are ready.

    Parameters
    ----------
    study
        What to solve.
    jobs
        Worker processes; by default one for each core.
    scheduler
        Address of a Dask scheduler, whose workers are used instead.
    known
        Numbers of ribbons whose rows are there already.
    folder
        Where full solutions go, in `solutions/NUMBER`; "" for nowhere.

    Raises
    ------
    SceneError
        If the scheduler cannot be reached.
    """
    done = frozenset(known)
    chunks = [
        chunk for chunk in chunks_of(study) if any(r.number not in done for r in chunk.ribbons)
    ]
    if scheduler is not None:
        yield from _on_cluster(study, chunks, scheduler, done, folder)
        return
    count = min(jobs or os.cpu_count() or 1, len(chunks))
    yield from _on_this_machine(study, chunks, count, done, folder)


def _on_this_machine(
    study: Study, chunks: list[Chunk], jobs: int, known: frozenset[int], folder: str
) -> Generator[Row, None, None]:
    work: queue.SimpleQueue[Chunk] = queue.SimpleQueue()
    for chunk in chunks:
        work.put(chunk)
    rows: queue.SimpleQueue[Row | BaseException | None] = queue.SimpleQueue()
    crews = [Crew(study.save, folder, study.time_limit) for _ in range(jobs)]
    wanted = threading.Event()
    wanted.set()

    def serve(crew: Crew) -> None:
        try:
            while wanted.is_set():
                for row in crew.rows(work.get_nowait(), known):
                    rows.put(row)
        except queue.Empty:
            rows.put(None)
        except BaseException as error:  # given on: without a word, the batch would wait for ever
            rows.put(error)

    threads = [threading.Thread(target=serve, args=(crew,), daemon=True) for crew in crews]
    for thread in threads:
        thread.start()
    running = len(threads)
    try:
        while running:
            row = rows.get()
            if isinstance(row, BaseException):
                raise row
            if row is None:
                running -= 1
            else:
                yield row
    finally:
        wanted.clear()
        for crew in crews:
            crew.close()


def _on_cluster(
    study: Study, chunks: list[Chunk], address: str, known: frozenset[int], folder: str
) -> Generator[Row, None, None]:
    from distributed import as_completed

    client = reach(address)
    with client:
        futures = [
            client.submit(run_chunk, chunk, study.save, folder, study.time_limit, known, pure=False)
            for chunk in chunks
        ]
        ready: Any = as_completed(futures)  # type: ignore[no-untyped-call]
        for future in ready:
            yield from future.result()


def reach(address: str) -> Any:
    """Return a client of a Dask scheduler; SceneError if it cannot be reached."""
    try:
        from distributed import Client  # the extra `distributed`
    except ImportError:
        raise SceneError(
            "--scheduler: needs Dask; install it by pip install 'ribbonopt[distributed]'"
        ) from None
    try:
        return Client(address, timeout=10)  # type: ignore[no-untyped-call]
    except (OSError, TimeoutError, ValueError) as error:
        raise SceneError(f"--scheduler {address}: cannot be reached ({error})") from None


def run_chunk(
    chunk: Chunk, save: str, folder: str, time_limit: float, known: frozenset[int]
) -> list[Row]:
    """Return the rows of a chunk, solved in a process of its own; what a cluster's worker runs."""
    crew = Crew(save, folder, time_limit)
    try:
        return list(crew.rows(chunk, known))
    finally:
        crew.close()
