"""Ever sharper smooth laws, from which to read phases that the automatic start does not show.

At delta = 0.01 a jump of the curvature and a mixture look alike, and a short phase next to an end
is hidden. The smooth law is followed further down, on meshes that resolve its layers: jumps shrink,
mixtures stay.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ribbonopt.guess import Guess
from ribbonopt.mechanics.laws.smooth import in_family, sharpened
from ribbonopt.problem import Posed
from ribbonopt.scene import Collocation, Newton
from ribbonopt.solution.solution import Solution

from .means import Means, Prepare

if TYPE_CHECKING:
    from .search import Search

DELTAS = (2e-3, 4e-4, 8e-5)
TOLERANCE = 1e-4  # of these solutions, which only show where phases begin
MESH = Collocation(scheme="gauss", degree=6, intervals=20)
SOLVER = Newton(max_iterations=40)


def sharpening(
    guesses: Callable[..., Iterable[Guess]], prepare: Prepare
) -> Callable[..., Iterator[Guess]]:
    """Return what gives the same guesses, sharper equilibria behind the first of a smooth law."""

    def sharpened_guesses(**shape: Any) -> Iterator[Guess]:
        done = False
        for guess in guesses(**shape):
            yield guess
            if isinstance(guess, Solution) and in_family(guess.posed.scene.law) and not done:
                done = True
                yield from sharper(guess, prepare)

    return sharpened_guesses


def sharper(blunt: Solution, prepare: Prepare) -> Iterator[Solution]:
    """Yield ever sharper equilibria of the smooth law, each on a mesh that resolves its layers."""
    scene = replace(blunt.posed.scene, guess="auto", starts=1, switching="off", solver=SOLVER)
    scene = replace(scene, transcription=MESH, tolerance=TOLERANCE)
    prepared, mesh = prepare(Posed.of(scene)), None
    for delta in DELTAS:
        posed = prepared.posed(replace(scene, law=sharpened(scene.law, delta)))
        search = prepared.search(posed)
        attempt = search.plain if mesh is None else search.on_mesh((), mesh)
        if not attempt.run(blunt, quick=True, check=False) or attempt.best is None:
            return
        blunt = prepared.refined(attempt.best, search=search)
        if not blunt.status.converged:
            return
        yield blunt
        mesh = blunt.mesh


def without_phases(search: Search, prepared: Means, prepare: Prepare) -> Solution | None:
    """Return a solution to tolerance without phases, where those that were tried lead to none.

    Of a law that has no more than a kink: a mesh graded to that will do. Sharper smooth laws have
    their layers in the same places.
    """
    if search.sharpest is None or search.needs_phases or not search.phases_help:
        return None
    for sharp in sharper(search.sharpest, prepare):
        attempt = search.on_mesh((), sharp.mesh)
        if attempt.run(sharp, quick=True, check=False) and attempt.best is not None:
            first = replace(attempt.best, steps=tuple(search.ledger.steps))
            found = prepared.refined(first, search=search)
            if found.verified:
                words = "no phases led to the tolerance: solved without, on a mesh of the kinks"
                search.ledger.fall_back("phases", words)
                return found
    return None
