"""Wide ribbons where least energy leads nowhere, and what is told of very narrow ones."""

import numpy as np
import pytest

from ribbonopt import prepare, solve
from ribbonopt.checks.validity import warnings_of
from ribbonopt.pipeline.told import regularized
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.solution.solution import Solution

HELD = """
name: attacked
law: {law}
tolerance: 1e-6
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{{end}}}
"""
CLAMP = (
    "support: clamped, position: [0.68, 0.15, 0.31], directors: {rotation_vector: [0, 2.4, 0.6]}"
)


@pytest.mark.parametrize("moment", [(0.0, 3.2, 2.4), (0.0, 0.3, 0.2)])
def test_a_dead_moment_at_the_end_of_a_wide_ribbon(moment: tuple[float, ...]) -> None:
    # It has no potential. By statics n = 0 and m is the same all along.
    end = f"support: free, moment: {list(moment)}"
    found = solve(loads_scene(HELD.format(law="{type: wunderlich, width: 0.05}", end=end)))
    assert found.verified
    outputs = found.outputs(np.linspace(0, 1, 21))
    assert np.abs(outputs["m"] - moment).max() < 1e-9
    assert np.abs(outputs["n"]).max() < 1e-9
    assert found.outputs(np.array([0.0]))["eta"][0] == pytest.approx(0, abs=1e-12)


def test_a_ribbon_narrower_than_the_pieces_of_its_line_does_not_meet_itself() -> None:
    law = "{type: extensible, width: 1e-9, thickness: 1e-12, poisson_ratio: 0.3}"
    found = solve(loads_scene(HELD.format(law=law, end=CLAMP)))
    assert found.verified
    assert not [words for words in warnings_of(found) if "itself" in words]


def test_a_law_that_is_linear_at_small_moments_has_no_smooth_law_instead() -> None:
    law = "{type: sano, B2: 1, B3: 2, zeta: 0.1}"
    found = solve(loads_scene(HELD.format(law=law, end=CLAMP)))
    smooth = solve(loads_scene(HELD.format(law="{type: variational, delta: 0.1}", end=CLAMP)))

    def never(scene: Scene) -> Solution:
        raise AssertionError(f"prepared {scene.law}")

    assert regularized(found, [smooth], never) is None  # type: ignore[arg-type]
    wide = solve(loads_scene(HELD.format(law="{type: wunderlich, width: 0.1}", end=CLAMP)))
    assert regularized(wide, [smooth], never) is None  # type: ignore[arg-type]
    exact = solve(loads_scene(HELD.format(law="{type: sadowsky}", end=CLAMP)))
    assert regularized(exact, [smooth], prepare) is not None


@pytest.mark.parametrize(("stiffness", "count"), [(1.0, 1), (1e5, 0)])
def test_more_stretch_than_a_linear_law_is_for_is_told(stiffness: float, count: int) -> None:
    text = HELD.format(law="{type: sadowsky}", end=CLAMP)
    found = solve(loads_scene(f"{text}membrane: {{stretching: {stiffness:g}}}\n"))
    assert found.verified
    largest = float(np.abs(found.outputs(np.linspace(0, 1, 101))["extension"]).max())
    assert (largest > 0.1) is bool(count)
    assert len([words for words in warnings_of(found) if "stretches" in words]) == count
