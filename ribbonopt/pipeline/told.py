"""What is told of an answer that is not from where it was looked for first: nothing is silent."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

from .means import Means, Prepare
from .skipped import skipped

if TYPE_CHECKING:
    from .search import Search


def of_finer_mesh(missed: Solution, found: Solution) -> Solution:
    """Return the answer on a finer mesh, where that was solved anew instead of followed."""
    if found is missed:
        return found
    count = found.dense.blocks.layout.element_count
    words = (
        "from the answer on the intervals asked for no finer mesh led on to the tolerance: it was "
        f"solved anew, on {count} intervals"
    )
    return replace(found, fell_back=(*found.fell_back, words))


def of_starts(first: Solution | None, found: Solution) -> Solution:
    """Return the answer of several starts, with what became of the first of them, if anything."""
    if found is first:
        return found
    words = "the first start led nowhere: the answer is from another of the `starts`"
    if first is None:
        return replace(found, fell_back=tuple(dict.fromkeys((words, *found.fell_back))))
    lost = () if first.verified else (words,)
    told = dict.fromkeys((*first.fell_back, *lost, *found.fell_back))
    given_up = dict.fromkeys((*first.given_up, *found.given_up))
    return replace(found, given_up=tuple(given_up), fell_back=tuple(told))


def regularized(best: Solution, smooth: Sequence[Solution], prepare: Prepare) -> Solution | None:
    """Return an equilibrium of the smooth law, labelled: none was found of the exact one."""
    if not smooth:
        return None
    law = capabilities(best.scene)
    if law.linear_at_zero or law.states:
        return None  # equilibria of rods, or of wide ribbons, may be far from any of the smooth law
    for one in smooth:
        scene = replace(best.scene, law=one.scene.law, switching="off", guess="auto", starts=1)
        found = prepare(scene).solve(guess=one, fallback=False)
        if found.verified:
            steps, status = (*best.steps, *found.steps), Status.REGULARIZED
            return replace(found, status=status, message=status.value, steps=steps)
    return None


def judged(best: Solution, search: Search) -> Solution:
    """Return a solution, as a wrong one where its strains jump without a phase that ends there.

    Newton's method may report success on one (see `search`), which is then not refined.
    """
    if not best.verified or best.sheets or not search.jumps(best):
        return best
    switch = search.structure.ribbon.law.switch_name
    what = f"{switch} changes sign along it, and no phases that end there were found"
    status = Status.WRONG_SOLUTION
    return replace(best, status=status, message=f"{status.value}. {what}")


def with_costs(found: Solution, search: Search, prepared: Means, started: float) -> Solution:
    """Return a solution with what it has cost since a time, and what was given up or not done."""
    ledger, problem = search.ledger, prepared.problem
    return replace(
        found,
        timings=ledger.timings(prepared.seconds, time.perf_counter() - started),
        iterations=ledger.iterations,
        given_up=(*ledger.given_up, *other_phases(search)),
        fell_back=tuple(ledger.fell_back.values()),
        skipped=skipped(search.posed, problem, search, found),
    )


def other_phases(search: Search) -> tuple[str, ...]:
    """Say that the phases which a scene names are not those of the solution."""
    named, best = search.posed.scene.switching, search.best
    if not isinstance(named, tuple) or best is None or not best.verified:
        return ()
    wanted, found = len(named) + 1, max(len(best.sheets), 1)
    words = f"the sign changes that `switching` names led nowhere: {found} phases, not {wanted}"
    return () if found == wanted else (words,)
