"""One scene under one law: the equilibrium near a known one, and that of the automatic start.

Ribbons have several equilibria. So that laws are compared on one branch, each starts from the
solution under the scene's own law, and by the automatic start, which goes for least energy. Where
they lead to two equilibria the one nearer to the known shape is taken, and the other is told.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError, RibbonoptError
from ribbonopt.pipeline.prepared import Prepared, prepare, solve
from ribbonopt.scene import Scene
from ribbonopt.solution.potential import known_potential
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.equilibria import distinct

from .described import line_gap

OWN, NEAR, AUTO = "the scene's start", "a start from the first row", "the automatic start"
REFUSED = "refused"
STILL = 1e-6  # of the length: centre lines that are not further apart are one


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a scene came to under a law.

    Attributes
    ----------
    solution : Solution or None
        None where there is none, verified or not.
    status, message : str
        How it ended.
    start : str
        What it was started from.
    other : Solution or None
        Another equilibrium, further from the known one.
    lost : str
        Why a start led nowhere that was tried before.
    seconds, checked : float
        Of this solution, what it takes to build included; of the other start.
    """

    solution: Solution | None
    status: str
    message: str = ""
    start: str = ""
    other: Solution | None = None
    lost: str = ""
    seconds: float = 0.0
    checked: float = 0.0

    @property
    def verified(self) -> bool:
        """Whether there is a solution as the scene asks."""
        return self.solution is not None and self.solution.verified


def own(scene: Scene) -> Outcome:
    """Solve a scene as it stands, and by the automatic start where it has a start of its own."""
    started = time.perf_counter()
    try:
        found = _outcome(solve(scene), OWN)
    except (RibbonoptError, np.linalg.LinAlgError) as error:
        found = _failed(error)
    seconds = time.perf_counter() - started
    found = replace(found, seconds=seconds)
    return found if scene.guess == "auto" or not found.verified else _beside(found, scene, None)


def near(scene: Scene, guess: Solution | None, prepared: Prepared | None = None) -> Outcome:
    """Solve a scene from a solution under another law, and by the automatic start.

    `prepared` is the same structure, built before.
    """
    started = time.perf_counter()
    try:
        prepared = prepared or prepare(scene)
        found = Outcome(None, "") if guess is None else _from(prepared, scene, guess)
        found = replace(found, seconds=time.perf_counter() - started)
        return _nearer(_beside(found, scene, prepared), guess)
    except (RibbonoptError, np.linalg.LinAlgError) as error:
        return replace(_failed(error), seconds=time.perf_counter() - started)


def _from(prepared: Prepared, scene: Scene, guess: Solution) -> Outcome:
    """Solve from a guess and nothing else."""
    try:
        return _outcome(prepared.solve(scene, guess=guess, fallback=False), NEAR)
    except (ConvergenceError, np.linalg.LinAlgError) as error:
        return _failed(error)


def _beside(found: Outcome, scene: Scene, prepared: Prepared | None) -> Outcome:
    """Return an outcome with that of the automatic start, or this where there is no other."""
    started = time.perf_counter()
    try:
        least = _outcome(_automatic(scene, prepared), AUTO)
    except (ConvergenceError, np.linalg.LinAlgError) as error:
        least = _failed(error)
    seconds = time.perf_counter() - started
    if not found.verified:
        lost = f"{NEAR} led to no solution: {found.message}" if found.status else ""
        return replace(least, lost=lost, seconds=found.seconds + seconds)
    other = least.solution if least.verified and _apart(found, least) else None
    return replace(found, other=other, checked=seconds)


def _nearer(found: Outcome, guess: Solution | None) -> Outcome:
    """Return an outcome, its two equilibria exchanged where the other is nearer to a known one."""
    if guess is None or found.solution is None or found.other is None:
        return found
    here, there = (line_gap(some, guess) for some in (found.solution, found.other))
    if here <= there:
        return found
    swapped = {"solution": found.other, "other": found.solution, "start": AUTO}
    return replace(found, **swapped, seconds=found.checked, checked=found.seconds)  # type: ignore[arg-type]


def _automatic(scene: Scene, prepared: Prepared | None) -> Solution:
    scene = replace(scene, guess="auto")
    if prepared is None or scene.starts > 1:
        return solve(scene)
    return prepared.solve(scene)


def _apart(a: Outcome, b: Outcome) -> bool:
    """Whether two verified solutions are different equilibria; mirror images are one."""
    assert a.solution is not None and b.solution is not None
    if len(distinct([a.solution, b.solution])) == 1:
        return False
    # Next to a straight ribbon strains and energies are rounding.
    return line_gap(a.solution, b.solution) > STILL


def told_of(found: Outcome) -> str:
    """Say which other equilibrium there is, and whether it is lower."""
    if found.other is None or found.solution is None:
        return ""
    here, there = (known_potential(some) for some in (found.solution, found.other))
    lower = "less" if there < here else "more"
    way = NEAR if found.start == AUTO else AUTO
    return f"there is another equilibrium, of {lower} energy ({there:.6g}, by {way})"


def _outcome(solution: Solution, start: str) -> Outcome:
    message = "" if solution.verified else " ".join(solution.message.split())
    return Outcome(solution, solution.status.name.lower(), message, start)


def _failed(error: Exception) -> Outcome:
    status = error.status if isinstance(error, ConvergenceError) else REFUSED
    if isinstance(error, np.linalg.LinAlgError):
        status = "singular"
    return Outcome(None, status, " ".join(str(error).split()))
