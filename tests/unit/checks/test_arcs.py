"""Arcs read from moments along a ribbon: the same whatever the size of its moments.

A ribbon twice as short has twice the moments, and a rod may be as stiff as one likes: what has no
sign, what leaps and what is zero is told relative to the largest moment, never by itself.
"""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.checks import arcs
from ribbonopt.checks.arcs import Arcs, given_arcs, leaps, sign_changes, with_mixtures
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory

Array = np.ndarray
SIZES = [1e-3, 1.0, 1e3]  # of moments, Dw = L = 1: a hundred lengths, one, a thousandth
STAGES = (np.arange(200) + 0.5) / 200
NOISE = 1e-9 * (-1) ** np.arange(200)  # of the largest moment: what rounding leaves of a zero

each_size = pytest.mark.parametrize("size", SIZES)


class Outputs(dict[str, Array]):
    """Outputs by name, as a trajectory has them."""

    def largest(self, name: str) -> float:
        return float(np.abs(self[name]).max())


def ribbon(size: float, m2: Array, leap: Array, eta: Array | None = None) -> Solution:
    """Return what arcs are read from: m2 and leaps, over the largest moment, at all stages."""
    m = size * np.stack([np.ones_like(m2), m2, leap], axis=1)
    named = {"switching": size * m2, "leap": size * leap, "m": m}
    named["eta"] = np.zeros_like(m2) if eta is None else eta
    ends = {name: values[[0, -1]] for name, values in named.items()}
    stages = None, STAGES, None, None
    known = {"stages": stages, "at_stages": Outputs(named), "at_nodes": Outputs(ends), "found": {}}
    found: Any = SimpleNamespace(
        trajectory=SimpleNamespace(**known),
        posed=SimpleNamespace(scene=SimpleNamespace(tolerance=None)),
    )
    return found


def beyond(*stretches: tuple[float, float]) -> Array:
    """Return eta along the ribbon, beyond one sheet of the law in some stretches."""
    inside = [(STAGES > a) & (STAGES < b) for a, b in stretches]
    return np.where(np.any(inside, axis=0), 1.5, 0.5)


@each_size
def test_rounding_is_no_sign_change(size: float) -> None:
    # After s = .37 the ribbon bends back; from .8 on m2 is zero but for rounding, where m3 is not.
    m2 = np.where(STAGES < 0.8, 0.37 - STAGES, NOISE)
    found = sign_changes(ribbon(size, m2, np.full(200, 0.5)))
    assert found.kinds == (1, -1)
    np.testing.assert_allclose(found.switches, [0.37], atol=1e-12)


@each_size
def test_small_moments_have_a_sign(size: float) -> None:
    # Four digits below the largest there is nothing of rounding yet.
    found = sign_changes(ribbon(size, 1e-4 * (0.37 - STAGES), np.full(200, 0.5)))
    assert found.kinds == (1, -1)
    np.testing.assert_allclose(found.switches, [0.37], atol=1e-12)


@each_size
def test_nothing_leaps_where_twist_is_rounding(size: float) -> None:
    planar = ribbon(size, 0.37 - STAGES, np.abs(NOISE))
    assert sign_changes(planar).kinds == (1,)
    assert not leaps(planar)


@each_size
def test_a_small_twist_makes_strains_leap(size: float) -> None:
    twisted = ribbon(size, 0.37 - STAGES, np.full(200, 1e-4))
    assert sign_changes(twisted).kinds == (1, -1)
    assert leaps(twisted)


@each_size
def test_a_mixture_reaches_the_end_where_m2_is_zero(size: float) -> None:
    stretch, leap = beyond((0.0, 0.4)), np.full(200, 0.5)
    clamped = np.select([STAGES < 0.05, STAGES < 0.4], [1e-4, NOISE], -1.0)
    (held, *_) = with_mixtures(*2 * [ribbon(size, clamped, leap, stretch)])
    assert held.kinds == (1, 0, -1)
    symmetric = np.where(STAGES < 0.4, NOISE, -1.0)
    (free,) = with_mixtures(*2 * [ribbon(size, symmetric, leap, stretch)])
    assert free.kinds == (0, -1)


def test_each_end_decides_for_itself_how_far_a_mixture_goes() -> None:
    # Zero at the start, on an axis of symmetry; not at the end, which is clamped.
    m2 = np.where((STAGES < 0.3) | (STAGES > 0.7), NOISE, 1.0)
    m2[[150, -1]] = -1e-4
    one = ribbon(1.0, m2, np.full(200, 0.5), beyond((0.0, 0.3), (0.7, 1.0)))
    (first, *_) = with_mixtures(one, one)
    assert first.kinds == (0, 1, 0, -1)
    assert first.switches[-1] == pytest.approx(0.99)


