"""Stress of a scene: trials of every kind it has, each judged; the rule is that none is wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import RibbonoptError
from ribbonopt.output.summary import versions
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Scene
from ribbonopt.studies.machine import machine

from .answer import Answer, gap_between
from .kinds import kinds_of
from .limit import OutOfTimeError, limited
from .run import Examine, Outcome, run
from .verdict import Verdict
from .witness import witnesses

SECONDS = 20.0  # of the processor, for one trial


@dataclass(frozen=True)
class Stress:
    """What became of a scene under stress.

    `not_applicable` says why a kind has no trials; `truth` what answers were compared with.
    """

    name: str
    rows: tuple[Outcome, ...]
    not_applicable: Mapping[str, str]
    truth: str

    @property
    def counts(self) -> dict[str, int]:
        """How many trials came to each verdict, by its word."""
        found = Counter(row.verdict for row in self.rows)
        return {verdict.value: found[verdict] for verdict in Verdict}

    @property
    def bad(self) -> tuple[Outcome, ...]:
        """Trials that came to what must not be."""
        return tuple(row for row in self.rows if row.verdict.bad)

    def plain(self) -> dict[str, Any]:
        """Everything as plain data for JSON."""
        return {
            "name": self.name,
            "truth": self.truth,
            "counts": self.counts,
            "rows": [row.plain() for row in self.rows],
            "not_applicable": dict(self.not_applicable),
            "machine": machine(),
            "versions": versions(),
        }


def stress(
    scene: Scene,
    only: Iterable[str] | None = None,
    quick: bool = False,
    seconds: float = SECONDS,
    tell: Callable[[str], object] = str,
    examine: Examine | None = None,
) -> Stress:
    """Put a scene under stress.

    Parameters
    ----------
    scene
        What to solve; every trial changes one thing of it.
    only
        Names of `KINDS`; None for all.
    quick
        A few values of each kind.
    seconds
        Time of the processor that one trial may take.
    tell
        Is told which trial begins.
    examine
        Another judge of verified answers, which knows nothing of this package.

    Raises
    ------
    SceneError
        If a kind is not known.
    """
    kinds = kinds_of(only)
    scene = replace(scene, continuation=None, record={})
    tell("the scene as it is")
    truth, source = truth_of(scene, seconds, examine)
    rows: list[Outcome] = []
    none: dict[str, str] = {}
    for name, kind in kinds.items():
        trials = kind.trials(scene, quick)
        if isinstance(trials, str):
            none[name] = trials
            continue
        for trial in trials:
            tell(f"{name}: {trial.value}")
            rows.append(run(name, trial, truth, seconds, examine))
    return Stress(scene.name, tuple(rows), none, source)


def truth_of(
    scene: Scene, seconds: float, examine: Examine | None = None
) -> tuple[Answer | None, str]:
    """Return what a scene's answer should be, and in words how that is known; None if it is not.

    That of another scheme, sharper than the scene's own answer, with which it agrees; and in which
    who examines it finds no fault.
    """
    with suppress(OutOfTimeError, RibbonoptError, np.linalg.LinAlgError), limited(3 * seconds):
        found = solve(scene)
        if not found.verified:
            return None, "not known: the scene itself is not solved"
        own = Answer.of(found)
        for witness in witnesses(found):
            other = Answer.of(witness)
            if gap_between(own, other).agree:
                if fault := examine and examine(witness):
                    return None, f"not known: {fault}"
                mesh = witness.scene.transcription
                name = f"{mesh.scheme} {mesh.type} on {len(witness.nodes) - 1} intervals"
                return other, f"the scene's own answer, sharpened by {name}"
        return None, "not known: no other scheme agrees with the scene's own answer"
    return None, "not known: the scene itself is not solved"
