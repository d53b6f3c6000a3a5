"""What a search for all equilibria says of itself: what was followed, and how far."""

from __future__ import annotations

from collections.abc import Sequence

from .line import Line
from .search import Search


def told(search: Search, lines: Sequence[Line], starts: int, above: int) -> str:
    """Return what was searched, in a few sentences; `above` were found beyond its limit."""
    ways = []
    for line in (line for line in lines if line.name in search.reached):
        low, high = search.reached[line.name]
        ways.append(f"{line.name} (which moved between {low:.5g} and {high:.5g})")
    along = f"along {' and '.join(ways)}" if ways else "along nothing, as no number moves"
    begun = "1 start" if starts == 1 else f"{starts} starts"
    said = [
        f"a search below the strain energy {search.below:.6g}, from {begun}, {along}: "
        f"{search.points} points on {search.walks} branch{'es' * (search.walks != 1)}"
    ]
    if search.endings:
        ends = ", ".join(f"{count} {how}" for how, count in search.endings.items())
        said.append(f"of the branches {ends}")
    if search.cut:
        said.append(f"more were to be followed than the {search.most} points that `points` allows")
    if search.lost:
        said.append(f"{search.lost} times an equilibrium was passed that was not solved for")
    if above:
        said.append(f"{above} more were found above that energy")
    return "; ".join(said) + "; equilibria that no such branch meets are not found"
