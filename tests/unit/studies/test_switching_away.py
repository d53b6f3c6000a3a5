"""How far off the first point of a branch that crosses is, where rounding is magnified nearby."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from dense_curves import Dense, Straight, Unit
from walks import run, stage

from ribbonopt.studies.continuation.walk.metric import Metric
from ribbonopt.studies.continuation.walk.points import Point
from ribbonopt.studies.continuation.walk.protocol import Trial
from ribbonopt.studies.continuation.walk.switching import AWAY


@dataclass(frozen=True)
class Blurred(Dense):
    """A pitchfork whose points are not exact up to a distance from the branch point."""

    within: float = 0.0

    def finished(self, origin: Point[Unit], trial: Trial[Unit]) -> Trial[Unit]:
        blurred = abs(trial.unknowns[0]) < self.within
        return replace(trial, blurred=blurred, note="not exact" if blurred else "")


@pytest.mark.parametrize(
    ("within", "times", "note"),
    [(0, 1, ""), (1.5, 2, ""), (3, 4, ""), (100, 1, "not exact")],
    ids=["exact there", "farther", "farthest", "nowhere"],
)
def test_the_first_point_is_where_it_is_exact(within: float, times: int, note: str) -> None:
    curve = Blurred(
        lambda z: np.array([z[1] * z[0] - z[0] ** 3]),
        lambda z: np.array([[z[1] - 3 * z[0] ** 2, z[0]]]),
        Metric(np.ones(2)),
        within=within * AWAY,
    )
    found = run([stage(curve, Straight(-1, (1,), 0.3), [0, -1], switch=1)])
    for branch, sign in ((1, 1), (2, -1)):
        first = next(point for point in found.points if point.branch == branch)
        assert first.row["z"] == pytest.approx([sign * times * AWAY, (times * AWAY) ** 2])
        assert first.note == note
        assert found.endings[0, branch].reason == "reached l = 1"
