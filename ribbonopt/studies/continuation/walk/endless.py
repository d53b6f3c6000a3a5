"""What would go on for ever: branches that come back to where they began, or lead nowhere."""

from __future__ import annotations

from .known import SAME, Atlas, Trace
from .points import Point, S

CLOSED = "closed: it has come back to where it began"
NEAR = 1e-2  # of the first step: a point that is so near to the first is that
IDLE_POINTS = 100  # that must lead somewhere
IDLE = 1e-3  # of the first step: how far they must lead


def homeward(atlas: Atlas[S], trace: Trace, point: Point[S]) -> float:
    """Return how far a point is beyond the first of its branch: < 0 before it."""
    away = atlas.place(point) - trace.places[0]
    return atlas.metric(point).product(away, trace.headings[0])


def comes_home(atlas: Atlas[S], trace: Trace, a: Point[S], b: Point[S]) -> bool:
    """Whether the first point of a branch lies between two later ones."""
    if len(trace.places) < 3 or not homeward(atlas, trace, a) < 0 <= homeward(atlas, trace, b):
        return False
    metric, begin = atlas.metric(a), trace.places[0]
    here, there = atlas.place(a), atlas.place(b)
    near = metric.length(begin - here) <= 2 * metric.length(there - here)
    return near and atlas.passes(a, begin)


def is_home(atlas: Atlas[S], trace: Trace, last: Point[S]) -> bool:
    """Whether the last point of a branch is its first again."""
    places = trace.places
    if len(places) <= 3:
        return False
    metric = atlas.metric(last)
    away, first_step = places[-1] - places[0], metric.length(places[1] - places[0])
    beyond = homeward(atlas, trace, last) / metric.length(trace.headings[0])
    return metric.length(away) < SAME and abs(beyond) < NEAR * first_step


def is_idle(atlas: Atlas[S], trace: Trace, last: Point[S]) -> bool:
    """Whether the last points of a branch have led nowhere."""
    places = trace.places
    if len(places) <= IDLE_POINTS:
        return False
    metric = atlas.metric(last)
    first_step, latest = metric.length(places[1] - places[0]), places[-IDLE_POINTS:]
    return max(metric.length(place - latest[0]) for place in latest) < IDLE * first_step
