"""What nothing beats: points (error, time) for which no other has less of both."""

from __future__ import annotations

from collections.abc import Sequence

SLACK = 1.25  # factor of errors that is no gain


def frontier(points: Sequence[tuple[float, float]], slack: float = SLACK) -> list[int]:
    """Return the places of points (error, time) on the lower left envelope, the quickest first.

    Each has an error smaller by more than the slack than all that are as quick; of equals, the
    first is taken. With a slack of 1 these are all points that no other beats.
    """
    found: list[int] = []
    least = float("inf")
    for i in sorted(range(len(points)), key=lambda i: (points[i][1], points[i][0], i)):
        if points[i][0] * slack < least:
            least = points[i][0]
            found.append(i)
    return found
