"""Laws compared on one scene: every number against what is known without solving a scene."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.errors import SceneError
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Regularized, Scene, load_scene, loads_scene
from ribbonopt.studies.laws.choice import Sizes, choices
from ribbonopt.studies.laws.compare import LawComparison, compare_laws
from ribbonopt.studies.laws.described import Described, differences

CONFIGS = Path(__file__).parents[2] / "configs"
NU = 0.3
# The generic clamp C, and what order-8 shooting and the collocated energy agree on to all digits.
CLAMP_C = """
name: clamp-c
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end:
    support: clamped
    position: [0.68, 0.15, 0.31]
    directors: {rotation_vector: [0, 2.4, 0.6]}
tolerance: 1e-10
"""
SADOWSKY_C = {
    "energy": 3.322035406105,
    "n0": math.hypot(3.7729664362, 4.8803077155, 2.1644709480),
    "m0": math.hypot(3.2080747099, 1.7407571504, 0.1047002390),
}
# w = 0.05, eta = 0 at both ends
WUNDERLICH_C = {
    "energy": 3.322380384314,
    "n0": math.hypot(3.7739657322, 4.9038081743, 2.1688975453),
    "m0": math.hypot(3.2218579377, 1.7418099804, 0.1128457461),
}
# L / w = w / h = 20, nu = 0.3
EXTENSIBLE_C = {
    "energy": 2.965209684562,
    "n0": math.hypot(3.2860898525, 3.7762068058, 1.7395962384),
    "m0": math.hypot(2.2251158402, 1.6110355251, 0.0653687590),
}
SIZES_C = Sizes(0.05, 0.0025, NU)


def rows(study: LawComparison) -> dict[str, dict[str, Any]]:
    return {row["law"]: row for row in study.rows}


def within(row: dict[str, Any], name: str, true: float, digits: float) -> None:
    """A value is true within its bar, and the bar says something."""
    bar = row[f"{name}_error"]
    assert bar is not None
    assert bar <= 1e-7 * max(1.0, abs(true))
    assert abs(row[name] - true) <= bar + digits


def planar(*overrides: str) -> Scene:
    return load_scene(CONFIGS / "elastica_clamped.yaml", [*overrides])


def test_laws_of_a_planar_arch_differ_by_the_bending_stiffness_alone() -> None:
    study = compare_laws(
        planar("tolerance=1e-10"), ["kirchhoff", "variational", "homotopy"], Sizes(None, None, NU)
    )
    found = rows(study)
    assert list(found) == ["sadowsky", "kirchhoff", "variational", "homotopy"]
    assert all(row["verified"] for row in found.values())
    within(found["sadowsky"], "energy", 10.5514640, 1e-7)
    for name, factor in (("kirchhoff", 1 - NU**2), ("variational", 1.0), ("homotopy", 1.0)):
        row = found[name]
        assert row["shape_gap"] <= row["shape_gap_error"] + 1e-12
        for gap, wanted in (("energy", factor - 1), ("n0", 1 - factor), ("m0", 1 - factor)):
            error = row[f"{gap}_gap_error"]
            assert error <= 1e-6
            assert row[f"{gap}_gap"] == pytest.approx(wanted, abs=error + 1e-12)


def test_the_distance_of_shapes_is_that_of_two_arcs() -> None:
    """A moment bends each law to its circle, whose curvatures are as their compliances."""
    moment, B2 = 2.0, 1 - NU**2
    overrides = [f"parameters.moment={moment}", "boundary.end.moment=[0, moment, 0]"]
    scene = load_scene(CONFIGS / "end_moment.yaml", [*overrides, "tolerance=1e-10"])
    row = rows(compare_laws(scene, ["kirchhoff"], Sizes(None, None, NU)))["kirchhoff"]
    s = np.linspace(0, 1, 100_001)
    arcs = [np.stack([(1 - np.cos(k * s)) / k, np.sin(k * s) / k]) for k in (moment, moment / B2)]
    distance = float(np.linalg.norm(arcs[0] - arcs[1], axis=0).max())
    assert row["shape_gap"] == pytest.approx(distance, abs=row["shape_gap_error"] + 1e-9)
    assert 0 < row["shape_gap_error"] < 1e-8
    within(row, "energy", moment**2 / (2 * B2), 1e-12)
    assert row["energy_gap"] == pytest.approx(1 / B2 - 1, abs=row["energy_gap_error"] + 1e-12)
    # n = 0: differences of force are measured by the moment, and there are none.
    assert row["n0_gap"] <= row["n0_gap_error"] + 1e-12


def test_a_difference_has_the_bars_of_both() -> None:
    """A coarse and a fine solution of one scene differ by no more than that, either way round."""
    coarse, fine = (
        Described(
            solve(
                loads_scene(
                    CLAMP_C,
                    overrides=["tolerance=null", f"transcription={{type: collocation, {mesh}}}"],
                )
            )
        )
        for mesh in ("degree: 2, intervals: 8", "degree: 6, intervals: 20")
    )
    for pair in ((coarse, fine), (fine, coarse)):
        for name, (gap, bar) in differences(*pair).items():
            assert bar is not None
            assert 1e-9 < abs(gap) <= bar < 1e-2, name


def test_a_wide_ribbon_beside_sadowskys_on_the_generic_clamp() -> None:
    study = compare_laws(loads_scene(CLAMP_C), ["wunderlich"], Sizes(width=0.05))
    found = rows(study)
    for name, true in (("sadowsky", SADOWSKY_C), ("wunderlich", WUNDERLICH_C)):
        within(found[name], "energy", true["energy"], 1e-12)
        within(found[name], "n0", true["n0"], 2e-10)
        within(found[name], "m0", true["m0"], 2e-10)
    row = found["wunderlich"]
    gap = WUNDERLICH_C["energy"] / SADOWSKY_C["energy"] - 1
    assert row["energy_gap"] == pytest.approx(gap, abs=row["energy_gap_error"] + 1e-12)
    vectors = np.array([[-3.7739657322, -4.9038081743, -2.1688975453]])
    vectors = vectors - [[-3.7729664362, -4.8803077155, -2.1644709480]]
    gap = float(np.linalg.norm(vectors)) / SADOWSKY_C["n0"]
    assert row["n0_gap"] == pytest.approx(gap, abs=row["n0_gap_error"] + 1e-10)
    assert row["start"] == "a start from the first row"


@pytest.mark.slow
def test_five_laws_on_the_generic_clamp() -> None:
    """The extensible ribbon of L / w = w / h = 20 by shooting and by the collocated energy."""
    found = rows(compare_laws(loads_scene(CLAMP_C), ["all"], SIZES_C))
    assert list(found) == ["sadowsky", "kirchhoff", "wunderlich", "extensible", "sano"]
    assert all(row["verified"] for row in found.values())
    for name, true in (("sadowsky", SADOWSKY_C), ("wunderlich", WUNDERLICH_C)):
        within(found[name], "energy", true["energy"], 1e-12)
    for name, digits in (("energy", 1e-12), ("n0", 2e-10), ("m0", 2e-10)):
        within(found["extensible"], name, EXTENSIBLE_C[name], digits)
    gap = EXTENSIBLE_C["energy"] / SADOWSKY_C["energy"] - 1
    row = found["extensible"]
    assert row["energy_gap"] == pytest.approx(gap, abs=row["energy_gap_error"] + 1e-12)
    # Energies rise from the rod to the inextensible ribbon.
    energies = [found[name]["energy"] for name in ("kirchhoff", "sano", "extensible", "sadowsky")]
    assert energies == sorted(energies)


@pytest.mark.slow
def test_moebius_ribbons_under_all_laws_in_si_and_in_special_units() -> None:
    """The table of Wunderlich's Moebius band at w = 0.2 / pi; a unit is a unit."""
    scene = load_scene(CONFIGS / "moebius_half.yaml", ["tolerance=1e-9"])
    sizes = Sizes(width=0.2 / math.pi, edges=("free", "straight"))
    row = rows(compare_laws(scene, ["wunderlich"], sizes))["wunderlich"]
    within(row, "energy", 59.67720476 / 2, 5e-9)
    within(row, "n0", math.hypot(43.38497675, 45.15374415), 1e-8)
    assert row["energy_gap"] == pytest.approx(59.67720476 / 57.4495031138344611286 - 1, abs=2e-10)

    ribbon = "{length: 2, width: 0.12732395447, thickness: 1e-3, youngs_modulus: 1e9, "
    ribbon += "poisson_ratio: 0.3}"
    si = load_scene(
        CONFIGS / "ribbon_si.yaml",
        [f"ribbon={ribbon}", "interval=[0, 1]", "guess=auto", "tolerance=1e-9"],
    )
    other = rows(compare_laws(si, ["wunderlich"]))["wunderlich"]
    assert other["energy_gap"] == pytest.approx(row["energy_gap"], abs=1e-9)
    assert other["shape_gap"] == pytest.approx(row["shape_gap"], rel=1e-5)


