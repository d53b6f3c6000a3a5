"""The page of how solves end: each status with its message, as it is printed."""

from __future__ import annotations

from pathlib import Path

from pieces import code, page, table

from ribbonopt.solvers import Status

WORDS = """\
How a solve may end, in the words that are printed: what is wrong, and what to do. `status` in
`summary.json`, in rows of a batch and in `--json` is the name. [Messages and exit
states](../messages.md) says more.
"""


def pages(folder: Path) -> dict[str, str]:
    """Return the page."""
    rows = [[code(status.name.lower()), status.value] for status in Status]
    return {"statuses.md": page("# Status values", WORDS, table(("status", "message"), rows))}
