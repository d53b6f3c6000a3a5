"""All equilibria of one scene: counts, energies and negative directions by other methods.

Arches in the plane between clamps at distance 1 - d, turned by angles a0 and a1 against each other:
energies by Ritz's method with polynomials, counts by 300 random starts of that and by branches from
a0 = 0; limits of energy as there. Truth of the sheared arch: shooting of half a strip.
"""

from collections import Counter
from dataclasses import replace
from functools import cache

import pytest

from ribbonopt import all_equilibria, loads_scene, prepare
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import Scene
from ribbonopt.scene.equilibria import Equilibria

ARCH = """
name: arch
law: {{type: {law}}}
parameters: {{d: {d}, a0: {a0}, a1: {a1}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: {{turns: [{{y: -a0*deg}}]}}}}
  end: {{support: clamped, position: [0, 0, 1 - d], directors: {{turns: [{{y: a1*deg}}]}}}}
planar: true
tolerance: 1e-9
"""
ROD = "kirchhoff, B2: 1, B3: 1"
BOTH = """
name: arch
law: {type: kirchhoff, B2: 1, B3: 1}
parameters: {d: 0.1, a: 36}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: {turns: [{y: -a*deg}]}}
  end: {support: clamped, position: [0, 0, 1 - d], directors: {turns: [{y: a*deg}]}}
planar: true
tolerance: 1e-9
"""
SHEARED = """
name: sheared
law: {{type: kirchhoff, B2: 1, B3: 2}}
parameters: {{y: {y}}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [0, y, 0.75], directors: identity}}
tolerance: 1e-9
"""

BAND = """
name: band
law: {type: variational, delta: 0.1}
boundary: {loop: {half_twists: 1, piece: half}}
tolerance: 1e-6
"""

Levels = tuple[tuple[float, int, int], ...]  # energy, negative directions in the plane, how many

#: d, a0, a1, energy up to which, and what there is
TABLE: list[tuple[float, float, float, float, Levels]] = [
    (0.1, 0, 0, 20, ((4.050409, 0, 2), (8.229452, 1, 2), (16.201636, 2, 2))),
    (
        *(0.1, 20, 0, 20),
        (
            *((2.796498, 0, 1), (5.470325, 0, 1), (6.552060, 1, 1), (10.364238, 1, 1)),
            *((13.608786, 2, 1), (18.960344, 2, 1)),
        ),
    ),
    (
        *(0.1, 32, 0, 20),
        (
            *((2.292140, 0, 1), (6.103222, 0, 1), (6.108913, 1, 1), (11.567956, 1, 1)),
            (12.518468, 2, 1),
        ),
    ),
    (0.1, 33, 0, 20, ((2.261576, 0, 1), (11.655854, 1, 1), (12.454260, 2, 1))),
    (0.1, 45, 0, 20, ((2.059325, 0, 1),)),
    (0.1, 90, 0, 20, ((5.090358, 0, 1),)),
    (
        *(0.1, 36, 36, 20),
        ((1.013754, 0, 1), (9.072421, 0, 1), (9.078266, 1, 2), (9.121343, 2, 1)),
    ),
    (0.1, 37.5, 37.5, 20, ((1.014893, 0, 1),)),
    (
        *(0.1, 30, -30, 20),
        (
            *((4.050409, 0, 2), (4.213358, 1, 1), (14.898448, 1, 1)),
            *((16.201636, 2, 2), (16.663379, 3, 1)),
        ),
    ),
    (
        *(0.1, 36, -36, 20),
        (
            *((4.050409, 0, 2), (4.051904, 1, 1), (15.995418, 1, 1)),
            *((16.201636, 2, 2), (16.207261, 3, 1)),
        ),
    ),
    (0.1, 38, -38, 20, ((4.057751, 0, 1),)),
    (0.25, 0, 0, 50, ((10.551464, 0, 2), (21.147160, 1, 2), (42.205856, 2, 2))),
    (
        *(0.25, 50, 0, 50),
        (
            *((6.026625, 0, 1), (15.799177, 0, 1), (15.841714, 1, 1)),
            *((29.713067, 1, 1), (32.743402, 2, 1)),
        ),
    ),
    (0.25, 90, 0, 50, ((5.510135, 0, 1),)),
    (0.4, 0, 0, 80, ((17.658627, 0, 2), (34.674794, 1, 2), (70.634510, 2, 2))),
    (
        *(0.4, 63, 0, 80),
        (
            *((10.140876, 0, 1), (26.274414, 0, 1), (26.330843, 1, 1)),
            *((48.896536, 1, 1), (54.944863, 2, 1)),
        ),
    ),
    (0.4, 66, 0, 80, ((9.926018, 0, 1), (49.506572, 1, 1), (54.494800, 2, 1))),
]
QUICK = {(0.1, 36, 36), (0.25, 50, 0)}
ROWS = [
    pytest.param(*row, marks=() if row[:3] in QUICK else pytest.mark.slow, id=f"{row[:3]}")
    for row in TABLE
]


