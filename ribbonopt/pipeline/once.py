"""One solve of a posed scene: its guess or the automatic start, refinement, what it has cost."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import Guess, words
from ribbonopt.problem import Posed
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

from .given import own_guess, step_of
from .means import Prepare
from .search import Search
from .told import judged, regularized, with_costs

if TYPE_CHECKING:
    from .prepared import Prepared

NOT_IT = "what was refined is not what the scene asks for: tried anew, each answer verified first"


def solve_posed(
    prepared: Prepared,
    prepare: Prepare,
    posed: Posed,
    guess: Guess | None,
    *,
    fallback: bool,
    quick: bool,
) -> Solution:
    """Solve a posed scene from a guess, if there is one, or the automatic start.

    What will be refined is verified when it is; where that tells that it is not the scene's, all is
    done anew, each answer verified before others are given up for it.
    """
    started, search = time.perf_counter(), prepared.search(posed)
    search.later = search.refined_alone
    search, done = _led(search, prepared, prepare, guess, fallback=fallback, quick=quick)
    found = completed(search, prepared, prepare, started, done=done)
    best = search.plain.best
    if found.verified or not search.later or best is None or not best.verified:
        return found
    if search.plain.check():
        return found
    search = prepared.search(posed)
    search.ledger.note(NOT_IT, time.perf_counter() - started)
    search, done = _led(search, prepared, prepare, guess, fallback=fallback, quick=quick)
    return completed(search, prepared, prepare, started, done=done)


def completed(
    search: Search, prepared: Prepared, prepare: Prepare, started: float, *, done: bool
) -> Solution:
    """Return the best solution found, refined, with what it has cost since a time.

    `done` says that the search led to a solution of what is asked.

    Raises
    ------
    ConvergenceError
        If nothing led to any.
    """
    ledger, best = search.ledger, search.best
    if best is None:
        raise no_start()
    best = replace(best, steps=tuple(ledger.steps))
    found = regularized(best, search.smooth_instead, prepare)
    best = found or prepared.refined(best if done else judged(best, search))
    in_vain = bool(best.sheets) and not best.verified
    if in_vain or best.status is Status.TOLERANCE_MISSED:
        from .sharpening import without_phases  # after a failure only

        best = without_phases(search, prepared, prepare) or best
    return with_costs(best, search, prepared, started)


def no_start() -> ConvergenceError:
    """Return what to say where there is nothing to begin with."""
    return ConvergenceError(Status.NO_START.value, Status.NO_START.name.lower())


def _led(
    search: Search,
    prepared: Prepared,
    prepare: Prepare,
    guess: Guess | None,
    *,
    fallback: bool,
    quick: bool,
) -> tuple[Search, bool]:
    """Return the search that led to a solution, or the last, and whether it did."""
    posed, started = search.posed, time.perf_counter()
    own = guess or own_guess(posed, prepared.ribbon)
    if own is not None:
        search.ledger.note(step_of(guess, posed), time.perf_counter() - started)
    led = own is not None and search.run(own, quick=quick or fallback)
    if led or not (own is None or fallback):
        return search, led
    from .nothing import from_nothing, instead_of  # IPOPT, which many do without

    after: Callable[..., Search] = from_nothing
    if own is not None:
        what = "the guess given" if guess else f"the guess ({words(posed.scene.guess)})"
        after = partial(instead_of, what, None if quick else own)
    search = after(search, partial(prepared.automatic.guesses, posed, search.ledger), prepare)
    return search, search.settled
