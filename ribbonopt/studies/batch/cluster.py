"""Batches on a Dask cluster: each of its workers has processes of its own for the ribbons.

What crashes or hangs costs one ribbon there as here. Chunks travel to the workers, rows and full
solutions back: no folder need be shared.
"""

from __future__ import annotations

import contextlib
import queue
import tempfile
from collections.abc import Generator, Mapping
from pathlib import Path
from typing import Any
from uuid import uuid4

from ribbonopt.errors import ConvergenceError, SceneError
from ribbonopt.output.staging import staged_result
from ribbonopt.plain import Row
from ribbonopt.version import VERSION

from .chunks import Chunk
from .kept import SOLUTIONS
from .processes import WorkerProcess, lost_row
from .study import Study

try:
    from distributed import Client, WorkerPlugin, as_completed, get_worker
    from distributed.scheduler import KilledWorker
except ImportError:
    raise SceneError(
        "--scheduler: needs Dask; install it by pip install 'ribbonopt[distributed]'"
    ) from None

Files = dict[str, bytes]
PATIENCE = 30.0  # seconds to wait for the first worker


class Crews(WorkerPlugin):
    """The processes of one Dask worker, as many as it has tasks at a time; kept between chunks."""

    def __init__(self, save: str, time_limit: float) -> None:
        """Remember what is asked; nothing is begun before the worker has it."""
        self.save, self.time_limit = save, time_limit

    def setup(self, worker: Any) -> None:
        """Begin without a process."""
        self._idle: queue.SimpleQueue[WorkerProcess] = queue.SimpleQueue()
        self._folder = tempfile.TemporaryDirectory(prefix="ribbonopt")

    def teardown(self, worker: Any) -> None:
        """End all processes."""
        with contextlib.suppress(queue.Empty):
            while True:
                self._idle.get_nowait().close()
        self._folder.cleanup()

    def solve(self, chunk: Chunk, known: Mapping[int, str]) -> list[tuple[Row, Files]]:
        """Return the rows of a chunk, each with the files of its full solution."""
        try:
            worker = self._idle.get_nowait()
        except queue.Empty:
            worker = WorkerProcess(self.save, self._folder.name, self.time_limit)
        try:
            return [(row, self._taken(row)) for row in worker.rows(chunk, known)]
        finally:
            self._idle.put(worker)

    def _taken(self, row: Row) -> Files:
        folder = Path(self._folder.name) / SOLUTIONS / str(row["number"])
        paths = [path for path in folder.rglob("*") if path.is_file()]
        files = {str(path.relative_to(folder)): path.read_bytes() for path in paths}
        for path in paths:
            path.unlink()
        return files


def rows_of_cluster(
    study: Study, chunks: list[Chunk], address: str, known: Mapping[int, str], folder: str
) -> Generator[Row, None, None]:
    """Yield the rows of chunks as the workers of a Dask scheduler have them ready."""
    client = reach(address)
    name = f"ribbonopt-{uuid4()}"
    with client:
        client.register_plugin(Crews(study.save, study.time_limit), name=name)
        try:
            yield from _gathered(client, name, chunks, known, folder)
        finally:
            with contextlib.suppress(Exception):  # the scheduler may be gone: nothing is left there
                client.unregister_worker_plugin(name)


def check_cluster(address: str) -> None:
    """Raise what `reach` raises, if anything."""
    reach(address).close()


def reach(address: str) -> Client:
    """Return a client of a Dask scheduler.

    Raises
    ------
    SceneError
        If it cannot be reached, has no workers, or they have not this version of ribbonopt.
    """
    try:
        client = Client(address, timeout=10)
    except (OSError, TimeoutError, ValueError) as error:
        raise SceneError(f"--scheduler {address}: cannot be reached ({error})") from None
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
        there = set(client.run(_version).values())
    except TimeoutError:
        client.close()
        raise SceneError(
            f"--scheduler {address}: has no workers; start some by dask worker {address}"
        ) from None
    except Exception as error:  # what a worker's error comes as is Dask's own business
        client.close()
        raise SceneError(
            f"--scheduler {address}: its workers cannot run ribbonopt ({error}); install it there"
        ) from None
    if there != {VERSION}:
        client.close()
        found = ", ".join(sorted(there))
        raise SceneError(f"--scheduler {address}: has ribbonopt {found}, expected {VERSION}")
    return client


def _gathered(
    client: Client, name: str, chunks: list[Chunk], known: Mapping[int, str], folder: str
) -> Generator[Row, None, None]:
    sent = {client.submit(_solved, name, chunk, known, pure=False): chunk for chunk in chunks}
    for future in as_completed(sent):
        try:
            found = future.result()
        except KilledWorker as error:
            for ribbon in sent[future].ribbons:
                if ribbon.number not in known:
                    yield lost_row(ribbon, "crashed", f"the cluster lost its workers: {error}")
            continue
        except Exception as error:
            if future.status == "error":
                raise
            # Cancelled, by the scheduler's end or by hand.
            raise ConvergenceError(
                f"the scheduler was lost or gave up ({error}); rows so far are kept, --resume goes "
                "on from there",
                "cluster_lost",
            ) from error
        for row, files in found:
            _keep(files, folder, row["number"])
            yield row


def _solved(name: str, chunk: Chunk, known: Mapping[int, str]) -> list[tuple[Row, Files]]:
    """Solve a chunk in the processes of the Dask worker that runs this."""
    workers: Any = get_worker().plugins[name]
    found: list[tuple[Row, Files]] = workers.solve(chunk, known)
    return found


def _version() -> str:
    return VERSION


def _keep(files: Files, folder: str, number: int) -> None:
    if not (files and folder):
        return
    with staged_result(Path(folder) / SOLUTIONS / str(number)) as stage:
        for name, content in files.items():
            path = stage.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        stage.commit()
