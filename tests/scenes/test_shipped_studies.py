"""Every study in `configs/studies/` is solved whole; its rows meet its truth."""

from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS, REGULARIZED

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import loads_scene
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.study import Study, assignments
from ribbonopt.studies.batch.sweep import load_study

STUDIES = Path(__file__).parents[2] / "configs" / "studies"
NAMES = sorted(path.stem for path in STUDIES.glob("*.yaml"))


def whole(name: str, *overrides: str) -> tuple[Study, list[dict[str, float]]]:
    study = load_study([STUDIES / f"{name}.yaml"], overrides)
    rows = sorted(run_batch(study), key=lambda row: row["number"])
    assert len(rows) == study.count
    assert [row["message"] for row in rows if not row["verified"]] == []
    return study, rows


@pytest.mark.parametrize("name", NAMES)
def test_keys_fit_the_scene(name: str) -> None:
    study = load_study([STUDIES / f"{name}.yaml"])
    study.check()
    assert study.count == 500


@pytest.mark.slow
def test_arches() -> None:
    study, rows = whole("arches")
    # From a neighbour or alone, the equations hold to the tolerance; where there are several
    # equilibria the neighbour decides which one it is.
    (sweep,) = study.sweeps
    same = 0
    for row in rows[::50]:
        inputs = sweep.inputs[int(row["number"]) - 1]
        alone = solve(loads_scene(sweep.source.text, "arch", assignments(inputs)))
        same += bool(np.isclose(row["energy"], alone.energy, rtol=3e-6))
        assert row["error"] <= 1e-6
    assert same >= 8


@pytest.mark.sweep  # 4,000 starts; of fewer ribbons tests/unit/studies/test_family.py
def test_least_energies_of_arches_are_symmetric() -> None:
    _, rows = whole("arches", "starts=8")
    energies = np.array([row["energy"] for row in rows]).reshape(20, 25)  # by distance and turn
    asymmetry = np.abs(energies / energies[:, ::-1] - 1)
    # Which equilibria starts lead to is no theorem: rounding may let one be missed.
    assert np.mean(asymmetry < 1e-6) >= 0.98
    assert all(row["error"] <= 1e-6 for row in rows)


@pytest.mark.slow
def test_moebius_epsilons() -> None:
    _, rows = whole("moebius_epsilons")
    epsilon = np.array([row["law.epsilon"] for row in rows])
    u2 = np.array([row["u2"] for row in rows])
    gap = HALF_MOEBIUS["u0"][1] - u2
    order = np.argsort(epsilon)
    for value, reference in REGULARIZED.items():
        # Between the values of the study: the gap over epsilon hardly changes.
        near = np.interp(value, epsilon[order], (gap / epsilon)[order]) * value
        assert HALF_MOEBIUS["u0"][1] - near == pytest.approx(reference["u2"][0], rel=3e-8)
    slope = np.polyfit(np.log(epsilon[-100:]), np.log(gap[-100:]), 1)[0]
    assert slope == pytest.approx(1, abs=0.01)
