"""Compute numbers with sources again, scene by scene: one solution or branch for all its rows."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any, cast

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError, SceneError
from ribbonopt.output.summary import versions
from ribbonopt.plain import finite
from ribbonopt.studies.machine import machine

from .answers import Answers
from .claims import Claim
from .measured import TOLERANCE, NoAnswerError
from .verdict import OK, Verdict

NAME = "verification"


@dataclass(frozen=True, eq=False)
class Verification:
    """All rows of a file, or some, with what was computed; `file` is its name."""

    file: str
    verdicts: tuple[Verdict, ...]

    @property
    def right(self) -> bool:
        """Whether all rows are within their bars."""
        return all(verdict.status == OK for verdict in self.verdicts)

    @property
    def seconds(self) -> float:
        """CPU time of all rows."""
        return sum(verdict.seconds for verdict in self.verdicts)

    @property
    def counts(self) -> Counter[str]:
        """How many rows there are of each status."""
        return Counter(verdict.status for verdict in self.verdicts)

    @property
    def tolerated(self) -> int:
        """How many rows were judged by the tolerance of their scene, as they have no bar."""
        bases = (v.found.basis for v in self.verdicts if v.found is not None)
        return sum(basis == TOLERANCE for basis in bases)

    def plain(self) -> dict[str, Any]:
        """Return everything as plain data for JSON."""
        plain: dict[str, Any] = {
            "name": NAME,
            "file": self.file,
            "status": "converged" if self.right else "off",
            "verified": self.right,
            "counts": dict(self.counts),
            "seconds": self.seconds,
            "rows": [verdict.plain() for verdict in self.verdicts],
            "machine": machine(),
            "versions": versions(),
        }
        return cast("dict[str, Any]", finite(plain))


def verify(
    claims: Sequence[Claim], file: str, told: Callable[[str], None] = lambda text: None
) -> Verification:
    """Compute the numbers of some rows, in the order of the file.

    Parameters
    ----------
    claims
        The rows.
    file
        The name of their file, for messages.
    told
        Is told which row it is at.

    Raises
    ------
    SceneError
        If the mechanics of a scene does not hold together.
    """
    cases: dict[int, list[Claim]] = {}
    for claim in claims:
        cases.setdefault(id(claim.case), []).append(claim)
    found: dict[int, Verdict] = {}
    for rows in cases.values():
        answers = Answers(rows[0].case)  # forgotten with its branches when its rows are done
        for claim in rows:
            told(f"row {len(found) + 1} of {len(claims)}: {claim.label}")
            found[claim.number] = _verdict(claim, answers, file)
    return Verification(file, tuple(found[claim.number] for claim in claims))


def _verdict(claim: Claim, answers: Answers, file: str) -> Verdict:
    started = time.process_time()
    try:
        measured, message = claim.asked(answers), ""
    except NoAnswerError as error:
        measured, message = None, str(error)
    except ModelError as error:
        raise SceneError(f"{file}: row {claim.number} ({claim.label}): {error}") from error
    return Verdict(claim, measured, time.process_time() - started, message)
