"""A case of an attack: files, a command on them, and what must hold when it has ended."""

from __future__ import annotations

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from attack_runs import Run, command, hidden

BAD_INPUT = 2


@dataclass(frozen=True)
class Case:
    """Files of a folder by their names, and the words of a command run in it.

    `kind` is what it is counted under, `label` what was done to the files.
    """

    kind: str
    label: str
    arguments: Sequence[str]
    files: Mapping[str, bytes] = field(default_factory=dict)
    seconds: float = 60.0

    def write(self, folder: Path) -> None:
        """Write the files into a folder, made if need be."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in self.files.items():
            (folder / name).write_bytes(content)


@dataclass(frozen=True)
class Outcome:
    """What a case came to; `fault` is "" where nothing was wrong."""

    case: Case
    run: Run
    fault: str


def attempted(case: Case, folder: Path) -> Outcome:
    """Run a case in a new folder, which is gone afterwards."""
    try:
        case.write(folder)
        before = _listed(folder)
        run = command(case.arguments, folder, case.seconds)
        return Outcome(case, run, run.fault or _amiss(before, _listed(folder), folder, run))
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _listed(folder: Path) -> dict[str, bytes]:
    """Return all files below a folder."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def _amiss(before: dict[str, bytes], after: dict[str, bytes], folder: Path, run: Run) -> str:
    left = [name for name in hidden(folder) if name not in before]
    if left:
        return f"left behind: {', '.join(left[:3])}"
    if run.status == BAD_INPUT and before != after:
        changed = sorted(n for n in {*before, *after} if before.get(n) != after.get(n))
        return f"bad input, and yet written: {', '.join(changed[:3])}"
    return ""
