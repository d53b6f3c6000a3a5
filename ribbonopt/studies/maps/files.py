"""Maps on disk: the rows of what was done, appended as they come, and the map once it is whole.

`jobs.jsonl` holds the row of each piece of work; `map-branches/N/M`, `map-loci/N` and
`map-points/N/M` what it found, each a folder that can be drawn and looked at by itself; `map.json`
the map; `map.csv` the points of all loci.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ribbonopt.errors import OutputError
from ribbonopt.output.claims import claimed, put_all_right
from ribbonopt.output.declared import MAP_PICTURES, PAGE
from ribbonopt.output.disk import Appended
from ribbonopt.output.places import unwritable
from ribbonopt.output.saved import SCENE as SAVED
from ribbonopt.output.staging import replacing
from ribbonopt.output.table import write_table
from ribbonopt.plain import Row, Rows, json_text
from ribbonopt.reading import is_file, read_text
from ribbonopt.scene import Scene, dump_scene

from .jobs import FOLDERS, Job
from .saved import FILE, JOBS, SCENE, TABLE, read_jobs


class MapFolder:
    """A folder that a map is written to, piece by piece."""

    def __init__(self, folder: str | Path, scene: Scene, *, resume: bool) -> None:
        """Claim the folder.

        Raises
        ------
        OutputError
            If it cannot be written, holds other files, a map that is not to be gone on with, or one
            of another scene.
        """
        self.folder, self.scene = Path(folder), scene
        self.known: dict[str, Row] = {}
        self._finished = False
        try:
            with contextlib.ExitStack() as refused:
                own = {FILE, TABLE, JOBS, SCENE, PAGE, *FOLDERS, *MAP_PICTURES}
                self.folder = refused.enter_context(claimed(self.folder, own))
                self._begin(resume)
                self._claimed = refused.pop_all()  # the folder is ours until it is closed
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(self.folder, error) from error

    def row_of(self, job: Job) -> Row | None:
        """Return the row of a job that is done and there; None where it is still to be done."""
        row = self.known.get(digest_of(job))
        there = (self.folder / job.place).is_dir()
        return row if row is not None and row["verified"] and there else None

    def keep(self, job: Job, row: Row) -> None:
        """Add the row of a job, which whatever ends this process spares."""
        digest = digest_of(job)
        line = {"place": job.place, "digest": digest, "row": row}
        try:
            self._file.write(json.dumps(line) + "\n")
        except OSError as error:
            raise self._full(error) from error
        self.known[digest] = row

    def write(self, data: Mapping[str, Any], rows: Rows) -> None:
        """Write the map, and the table of the points of its loci."""
        try:
            with replacing(self.folder / FILE) as file:
                file.write(json_text(data))
            names = list(dict.fromkeys(name for row in rows for name in row))
            write_table(self.folder / TABLE, names, rows)
        except OSError as error:
            raise self._full(error) from error

    def close(self) -> None:
        """Finish, if that is not done, and give the folder up."""
        with self._claimed:
            self.finish()

    def finish(self) -> None:
        """End the file of rows; where nothing was found, nothing stays."""
        if self._finished:
            return
        self._finished = True
        for name in FOLDERS:  # of workers that were ended, and dead maps
            put_all_right(self.folder / name)
        try:
            self._file.close()
            if not self.known:
                for name in (JOBS, SCENE):
                    (self.folder / name).unlink(missing_ok=True)
                for name in FOLDERS:
                    with contextlib.suppress(OSError):
                        (self.folder / name).rmdir()
        except OSError as error:
            raise self._full(error) from error

    def _begin(self, resume: bool) -> None:
        text, there = dump_scene(self.scene), is_file(self.folder / JOBS)
        if there and not resume:
            raise OutputError(
                f"{self.folder}: holds a map already; go on with it by --resume, or choose another "
                "folder"
            )
        if there:
            self._refuse_other(text)
            lines = read_jobs(self.folder)
            self.known = {line["digest"]: line["row"] for line in lines}
            with replacing(self.folder / JOBS) as file:  # without a line that was cut short
                file.writelines(json.dumps(line) + "\n" for line in lines)
        else:
            with replacing(self.folder / SCENE) as file:
                file.write(text)
        self._file = Appended(open(self.folder / JOBS, "a", encoding="utf-8"))

    def _refuse_other(self, text: str) -> None:
        place = self.folder / SCENE
        if not os.path.exists(place) or read_text(place, SAVED) != text:
            raise OutputError(
                f"{self.folder}: holds a map of another scene; resume with the scene (and --set) "
                "it was begun with, or choose another folder"
            )

    def _full(self, error: OSError) -> OutputError:
        return OutputError(
            f"{self.folder}: cannot be written ({error.strerror}); what is done is kept, make room "
            "and go on by --resume"
        )


def digest_of(job: Job) -> str:
    """Return what tells a job from others: everything that decides its row."""
    parts = [job.place, job.task, dump_scene(job.scene), job.inputs]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()
