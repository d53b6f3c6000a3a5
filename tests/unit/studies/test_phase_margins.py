"""Phases on a branch: signs of determinants on other meshes, and layouts at a change of phases."""

import numpy as np
import pytest

from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.studies.continuation.phases import Change, What, margins, orientation
from ribbonopt.studies.continuation.relaid import at_the_ends, in_other_phases, kinds_after
from ribbonopt.transcription import Mesh

TURNED = """name: turned
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.7], directors: {turns: [{z: 20*deg}]}}
tolerance: 1e-10
"""
BORN = (Change(What.BORN_AT_START, 0), Change(What.BORN_AT_END, 2))


@pytest.fixture(scope="module")
def turned() -> Solution:
    found = prepare(loads_scene(TURNED)).solve()
    assert found.sheets == (1, -1, 1)
    return found


@pytest.mark.parametrize(
    "elements", [(16, 16, 16), (13, 25, 13), (15, 26, 40), (44, 31, 16)], ids=str
)
def test_a_determinant_is_the_same_on_every_mesh(
    turned: Solution, elements: tuple[int, ...]
) -> None:
    def determinant(found: Solution) -> tuple[float, float]:
        blocks, w, p = found.dense.blocks, found.dense.w, found.dense.p
        return CondensedSystem(blocks, blocks.linearize(w, p)[1], p).determinant

    search = prepare(turned.scene).search()
    ends = turned.trajectory.ends[1:-1]
    attempt = search.on_mesh(turned.sheets, Mesh.uniform(*elements), ends)
    assert attempt.run(turned, quick=True)
    assert attempt.best is not None
    assert determinant(attempt.best) == pytest.approx(determinant(turned), abs=1e-7)


def test_margins_are_positive_in_the_right_phases(turned: Solution) -> None:
    assert min(margins(turned).values()) > 0
    what = {change.what for change in margins(turned)}
    assert {What.BORN_AT_START, What.BORN_AT_END, What.GONE_INSIDE, What.BORN_BETWEEN} <= what


@pytest.mark.parametrize(
    ("kinds", "sign"),
    [
        *(((1,), 1), ((1, -1), -1), ((1, -1, 1), -1), ((-1, 1, -1, 1, -1), 1), ((1, 0, 1), 1)),
        *(((-1, -1), 1), ((1, 1, -1, -1), -1)),  # those of one kind meet at stations
    ],
)
def test_orientation(kinds: tuple[int, ...], sign: int) -> None:
    assert orientation(kinds) == sign


def test_what_is_born_at_an_end_is_gone_again(turned: Solution) -> None:
    search = prepare(turned.scene).search()
    attempt, w = at_the_ends(search, turned, BORN)
    there = attempt.restored(w)
    assert there.sheets == kinds_after(turned.sheets, BORN) == (-1, 1, -1, 1, -1)
    np.testing.assert_allclose(np.diff(there.trajectory.ends)[[0, -1]], 0.0, atol=1e-15)
    gone = (Change(What.GONE_AT_START, 0), Change(What.GONE_AT_END, 4))
    again, unknowns = at_the_ends(search, there, gone)
    assert again.sheets == turned.sheets
    np.testing.assert_allclose(unknowns, turned.dense.w, rtol=0, atol=1e-14)


def test_phases_that_do_not_follow_each_other_are_refused(turned: Solution) -> None:
    search = prepare(turned.scene).search()
    with pytest.raises(np.linalg.LinAlgError, match="do not follow"):
        in_other_phases(search, turned, (1, -1, 1), np.array([0.6, 0.4]))
