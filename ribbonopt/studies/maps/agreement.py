"""Whether counts on both sides of a locus agree with what happens there.

Across a fold two equilibria come or go, of which one has a negative direction more; so does the
number of equilibria with fewer negative directions than those not change. Where branches cross, the
number of all changes by two, or not at all.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from ribbonopt.plain import Row

FOLD = "fold"
CHANGE = 2  # equilibria that come or go at a fold
SHORT = 2e-3  # of the square: a common border this short tells nothing


def disagreement(kind: str, negative: int | None, here: Row, there: Row) -> str:
    """Return what does not fit in the counts on both sides of a locus; "" where all does.

    Parameters
    ----------
    kind, negative
        What the locus is of, and the fewest negative directions beside it; None where not known.
    here, there
        Rows of the counts on both sides, whose `shapes` say how many negative directions each has.
    """
    if negative is None:
        return ""
    one, other = (_by_negative(row["shapes"]) for row in (here, there))
    if one is None or other is None:
        return ""
    for below in range(negative):
        if one.get(below, 0) != other.get(below, 0):
            word = "stable shapes" if below == 0 else f"shapes with {below} negative directions"
            return (
                f"{one.get(below, 0)} and {other.get(below, 0)} {word}, which nothing there changes"
            )
    change = one.get(negative, 0) - other.get(negative, 0)
    if kind == FOLD and negative == 0 and change == 0:
        return f"{one.get(0, 0)} stable shapes on both sides of a fold of stable ones"
    return ""


def partial(kind: str, here: Row, there: Row) -> str:
    """Return why counts on both sides of a locus differ by another number than two; "" if not.

    Shapes are looked for below an energy, which those that a fold does not touch may rise above.
    """
    counts, limits = (here["count"], there["count"]), (here.get("below"), there.get("below"))
    if abs(counts[0] - counts[1]) == CHANGE or kind != FOLD or None in limits:
        return ""
    return (
        f"{counts[0]} and {counts[1]} shapes on both sides of a fold, of which {CHANGE} come or go "
        f"there: they are counted below the energies {limits[0]:.6g} and {limits[1]:.6g}, and "
        "others are above"
    )


def pairs_of(
    beside: Sequence[Mapping[int, Mapping[int, float]]],
) -> list[tuple[int, int, int]]:
    """Return pairs of neighbours with the line between them: each pair and line once."""
    return [
        (here, there, line)
        for here, neighbours in enumerate(beside)
        for there, lines in sorted(neighbours.items())
        if here < there
        for line, length in sorted(lines.items())
        if length > SHORT
    ]


def _by_negative(shapes: Sequence[Row]) -> Counter[int] | None:
    """Return how many shapes have how many negative directions; None where one is not known."""
    found: Counter[int] = Counter()
    for shape in shapes:
        if shape["negative"] is None:
            return None
        found[shape["negative"]] += 1
    return found
