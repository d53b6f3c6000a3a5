"""Branches and studies under several laws: thresholds that are known, differences that are."""

import math
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.scene import load_scene
from ribbonopt.studies.batch.sweep import load_study
from ribbonopt.studies.laws.batches import compare_study
from ribbonopt.studies.laws.branches import compare_branches
from ribbonopt.studies.laws.choice import Sizes

CONFIGS = Path(__file__).parents[2] / "configs"
NU = 0.3
STUDY = """
name: arches
scene:
  name: arch
  law: {type: sadowsky}
  parameters: {shortening: 0.25}
  boundary:
    start: {position: [0, 0, 0], directors: identity}
    end: {position: [0, 0, 1 - shortening], directors: identity}
  tolerance: 1e-8
sweep: {grid: {parameters.shortening: [0.25, 0.5]}}
"""
ENERGIES = {0.25: 10.5514640, 0.5: 22.8023670}  # elliptic integrals


def crossings(law: dict[str, Any]) -> list[dict[str, Any]]:
    return [row for row in law["special"] if row["group"] == "crossing" and row["branch"] == 0]


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_a_column_buckles_under_each_law_at_its_own_load(scale: str) -> None:
    """4 pi^2 B2, of laws that differ in B2 alone where ribbons are straight."""
    step = f"scale: {scale}, largest: {2.5 if scale == 'linear' else 0.03}"
    scene = load_scene(
        CONFIGS / "column_clamped.yaml",
        ["law=sadowsky", f"continuation={{parameter: parameters.P, from: 35, to: 40, {step}}}"],
    )
    study = compare_branches(scene, ["kirchhoff"], Sizes(None, None, NU))
    own, rod = study.laws
    (first,), (other,) = crossings(own), crossings(rod)
    assert first["kind"] == "buckling point"
    assert first["value"] == pytest.approx(4 * math.pi**2, rel=1e-9)
    assert other["kind"] == "branch point"
    assert other["value_error"] < 1e-6
    assert abs(other["value"] - 4 * math.pi**2 * (1 - NU**2)) <= other["value_error"] + 1e-10


@pytest.mark.slow
def test_a_strip_under_its_weight_buckles_under_each_law_at_its_own_load() -> None:
    """21.49065961 of Sadowsky's ribbon, 12.85376332 sqrt(B2 B3) of the rod."""
    scene = load_scene(
        CONFIGS / "lateral_buckling.yaml",
        ["continuation={parameter: parameters.q, from: 10, to: 25}"],
    )
    study = compare_branches(scene, ["kirchhoff"], Sizes(None, None, NU))
    own, rod = study.laws
    (first,), (other,) = crossings(own), crossings(rod)
    assert first["value"] == pytest.approx(21.49065961, abs=1e-8)
    true = 12.85376332 * math.sqrt((1 - NU**2) * 2 * (1 - NU))
    assert other["value"] == pytest.approx(true, abs=1e-8)
    assert study.solved
    assert rod["start"]


def test_a_parameter_that_a_law_lacks_is_a_row_with_the_reason() -> None:
    scene = load_scene(
        CONFIGS / "rod_to_ribbon.yaml", ["continuation={parameter: law.rho, to: 0.2}"]
    )
    own, other = compare_branches(scene, ["sadowsky"]).laws
    assert own["verified"]
    assert not other["verified"]
    assert "law.rho" in other["message"]


def test_stiffnesses_of_one_ribbon_are_not_followed_to_another() -> None:
    scene = load_scene(
        CONFIGS / "ribbon_si.yaml",
        ["continuation={parameter: ribbon.poisson_ratio, from: 0.38, to: 0.37}"],
    )
    _, rod = compare_branches(scene, ["kirchhoff"]).laws
    assert rod["status"] == "left out"
    assert "ribbon.poisson_ratio changes it" in rod["message"]


def test_ribbons_of_a_study_are_compared_one_by_one(tmp_path: Path) -> None:
    (tmp_path / "study.yaml").write_text(STUDY)
    study = load_study([tmp_path / "study.yaml"])
    found = compare_study(study, ["kirchhoff", "sadowsky"], Sizes(None, None, NU), jobs=1)
    assert [law["law"] for law in found.laws] == ["own", "kirchhoff"]
    assert [row["number"] for row in found.rows] == [1, 2, 1, 2]
    for row in found.rows:
        factor = 1 - NU**2 if row["law"] == "kirchhoff" else 1.0
        true = factor * ENERGIES[row["parameters.shortening"]]
        assert row["energy"] == pytest.approx(true, rel=1e-7)
        if row["law"] == "kirchhoff":
            for name, wanted in (("energy", -(NU**2)), ("n0", NU**2), ("m0", NU**2)):
                bar = row[f"{name}_gap_error"]
                assert 0 < bar < 1e-6
                assert row[f"{name}_gap"] == pytest.approx(wanted, abs=bar)
    assert found.laws[1]["energy_gap"] == pytest.approx(-(NU**2), rel=1e-6)
    assert found.laws[1]["solved"] == 2


def test_numbers_of_a_law_follow_the_ribbons_of_a_study(tmp_path: Path) -> None:
    """Poisson's ratio is swept: each rod has its own stiffnesses."""
    text = STUDY.replace("sweep: {grid: {parameters.shortening: [0.25, 0.5]}}", "")
    text = text.replace("  tolerance", "  ribbon: {RIBBON}\n  tolerance")
    ribbon = "length: 1, width: 0.01, thickness: 1e-4, youngs_modulus: 12e12, poisson_ratio: 0.3"
    text = text.replace("RIBBON", ribbon)
    text += "sweep: {grid: {ribbon.poisson_ratio: [0, 0.5]}}\n"
    (tmp_path / "study.yaml").write_text(text)
    found = compare_study(load_study([tmp_path / "study.yaml"]), ["kirchhoff"], jobs=1)
    rods = [row for row in found.rows if row["law"] == "kirchhoff"]
    # Y h^3 w / 12 is the same for all; of the plate it is that over 1 - nu^2.
    for row in rods:
        assert row["energy"] == pytest.approx(12e12 * 1e-14 / 12 * ENERGIES[0.25], rel=1e-7)
    gaps = [row["energy_gap"] for row in rods]
    assert gaps == pytest.approx([0, -0.25], abs=1e-6)
