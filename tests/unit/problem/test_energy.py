"""The problem of least energy: loads from its costates, wherever the start of the ribbon is."""

import numpy as np
import pytest

from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import AnyVector, Boundary, End, Scene, Variational

CLAMP = End("clamped", (0.2, -0.1, 1.0), directors="identity")


@pytest.mark.parametrize("force", [(1.0, 0.0, 0.0), (0.7, -0.4, 0.5)])
def test_a_free_start_bears_no_moment_and_the_clamp_that_of_its_force(
    force: tuple[float, float, float],
) -> None:
    """Nothing says where the start is: the moment there is not about the origin."""
    boundary = Boundary(End("free", force=force), CLAMP)
    law = Variational(delta=0.5)
    found = solve(Scene("hangs", law, boundary, formulation="energy"))
    assert found.verified, found.message
    ends = found.sample([0.0, 1.0], "r")
    assert np.linalg.norm(ends[0]) > 0.1
    np.testing.assert_allclose(found.n0, force, atol=1e-7)
    np.testing.assert_allclose(found.m0, 0, atol=1e-6)
    expected = np.cross(force, ends[1] - ends[0])
    np.testing.assert_allclose(found.sample(1.0, "m"), expected, atol=1e-6)
    same = solve(Scene("hangs", law, boundary))
    np.testing.assert_allclose(same.sample(1.0, "m"), expected, atol=1e-6)


def test_a_force_on_an_end_that_is_held_has_no_potential() -> None:
    """It does no work, whatever it is: no minimum of an energy knows of it."""
    held = End(position=(0.0, 0.0, 0.8), force=AnyVector(z=-1.0), moment=AnyVector(x=0, y=0))
    start = End("clamped", (0.0, 0.0, 0.0), directors="identity")
    scene = Scene("held", Variational(delta=0.5), Boundary(start, held), formulation="energy")
    with pytest.raises(
        ModelError, match=r"boundary.end.force.z, other than zero, has no potential"
    ):
        prepare(scene)
