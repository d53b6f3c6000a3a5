"""From nothing: a band from its fundamental piece, else the automatic start; or what is better.

Least energy untwists a band of several half twists, and where a law changes sheets a guess must
know where: the piece, solved in the scene's own law, has one sign change of m2 at most, or is a
mixture; its images have the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from ribbonopt.arrays import Array
from ribbonopt.checks.winding import winds_as
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import Guess
from ribbonopt.guess.flat import Flattened, nearly_flat
from ribbonopt.mechanics.ends.winding import winding
from ribbonopt.problem import Posed
from ribbonopt.starts.first_shape import shapes_for
from ribbonopt.starts.helix import helix_between, wound_evenly
from ribbonopt.starts.loops import fundamental_scene
from ribbonopt.starts.unfold import Unfolded, unfolded

from .means import Prepare
from .search import Search
from .sharpening import sharpening

SAME = 1e-6  # relative, of energies
MORE = 1.5  # times the energy of a helix that nearly fits
LEAST = 4  # intervals on every piece of a guess that is nearly the solution


def from_nothing(
    search: Search,
    guesses: Callable[..., Iterable[Guess]],
    prepare: Prepare,
) -> Search:
    """Return the search that led to a solution, or the one given.

    Parameters
    ----------
    search
        Nothing has led anywhere in it so far.
    guesses
        Gives those of the automatic start, from a `shape` if there is one.
    prepare
        Builds what solves another scene.
    """
    posed = search.posed
    scene = fundamental_scene(posed.scene) if search.needs_phases else None
    if scene is not None:
        piece = prepare(Posed.of(replace(scene, tolerance=None))).solve_once()
        search.ledger.steps.extend(piece.steps)
        if piece.verified and _run_unfolded(search, unfolded(piece, posed)):
            return search
        what = "the band's fundamental piece led to none of the whole"
        search.ledger.fall_back("piece", f"{what}; it was started from the least energy of that")
    law = search.structure.ribbon.law
    if law.direct() is not law:
        from .direct import Direct  # few laws have another energy form

        guesses = Direct(posed, search.ledger).guesses(guesses)
    elif search.needs_phases:
        guesses = sharpening(guesses, prepare)
    search.run_all(guesses())
    wound = winding(posed.scene.boundary, posed.scene.parameters)
    return _less_energy(search, guesses) if wound is None else _as_wound(search, wound, guesses)


def instead_of(
    what: str,
    guess: Guess | None,
    search: Search,
    guesses: Callable[..., Iterable[Guess]],
    prepare: Prepare,
) -> Search:
    """Return the search that led on where Newton's method led nowhere from a guess.

    IPOPT from that comes last: where it leads nowhere it takes ten times as long to find out as the
    automatic start takes to lead somewhere. Without a `guess` it does not come at all.
    """
    ledger, words = search.ledger, f"{what} led nowhere and was given up for the automatic start"
    ledger.give_up(words)
    nowhere: ConvergenceError | None = None
    try:
        search = from_nothing(search, guesses, prepare)
        if guess is not None and search.settled:
            ledger.spare("IPOPT from the guess (the automatic start led on)")
    except ConvergenceError as error:  # no equilibrium to start from
        nowhere = error
    if guess is not None and not search.settled and search.run_slowly(guess):
        ledger.given_up.remove(words)
        ledger.fall_back(
            "newton",
            f"neither Newton's method from {what} nor the automatic start led anywhere: IPOPT did",
        )
        return search
    if nowhere is not None:
        raise nowhere
    return search


def _less_energy(search: Search, guesses: Callable[..., Iterable[Guess]]) -> Search:
    """Return the search, or one from a helix that joins the clamps if that has less energy."""
    helix = helix_between(search.posed, search.structure.ribbon)
    if helix is None:
        return search
    bound = helix.energy * (1 + SAME if helix.exact else MORE)
    if search.settled and search.energy <= bound:
        return search
    words = "a helix joins the clamps" if helix.exact else "a helix nearly joins the clamps"
    start = [helix.guess] if helix.exact else guesses(shape=helix.shape)
    other = _another(search, start, words)
    better = other.settled and not (search.settled and search.energy <= other.energy)
    return other if better else search


def _as_wound(search: Search, wound: Array, guesses: Callable[..., Iterable[Guess]]) -> Search:
    """Return the search, or one for the ribbon wound evenly, if only that winds as the ends say."""
    best = search.best
    if best is not None and search.settled and winds_as(best, wound):
        return search
    even = wound_evenly(search.posed, search.structure.ribbon, wound)
    other = _another(search, [even], "wound evenly as the ends say")
    if other.settled and other.best is not None and winds_as(other.best, wound):
        return other
    if best is None or not (search.settled or search.smooth):
        for shape in shapes_for(search.posed, wound=False):  # rather than nothing
            search = _another(search, guesses(shape=shape), "not wound as the ends say")
            if search.settled:
                break
    best = search.best
    best = next(iter(search.smooth_instead), best)
    if best is not None and not winds_as(best, wound):
        search.ledger.give_up("the whole turns of the ends: no equilibrium wound so was found")
    return search


def _another(search: Search, guesses: Iterable[Guess], words: str) -> Search:
    """Return a search of the same scene from other guesses."""
    other = Search(search.posed, search.structure, search.ledger)
    other.ledger.note(words, 0.0)
    other.run_all(guesses)
    return other


def _run_unfolded(search: Search, guess: Unfolded) -> bool:
    """Try what unfolds from a piece; whether that succeeds."""
    if nearly_flat(guess.piece) and search.run(Flattened(guess), quick=True):
        return True
    arcs = guess.arcs
    if arcs is None:
        return search.run(guess, quick=True)
    return search.run_in(arcs, guess, LEAST * guess.count)