def test_the_equilibrium_nearer_to_the_first_laws_is_taken() -> None:
    """Newton's method leads from Sadowsky's band to a rod of twice the least energy: that is told.

    The least is that of the same band in other units, solved by itself.
    """
    row = rows(compare_laws(load_scene(CONFIGS / "ribbon_si.yaml"), ["kirchhoff"]))["kirchhoff"]
    law = f"law={{type: kirchhoff, B2: {1 - 0.38**2}, B3: {2 * (1 - 0.38)}}}"
    alone = solve(load_scene(CONFIGS / "moebius_half.yaml", [law, "guess=auto"]))
    D = 4.5e9 * 1e-4**3 / (12 * (1 - 0.38**2))
    assert row["energy"] == pytest.approx(alone.energy * D * 0.01 / 0.3, rel=1e-9)
    assert row["start"] == "the automatic start"
    assert "another equilibrium, of more energy" in row["note"]
    assert row["shape_gap"] < 0.1


def test_numbers_come_from_the_ribbon() -> None:
    scene = load_scene(CONFIGS / "ribbon_si.yaml")
    names = ["kirchhoff", "rod", "wunderlich", "extensible", "sano"]
    found = {choice.name: choice for choice in choices(scene, names, Sizes())}
    assert found["kirchhoff"].numbers == {
        "B2": pytest.approx(1 - 0.38**2),
        "B3": pytest.approx(2 * (1 - 0.38)),
    }
    assert found["rod"].numbers["B.d1"] == pytest.approx((1 - 0.38**2) * (0.01 / 1e-4) ** 2)
    assert found["wunderlich"].numbers == {"width": 0.01}
    assert found["extensible"].numbers == {
        "width": 0.01,
        "thickness": 1e-4,
        "poisson_ratio": 0.38,
    }
    zeta = math.sqrt((1 - 0.38**2) / 60) * 0.01**2 / 1e-4
    assert found["sano"].numbers["zeta"] == pytest.approx(zeta)


