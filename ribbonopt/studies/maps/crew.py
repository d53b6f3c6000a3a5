"""Workers that stay for a whole map: pieces of work are given to whoever is free."""

from __future__ import annotations

import queue
from collections.abc import Generator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed

from ribbonopt.errors import ConvergenceError, WorkerError
from ribbonopt.plain import Row
from ribbonopt.scene.limits import SECONDS
from ribbonopt.studies.batch.chunks import Chunk
from ribbonopt.studies.batch.processes import WorkerProcess
from ribbonopt.studies.batch.study import StudyRibbon
from ribbonopt.studies.machine import cores

GONE = "; what is done is kept, --resume goes on from there"


class Crew:
    """Processes of the batch engine; begun when there is work for them, ended by `close`."""

    def __init__(self, folder: str, jobs: int | None = None) -> None:
        """Begin no process yet; `folder` is that of the map, `jobs` how many processes at most."""
        count = jobs or cores()
        self._workers = [WorkerProcess("all", folder, SECONDS) for _ in range(count)]
        self._free: queue.SimpleQueue[WorkerProcess] = queue.SimpleQueue()
        for worker in self._workers:
            self._free.put(worker)

    def rows(self, ribbons: Sequence[StudyRibbon]) -> Generator[Row, None, None]:
        """Yield the row of each ribbon, in the order in which they are ready.

        Raises
        ------
        WorkerError
            If no process can be started that does anything.
        ConvergenceError
            If processes can no longer be started.
        """
        pool = ThreadPoolExecutor(len(self._workers))
        try:
            asked: list[Future[list[Row]]] = [pool.submit(self._done, some) for some in ribbons]
            count = 0
            for future in as_completed(asked):
                try:
                    rows = future.result()
                except WorkerError as error:
                    if not count:
                        raise
                    raise ConvergenceError(f"{error}{GONE}", "workers_lost") from error
                count += len(rows)
                yield from rows
        except BaseException:
            self.close()  # whoever waits for an answer waits no longer
            raise
        finally:
            pool.shutdown(cancel_futures=True)

    def close(self) -> None:
        """End all processes for good."""
        for worker in self._workers:
            worker.close()

    def _done(self, ribbon: StudyRibbon) -> list[Row]:
        worker = self._free.get()
        try:
            worker.begin()
            return list(worker.rows(Chunk((ribbon,)), {}))
        finally:
            self._free.put(worker)
