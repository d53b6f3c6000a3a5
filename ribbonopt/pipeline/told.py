"""What is told of an answer that is not from where it was looked for first: nothing is silent."""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.solution.solution import Solution


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


def of_starts(first: Solution, found: Solution) -> Solution:
    """Return the answer of several starts, with what became of the first of them."""
    if found is first:
        return found
    words = "the first start led nowhere: the answer is from another of the `starts`"
    lost = () if first.verified else (words,)
    told = dict.fromkeys((*first.fell_back, *lost, *found.fell_back))
    given_up = dict.fromkeys((*first.given_up, *found.given_up))
    return replace(found, given_up=tuple(given_up), fell_back=tuple(told))