@cache
def built() -> Prepared:
    return prepare(loads_scene(ARCH.format(law=ROD, d=0.1, a0=20, a1=0)))


def arch(d: float, a0: float, a1: float, below: float, law: str = ROD) -> Scene:
    scene = loads_scene(ARCH.format(law=law, d=d, a0=a0, a1=a1))
    return replace(scene, equilibria=Equilibria(along=("parameters.a0",), below=below))


@pytest.mark.parametrize(("d", "a0", "a1", "below", "levels"), ROWS)
def test_all_are_found(d: float, a0: float, a1: float, below: float, levels: Levels) -> None:
    found = all_equilibria(arch(d, a0, a1, below), built())
    told = tuple((round(r["energy"], 6), r["in_plane"], r["images"]) for r in found.rows)
    assert told == levels
    assert found.count == sum(images for *_, images in levels)
    assert found.stable == sum(images for _, negative, images in levels if not negative)
    assert all(solution.verified for solution in found.solutions)
    # Rounded to the sixth digit the truth is as exact as that; bars must be below it.
    assert all(0 < row["error"] < 1e-8 for row in found.rows)


@pytest.mark.slow
@pytest.mark.parametrize("path", ["parameters.a1", "parameters.d"])
def test_along_another_number_there_are_the_same(path: str) -> None:
    scene = arch(0.25, 50, 0, 50)
    other = replace(scene, equilibria=Equilibria(along=(path,), below=50))
    energies = [
        [round(row["energy"], 8) for row in all_equilibria(each, built()).rows]
        for each in (scene, other)
    ]
    assert energies[0] == energies[1]


@pytest.mark.slow
def test_random_starts_find_no_others() -> None:
    scene = replace(arch(0.1, 20, 0, 20), starts=40)
    found = all_equilibria(scene, built())
    assert found.count == 6
    assert not any(row["found_by"].startswith("start ") for row in found.rows)


@pytest.mark.slow
def test_one_number_that_keeps_the_symmetry_reaches_all_by_branches_that_cross() -> None:
    """Both clamps turned alike: two of the five lie on the branch that leaves at the pitchfork."""
    scene = loads_scene(BOTH)
    asked = Equilibria(along=("parameters.a",), below=20, modes=0)
    found = all_equilibria(replace(scene, equilibria=asked))
    energies = Counter(round(solution.energy, 6) for solution in found.solutions)
    assert energies[9.078266] == 2
    assert {9.072421, 9.078266, 9.121343} <= energies.keys()


@pytest.mark.slow
def test_the_sheared_arch_between_its_two_thresholds() -> None:
    """Symmetric under half a turn it has a negative direction from y = .2303 to .4698, else none.

    What is stable between them is not symmetric, and comes with its images.
    """
    asked = Equilibria(along=("parameters.y",), below=30)
    found = all_equilibria(replace(loads_scene(SHEARED.format(y=0.3)), equilibria=asked))
    least, symmetric = found.kinds[0], [k for k in found.kinds if "half a turn" in k.symmetry]
    assert least.stable and not least.symmetry and len(least.images) == 4
    assert [k.negative for k in symmetric] == [1] and len(symmetric[0].images) == 2
    below = all_equilibria(replace(loads_scene(SHEARED.format(y=0.2)), equilibria=asked))
    symmetric = [k for k in below.kinds if "half a turn" in k.symmetry]
    assert [k.negative for k in symmetric] == [0]


@pytest.mark.slow
def test_in_the_plane_all_laws_are_the_same() -> None:
    found = all_equilibria(arch(0.1, 20, 0, 20, law="variational, delta: 0.1"))
    assert [round(row["energy"], 6) for row in found.rows] == [level[0] for level in TABLE[1][4]]


def test_of_a_band_with_no_number_to_move_it_says_so() -> None:
    scene = loads_scene(BAND)
    found = all_equilibria(replace(scene, equilibria="all"))
    assert found.count == 1 and found.points == 0
    assert "along nothing, as no number moves" in found.told
    assert found.told.endswith("equilibria that no such branch meets are not found")
