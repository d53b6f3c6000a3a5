"""The rows of a batch: one for each ribbon, however often it was solved."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ribbonopt.plain import Row

SOLUTIONS = "solutions"  # the folder of what is kept of ribbons, by their numbers
LOST = ("crashed", "timed_out")  # statuses of ribbons that took their worker with them
AGAIN = (*LOST, "error")  # those that say nothing of the ribbon itself: another try may do


class OneEach:
    """Rows by their numbers: the last one counts, but what is verified is not given up.

    Attributes
    ----------
    failed : int
        How many are not verified.
    """

    def __init__(self, rows: Iterable[Row] = ()) -> None:
        """Take rows in the order in which they came."""
        self._rows: dict[int, Row] = {}
        self.failed = 0
        for row in rows:
            self.add(row)

    def add(self, row: Row) -> bool:
        """Add a row; return whether there was one of its number already."""
        old = self._rows.get(row["number"])
        if old is None or row["verified"] or not old["verified"]:
            self.failed += (not row["verified"]) - (old is not None and not old["verified"])
            self._rows[row["number"]] = row
        return old is not None

    @property
    def statuses(self) -> dict[int, str]:
        """Statuses by number."""
        return {number: row["status"] for number, row in self._rows.items()}

    @property
    def to_try_again(self) -> set[int]:
        """Numbers of the ribbons of which nothing was found out."""
        return {
            number
            for number, row in self._rows.items()
            if row["status"] in AGAIN and not row["verified"]
        }

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._rows)

    def __iter__(self) -> Iterator[Row]:
        """Yield them in the order in which their numbers first came."""
        return iter(self._rows.values())
