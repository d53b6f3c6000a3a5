"""From nothing: a band from its fundamental piece, else the automatic start; a helix if better."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ribbonopt.starts.helix import helix_between

from .pieces import run_unfolded
from .search import Search

if TYPE_CHECKING:
    from .prepared import Prepared

SAME = 1e-6  # relative, of energies


def from_nothing(prepared: Prepared, search: Search) -> Search:
    """Return the search that led to a solution, or the one given."""
    posed = search.posed
    loop = posed.scene.boundary.loop
    piece = prepared.piece if loop is not None and search.needs_phases else None
    if piece is not None and run_unfolded(search, piece):
        return search
    search.run_all(prepared.automatic.guesses(posed, search.ledger))
    helix = helix_between(posed, prepared.ribbon)
    if helix is None or (search.settled and search.energy <= helix.energy * (1 + SAME)):
        return search
    other = Search(posed, prepared.structure, search.ledger)
    other.ledger.note("a helix joins the clamps", 0.0)
    return other if other.run(helix.guess, quick=True) else search
