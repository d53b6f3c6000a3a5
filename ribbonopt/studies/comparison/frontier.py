"""What nothing beats: points (error, time) for which no other has less of both."""

from __future__ import annotations

from collections.abc import Sequence


def frontier(points: Sequence[tuple[float, float]]) -> list[int]:
    """Return the places of points (error, time) on the lower left envelope, by rising error.

    A point is on it unless another is as good in both and better in one; of equals, the first is.
    """
    found: list[int] = []
    quickest = float("inf")
    for i in sorted(range(len(points)), key=lambda i: (*points[i], i)):
        if points[i][1] < quickest:
            quickest = points[i][1]
            found.append(i)
    return found
