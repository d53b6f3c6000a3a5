"""Batches on disk: a row for each ribbon, appended as it comes; nothing that is there is lost.

`rows.jsonl` holds one JSON object in a line; `table.csv` has them sorted by number; `special.csv`
the special points of branches; `study.json` says which study it is; `solutions/NUMBER` are full
results.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ribbonopt.errors import OutputError
from ribbonopt.output.claims import claimed, put_all_right
from ribbonopt.output.declared import BATCH_PICTURES, PAGE
from ribbonopt.output.disk import Appended
from ribbonopt.output.places import unwritable
from ribbonopt.output.staging import replacing
from ribbonopt.output.table import write_table
from ribbonopt.plain import SPECIALS, Row, Rows

from .cells import as_cell
from .kept import SOLUTIONS, OneEach
from .saved import ROWS, STUDY, read_rows, read_study
from .special import special_rows, with_columns
from .study import Study

TABLE, SPECIAL = "table.csv", "special.csv"


class BatchFolder:
    """A folder that rows are written to."""

    def __init__(
        self, folder: str | Path, study: Study, *, resume: bool, retry: bool = False
    ) -> None:
        """Claim the folder; with `retry`, ribbons that were lost are not known, but to be solved.

        Raises
        ------
        OutputError
            If it cannot be written, holds other files, rows that are not to be added to, or rows
            of another study.
        """
        self.folder, self.study = Path(folder), study
        self.rows, self._twice, self._finished = OneEach(), False, False
        try:
            with contextlib.ExitStack() as refused:
                own = {ROWS, TABLE, SPECIAL, STUDY, SOLUTIONS, PAGE, *BATCH_PICTURES}
                self.folder = refused.enter_context(claimed(self.folder, own))
                self._begin(resume)
                self._claimed = refused.pop_all()  # the folder is ours until it is closed
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(self.folder, error) from error
        # Their rows stay until there are others.
        self._again = self.rows.to_try_again if retry else set()

    @property
    def known(self) -> dict[int, str]:
        """Statuses of the ribbons whose rows are there and stay."""
        return {n: status for n, status in self.rows.statuses.items() if n not in self._again}

    @property
    def done(self) -> int:
        """How many rows are there and stay."""
        return len(self.rows) - len(self._again)

    def append(self, row: Row) -> None:
        """Add a row, which whatever ends this process spares; a power loss from a second on."""
        try:
            self._file.write(json.dumps(row) + "\n")
        except OSError as error:
            raise self._full(error) from error
        self._twice |= self.rows.add(row)
        self._again.discard(row["number"])

    def close(self) -> None:
        """Finish, if that is not done, and give the folder up."""
        with self._claimed:
            self.finish()

    def finish(self) -> None:
        """End the file of rows, and write the table, sorted by number."""
        if self._finished:
            return
        self._finished = True
        put_all_right(self.folder / SOLUTIONS)  # of workers that were ended, and dead batches
        try:
            self._file.close()
            if not self.rows:  # nothing was found, and so nothing stays
                for name in (ROWS, STUDY):
                    (self.folder / name).unlink(missing_ok=True)
                return
            if self._twice:
                self._write_rows()
            self._write_tables()
        except OSError as error:
            raise self._full(error) from error

    def _write_tables(self) -> None:
        rows = sorted(self.rows, key=lambda row: int(row["number"]))
        told = [self._told(with_columns(row)) for row in rows]
        columns = sorted_columns(_names(told), self.study.keys)
        write_table(self.folder / TABLE, columns, told)
        if any(SPECIALS in row for row in rows):
            special = list(special_rows(told, self.study.keys))
            write_table(self.folder / SPECIAL, _names(special), special)

    def _told(self, row: Row) -> Row:
        """Return a row whose inputs are as a CSV of inputs would give them."""
        return row | {key: as_cell(row[key]) for key in self.study.keys if key in row}

    def _write_rows(self) -> None:
        with replacing(self.folder / ROWS) as file:
            file.writelines(json.dumps(row) + "\n" for row in self.rows)

    def _full(self, error: OSError) -> OutputError:
        return OutputError(
            f"{self.folder}: cannot be written ({error.strerror}); {len(self.rows)} of "
            f"{self.study.count} rows are kept, make room and go on by --resume"
        )

    def _begin(self, resume: bool) -> None:
        record = {
            "name": self.study.name,
            "ribbons": self.study.count,
            "inputs": self.study.keys,
            "digest": self.study.digest,
        }
        if labels := self.study.called:
            record["labels"] = labels
        if (self.folder / STUDY).is_file() and (self.folder / STUDY).stat().st_size:
            self._go_on(str(record["digest"]), resume)
        elif (self.folder / ROWS).is_file() and (self.folder / ROWS).stat().st_size:
            raise OutputError(
                f"{self.folder}: holds rows without {STUDY}, which said of what study; choose "
                "another folder"
            )
        else:
            with replacing(self.folder / STUDY) as file:
                file.write(json.dumps(record, indent=2) + "\n")
        self._write_rows()
        self._file = Appended(open(self.folder / ROWS, "a", encoding="utf-8"))

    def _go_on(self, digest: str, resume: bool) -> None:
        known = read_study(self.folder)
        if known["digest"] != digest:
            raise OutputError(
                f"{self.folder}: holds rows of another study ({known['name']}); choose another "
                "folder"
            )
        if not resume:
            raise OutputError(
                f"{self.folder}: holds rows of this study already; go on by --resume, or choose "
                "another folder"
            )
        self.rows = OneEach(read_rows(self.folder, known, self.study))


def _names(rows: Rows) -> list[str]:
    return list(dict.fromkeys(name for row in rows for name in row))


def sorted_columns(names: list[str], inputs: Sequence[str]) -> list[str]:
    """Return columns: number, scene, inputs, what came out, and what it cost last."""
    first = ["number", "scene", *inputs, "status", "verified", "energy"]
    last = ["start", "iterations", "path", "note", "message", "seconds"]
    middle = [name for name in sorted(names) if name not in (*first, *last, SPECIALS)]
    return [name for name in (*first, *middle, *last) if name in names]


def load_batch(folder: str | Path) -> tuple[dict[str, Any], list[Row]]:
    """Return what a batch folder says of its study (name, ribbons, inputs), and a row a ribbon.

    Raises
    ------
    OutputError
        If it holds none, or is damaged.
    """
    folder = Path(folder)
    if not os.path.exists(folder / STUDY):
        raise OutputError(f"{folder}: no batch; expected a folder written by ribbonopt batch")
    study = read_study(folder)
    return study, list(OneEach(read_rows(folder, study)))
