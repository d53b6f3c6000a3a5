"""One line of progress on a terminal, written over itself and gone in the end.

Nothing of it is written where stderr is no terminal, or nobody wants it (`--quiet`).
"""

from __future__ import annotations

import shutil
import time

from ribbonopt.text import one_line

from .terminal import overwrite, seen

OFTEN = 0.1  # seconds between two pictures of the line


class ProgressLine:
    """The line; `wanted` says whether anybody sees it."""

    def __init__(self, *, quiet: bool) -> None:
        """Write nothing yet; the clock starts."""
        self.wanted = not quiet and seen()
        self.started, self._shown, self._width = time.perf_counter(), 0.0, 0

    @property
    def due(self) -> bool:
        """Whether another picture is due: not so often that it costs."""
        return self.wanted and time.perf_counter() - self._shown >= OFTEN

    def rate(self, count: int) -> float:
        """Return how many there are a second, since the clock has started."""
        return count / max(time.perf_counter() - self.started, 1e-9)

    def show(self, text: str) -> None:
        """Write a text in place of the one before, cut where the terminal ends."""
        if not self.wanted:
            return
        # The last column would wrap, and what has wrapped is not written over.
        text = one_line(text)[: shutil.get_terminal_size().columns - 1]
        overwrite(text.ljust(self._width))
        self._shown, self._width = time.perf_counter(), len(text)

    def close(self) -> None:
        """Take the line away."""
        if self._width:
            overwrite(" " * self._width, "")
            self._width = 0