def test_an_own_law_with_other_numbers_than_the_ribbons_is_told() -> None:
    scene = load_scene(CONFIGS / "ribbon_si.yaml", ["law=kirchhoff"])
    (own,) = choices(scene, [], Sizes())
    assert own.numbers == {"B2": 1.0, "B3": 2.0}
    assert "those of the ribbon would be B2 = 0.8556, B3 = 1.24" in own.note
    (own,) = choices(load_scene(CONFIGS / "ribbon_si.yaml", ["law=wunderlich"]), [], Sizes())
    assert (own.numbers, own.note) == ({"width": 0.01}, "")


def test_what_nobody_says_is_left_out_with_what_to_add() -> None:
    study = compare_laws(planar(), ["wunderlich", "extensible", "sano"], Sizes(width=0.05))
    found = rows(study)
    assert found["wunderlich"]["status"] != "left out"
    for name in ("extensible", "sano"):
        assert found[name]["status"] == "left out"
        assert "--thickness" in found[name]["message"]
        assert "--poisson" in found[name]["message"]
        assert "--width" not in found[name]["message"]


def test_sizes_are_said_once() -> None:
    scene = load_scene(CONFIGS / "ribbon_si.yaml")
    with pytest.raises(SceneError, match=r"--width: the `ribbon` of ribbon-si has width = 0.01"):
        compare_laws(scene, ["wunderlich"], Sizes(width=0.02))


def test_a_law_that_cannot_carry_a_scene_is_a_row() -> None:
    """The regularised law has no energy; that form refuses it, and the others stand."""
    scene = planar("formulation=energy", "guess=auto")
    found = rows(compare_laws(scene, ["regularized", "kirchhoff"]))
    assert not found["regularized"]["verified"]
    assert "energy" in found["regularized"]["message"]
    assert found["kirchhoff"]["verified"]
    # Minima have no bars: differences have none either, and say so.
    assert found["kirchhoff"]["energy_gap_error"] is None


def test_where_the_own_law_fails_the_next_is_the_reference() -> None:
    scene = replace(planar("formulation=energy", "guess=auto"), law=Regularized())
    study = compare_laws(scene, ["kirchhoff", "sadowsky"])
    assert not study.rows[0]["verified"]
    assert study.reference == "kirchhoff"
    assert "energy_gap" not in study.rows[1]
    assert study.rows[2]["energy_gap"] == pytest.approx(0, abs=1e-7)
