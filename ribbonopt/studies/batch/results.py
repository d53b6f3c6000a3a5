"""What a batch came to: rows by the numbers of their ribbons, and the solutions that were saved.

    results = ribbonopt.load("results/NAME")      # or Batch.of(study, run_batch(study))
    results[3].plot()

A saved solution is read each time that it is asked for; what is built for the first one serves all
of the same structure.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ribbonopt.doors import batch_drawn, frame_of
from ribbonopt.errors import OutputError
from ribbonopt.output.results import Built, load_solution, other_equilibria
from ribbonopt.plain import SPECIALS, Row
from ribbonopt.reading import is_file
from ribbonopt.solution.at_home import in_notebook
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.columns import column_of, names_of
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.continuation.files import FILE
from ribbonopt.text import one_line, shortened

from .files import load_batch, sorted_columns
from .kept import SOLUTIONS, OneEach
from .special import with_columns
from .study import Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from pandas import DataFrame


class Batch:
    """The rows of a batch, and its saved solutions.

    `batch[number]` is what was saved of a ribbon: a solution, or of one that was continued a
    branch. Iterating gives the rows, by increasing numbers.

    Attributes
    ----------
    name : str
        Name of the study.
    count : int
        How many ribbons the study has; fewer rows are there of a batch that was interrupted.
    inputs : tuple of str
        Keys of the inputs, which are columns.
    rows : list of dict
        A row for each ribbon, with the columns of `table.csv`; of a branch its special points too,
        as a list under `specials`.
    folder : Path or None
        Where solutions are saved.
    labels : mapping
        What columns are called beside the axes of figures.
    """

    def __init__(
        self,
        name: str,
        count: int,
        inputs: Sequence[str],
        rows: Iterable[Row],
        folder: Path | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> None:
        """Take rows in any order; of several of one ribbon the last verified one counts."""
        self.labels: Mapping[str, str] = labels or {}
        self.name, self.count, self.inputs, self.folder = name, count, tuple(inputs), folder
        self.rows: list[Row] = sorted(OneEach(rows), key=lambda row: int(row["number"]))
        self._built: Built = {}

    @classmethod
    def load(cls, folder: str | Path) -> Batch:
        """Return the batch of a folder; OutputError if it holds none, or is damaged."""
        study, rows = load_batch(folder)
        parts = study["name"], study["ribbons"], study["inputs"], rows, Path(folder)
        return cls(*parts, labels=study.get("labels"))

    @classmethod
    def of(cls, study: Study, rows: Iterable[Row], folder: str | Path | None = None) -> Batch:
        """Return the batch of a study from rows as `run_batch` yields them.

        `folder` is that which was given there, if any.
        """
        place = Path(folder) if folder else None
        return cls(study.name, study.count, study.keys, rows, place, study.called)

    @property
    def columns(self) -> list[str]:
        """Names of the columns, as in `table.csv`."""
        return sorted_columns(names_of(self._told), self.inputs)

    @property
    def failed(self) -> list[Row]:
        """Rows of the ribbons that are not verified."""
        return [row for row in self.rows if not row["verified"]]

    @property
    def saved(self) -> list[int]:
        """Numbers of the ribbons whose solutions are saved."""
        return [row["number"] for row in self.rows if self._is_saved(row["number"])]

    def __getitem__(self, number: int) -> Solution | Branch:
        """Return what was saved of a ribbon.

        Raises
        ------
        KeyError
            If there is no row of that number.
        OutputError
            If its solution was not saved, or cannot be read.
        """
        if number not in (row["number"] for row in self.rows):
            raise KeyError(f"{number}: no row of that number; expected one from 1 to {self.count}")
        if not self._is_saved(number):
            raise OutputError(
                f"{self.name}: the solution of ribbon {number} was not saved; `save: all` in the "
                "study keeps all of them, and run_batch needs a folder"
            )
        place = self._place(number)
        if is_file(place / FILE):
            return Branch.load(place)
        return load_solution(place, built=self._built)

    def others(self, number: int) -> list[Solution]:
        """Return the other equilibria that were saved of a ribbon whose scene has `starts`."""
        return other_equilibria(self._place(number), built=self._built)

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        """Yield the rows."""
        return iter(self.rows)

    def to_pandas(self) -> DataFrame:
        """Return the rows as a table, with the columns of `table.csv`; needs pandas."""
        return frame_of(self._told, self.columns)

    def plot(self, x: str, y: str, style: object | None = None) -> Figure:
        """Return a figure of two columns, such as "epsilon" and "energy".

        Parameters
        ----------
        x, y
            Columns; of a path its last part will do (`epsilon` for `law.epsilon`).
        style
            A `ribbonopt.views.Style`.

        Raises
        ------
        SceneError
            If there is no such column, or are several.
        """
        names = self.columns
        pair = column_of(x, names), column_of(y, names)
        return batch_drawn(self._told, pair, self.inputs, self.labels, style)

    def __repr__(self) -> str:
        """Say what it is in one line."""
        name = shortened(one_line(self.name), 40)
        counts = Counter(str(row["status"]) for row in self.rows).most_common(5)
        statuses = ", ".join(f"{count} {status.replace('_', ' ')}" for status, count in counts)
        some = f" of {self.count}" if len(self) < self.count else ""
        inputs = shortened(one_line(", ".join(self.inputs)), 80) or "none"
        told = f": {statuses}" if statuses else ""
        return f"<Batch {name}: {len(self)}{some} ribbons{told}; inputs {inputs}>"

    def _repr_html_(self) -> str | None:
        return in_notebook(self)

    @property
    def _told(self) -> list[Row]:
        """Rows with columns alone: special points of branches in columns of their own."""
        return [{k: v for k, v in with_columns(row).items() if k != SPECIALS} for row in self.rows]

    def _place(self, number: int) -> Path:
        assert self.folder is not None
        return self.folder / SOLUTIONS / str(number)

    def _is_saved(self, number: int) -> bool:
        return self.folder is not None and self._place(number).is_dir()
