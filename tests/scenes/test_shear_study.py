"""The study of the sheared arch: every threshold to its digits, bars that hold, kinks by name."""

from pathlib import Path
from typing import Any

import pytest
import yaml
from shear_truth import TRUTH, Key, Thresholds

from ribbonopt.scene import loads_scene
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.sweep import load_study
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, KINK, POINT

SHEAR = Path(__file__).parents[2] / "configs" / "shear"
ROUNDED = 1e-12  # of numbers near one: what no bar counts
WIDTH, MIDDLE = "parameters.width", 1 / 12


def key_of(row: dict[str, Any]) -> Key:
    law, membrane = row["law"], row.get("membrane") or {}
    return law if isinstance(law, str) else law["type"], ", ".join(membrane), row.get(WIDTH)


def assert_threshold(row: dict[str, Any], truth: Thresholds, first: bool) -> None:
    (special,) = row["specials"]
    value, digits = (truth.first, truth.digits[0]) if first else (truth.second, truth.digits[1])
    assert special["kind"] == (KINK if first and truth.kink else BRANCH_POINT)
    found, bar = special["parameters.shear"], special["error"]
    assert 0 <= bar <= 1e-8
    # Two of the seven digits of which that is all that is known are off by one.
    unit = 10.0**-digits
    assert abs(found - value) <= (unit / 2 if digits == 8 else unit) + bar * found + ROUNDED


def test_keys_fit_the_scenes() -> None:
    study = load_study([SHEAR / "thresholds.yaml"])
    study.check()
    assert study.count == 2 * len(TRUTH)


@pytest.mark.sweep
def test_every_threshold_of_the_table() -> None:
    assert found_in(SHEAR / "thresholds.yaml") == set(TRUTH)


@pytest.mark.slow
def test_every_threshold_of_the_middle_width(tmp_path: Path) -> None:
    study = yaml.safe_load((SHEAR / "thresholds.yaml").read_text(encoding="utf-8"))
    study["scene"] = [str(SHEAR / name) for name in study["scene"]]
    rows = study["sweep"]["list"]
    study["sweep"]["list"] = [row for row in rows if near(row.get(WIDTH, MIDDLE), MIDDLE)]
    (tmp_path / "some.yaml").write_text(yaml.safe_dump(study), encoding="utf-8")
    assert found_in(tmp_path / "some.yaml") == {k for k in TRUTH if near(k[2] or MIDDLE, MIDDLE)}


def found_in(path: Path) -> set[Key]:
    """Run a study, hold every threshold against the table, and return which there were."""
    rows = sorted(run_batch(load_study([path])), key=lambda row: row["number"])
    assert [row["message"] for row in rows if not row["verified"]] == []
    found: dict[str, list[Key]] = {"arch": [], "level": []}
    for row in rows:
        (key,) = (k for k in TRUTH if k[:2] == key_of(row)[:2] and near(k[2], key_of(row)[2]))
        found[row["scene"]].append(key)
        assert_threshold(row, TRUTH[key], first=row["scene"] == "arch")
    assert set(found["arch"]) == set(found["level"])
    return set(found["arch"])


def near(a: float | None, b: float | None) -> bool:
    return a == b if a is None or b is None else a == pytest.approx(b, rel=1e-12)


def kinks_of(law: str, *overrides: str) -> list[tuple[float, float | None]]:
    scene = loads_scene((SHEAR / "arch.yaml").read_text(), "arch", [f"law={law}", *overrides])
    points = [p for p in Continuation(scene) if p.kind != POINT]
    assert {p.kind for p in points} == {KINK}
    return [(p.position, p.row["error"]) for p in points]


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_the_bar_of_a_kink_holds(tolerance: float) -> None:
    # Sadowsky's threshold in units of the length, to eleven digits.
    ((position, bar),) = kinks_of("sadowsky", f"tolerance={tolerance}")
    assert bar is not None
    assert bar <= tolerance
    assert abs(position - 0.25060501787 / 1.25) <= bar * position + 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("law", ["sano", "extensible"])
def test_laws_that_leap_beyond_a_limit_kink_where_a_phase_begins_with_a_leap(law: str) -> None:
    # Before it the same law is smooth where m2 changes sign: no phases until one is needed.
    said = {
        "sano": "{type: sano, B2: 1, B3: 1.3333333333333333, zeta: 0.3169690726303044}",
        "extensible": "{type: extensible, width: 0.20833333333333334, thickness: 0.0125, "
        "poisson_ratio: 0.5}",
    }[law]
    ((position, bar),) = kinks_of(said)
    truth = next(t for k, t in TRUTH.items() if k[:2] == (law, "") and near(k[2], 1 / 6))
    assert bar is not None
    assert position == pytest.approx(truth.first, abs=0.5e-8 + bar)