def test_what_shrinks_with_delta_is_a_layer_and_no_mixture() -> None:
    # At delta and at three times that: a layer is three times as thick, a mixture as long.
    m2, leap = 0.35 - STAGES, np.full(200, 0.5)
    sharp, blunt = (
        ribbon(1.0, m2, leap, beyond((0.35 - h, 0.35 + h), (0.6, 0.8))) for h in (0.03, 0.09)
    )
    (arcs,) = with_mixtures(sharp, blunt)
    assert arcs.kinds == (1, -1, 0, -1)
    np.testing.assert_allclose(arcs.switches, [0.35, 0.6, 0.8], atol=0.01)
    layer = [ribbon(1.0, m2, leap, beyond((0.35 - h, 0.35 + h))) for h in (0.03, 0.09)]
    assert not list(with_mixtures(*layer))


@pytest.mark.parametrize("mirror", [1, -1])
def test_phases_that_a_scene_names_begin_on_the_side_where_the_ribbon_is(
    configs: Path, mirror: int
) -> None:
    whole = load_scene(configs / "moebius_regularized.yaml")
    named = replace(whole, switching=(0.2, 0.6))
    source: Any = SimpleNamespace(
        scene=whole, outputs=lambda s: {"switching": mirror * np.where(s < 0.15, 1.0, -1.0)}
    )
    found = given_arcs(source, named)
    assert found.kinds == (mirror, -mirror, mirror)
    np.testing.assert_allclose(found.switches, (0.2, 0.6))


def test_changes_without_a_leap_count_where_a_phase_would_end_on_the_other_side() -> None:
    # The switch changes its sign at .2, .4, .6 and .8; the law leaps beyond a twist alone.
    m2 = np.prod([STAGES - place for place in (0.2, 0.4, 0.6, 0.8)], axis=0)
    m2 = m2 / np.abs(m2).max()

    def leaping(*places: float) -> Array:
        return np.max([np.abs(STAGES - place) < 0.05 for place in places], axis=0) * 0.5

    nowhere = sign_changes(ribbon(1.0, m2, np.zeros(200)))
    assert nowhere.kinds == (1,)
    one = sign_changes(ribbon(1.0, m2, leaping(0.4)))
    assert one.kinds == (-1, 1)
    np.testing.assert_allclose(one.switches, [0.4], atol=1e-3)
    apart = sign_changes(ribbon(1.0, m2, leaping(0.2, 0.6)))
    assert apart.kinds == (1, -1, 1, -1)
    np.testing.assert_allclose(apart.switches, [0.2, 0.4, 0.6], atol=1e-3)
    beside = sign_changes(ribbon(1.0, m2, leaping(0.4, 0.6)))
    assert beside.kinds == (-1, 1, -1)


def test_signs_are_read_once_of_a_solution(configs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[int, float, bool]] = []
    read = arcs._sign_changes

    def counted(trajectory: Trajectory, faint: float, every: bool) -> Arcs:
        asked.append((id(trajectory), faint, every))
        return read(trajectory, faint, every)

    monkeypatch.setattr(arcs, "_sign_changes", counted)
    found = solve(load_scene(configs / "moebius_half.yaml", ["tolerance=1e-9"]))
    assert len(asked) == len(set(asked)) == 1
    # What counts is part of the question.
    assert sign_changes(found).kinds == sign_changes(found, every=True).kinds == (1,)
    assert len(asked) == len(set(asked)) == 2


@each_size
def test_one_sign_is_told_at_once_as_all_signs_are(size: float) -> None:
    """The short way says what the long one does, whichever side rounding is on."""
    for m2 in (1.0 - 0.9 * STAGES, np.abs(NOISE) + STAGES**9, np.where(STAGES < 0.8, 1.0, NOISE)):
        for sign in (1.0, -1.0):
            shown = ribbon(size, sign * m2, np.full(200, 0.5))
            assert sign_changes(shown).kinds == (sign,)
            # A sign on the other side that counts takes the long way.
            other = sign * np.where(np.arange(200) == 150, -1e-3, m2)
            assert len(sign_changes(ribbon(size, other, np.full(200, 0.5))).kinds) == 3
    assert sign_changes(ribbon(size, NOISE, np.full(200, 0.5))).kinds == (1,)
