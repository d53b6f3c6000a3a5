"""The sheared arch of Wunderlich's ribbon: both forms of the problem tell the same thresholds.

The equations with costates are singular where the determinant vanishes; the energy form, whose own
controls are u2 and xi, gains one negative direction there.
"""

from dataclasses import replace
from pathlib import Path

import pytest
from shear_truth import WIDE, WIDTHS

from ribbonopt.checks.stability import negative_directions
from ribbonopt.scene import ContinuationStage, Sadowsky, Scene, Wunderlich, load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.phases import What, margins
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, POINT, Point

SHEAR = Path(__file__).parents[2] / "configs" / "shear"
SHEARED = "parameters.shear"
BEGIN = 0.16  # from nothing the symmetric arch is found up to there, whatever its width
UNITS = 1.25  # of w / L, in those of the length
WIDEST = max(WIDTHS)  # the others take half a minute each

of_widths = pytest.mark.parametrize(
    "width",
    [pytest.param(w, marks=pytest.mark.slow if w == WIDEST else pytest.mark.sweep) for w in WIDTHS],
)


def scene_of(name: str, width: float, **stage: object) -> Scene:
    scene = replace(load_scene(SHEAR / f"{name}.yaml"), law=Wunderlich(width=UNITS * width))
    return replace(scene, continuation=ContinuationStage(SHEARED, largest=0.05, **stage))


def assert_threshold(points: list[Point[Solution]], value: float, unit: float) -> None:
    """Assert that one branch point is the threshold, and that the energy form tells it too."""
    (special,) = (p for p in points if p.kind != POINT)
    assert special.kind == BRANCH_POINT
    bar = special.row["error"]
    assert bar is not None
    assert abs(special.position - value) <= unit + bar * value
    sides = {p.position > value: negative_directions(p.solution) for p in points if p.kind == POINT}
    assert sides[True] is not None
    assert sides[False] is not None
    assert abs(sides[True] - sides[False]) == 1


@of_widths
def test_both_forms_tell_where_the_arch_loses_its_symmetry(width: float) -> None:
    (first, unit), _ = WIDE[width]
    scene = scene_of("arch", width, from_=min(first - 0.03, BEGIN), to=first + 0.02)
    assert_threshold(list(Continuation(scene)), first, unit)


@pytest.mark.sweep
@pytest.mark.parametrize("width", WIDTHS)
def test_both_forms_tell_where_the_level_state_does(width: float) -> None:
    _, (second, unit) = WIDE[width]
    near = replace(scene_of("level", width, from_=0.0, to=second + 0.004), law=Sadowsky())
    follow = Continuation(scene_of("level", width, from_=second + 0.004, to=second - 0.004))
    follow.near = list(Continuation(near))[-1].solution
    points = list(follow)
    kinds = [c.what for p in points for c in margins(p.solution)]
    assert What.BORN_BETWEEN not in kinds  # its sides are no sheets that mix
    assert_threshold(points, second, unit)
