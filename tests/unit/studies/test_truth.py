"""What errors of a comparison are relative to, and how well the truth is known."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.scene import Collocation, Scene, load_scene
from ribbonopt.scene.units import Units
from ribbonopt.studies.comparison import truth
from ribbonopt.studies.comparison.measure import Measurement, measure
from ribbonopt.studies.comparison.profile import Profile, errors_of, load_sizes
from ribbonopt.studies.comparison.truth import FINE, fine_solves, truth_of

SPECIAL, SI = Units(), Units(length=0.2, force=3e-4, si=True)


def profile(n: float, m: float, units: Units = SPECIAL) -> Profile:
    """Return loads whose sizes are given in units Dw = L = 1."""
    n0 = units.force * n * np.array([0.0, 0.6, 0.8])
    m0 = units.moment * m * np.array([0.8, 0.0, -0.6])
    return Profile(n0, m0, np.ones((3, 3)) * units.strain, units)


def measured(estimate: float, *, verified: bool = True) -> Measurement:
    return Measurement(FINE, None, "converged", "", verified, {}, profile(estimate, 1.0), estimate)


@pytest.mark.parametrize("units", [SPECIAL, SI])
@pytest.mark.parametrize(("n", "m"), [(3.0, 2.0), (0.0, 2.0), (1e-12, 2.0), (3.0, 0.0), (0, 0)])
def test_loads_are_as_large_in_any_units(units: Units, n: float, m: float) -> None:
    """One that vanishes is measured by the other, and both by one."""
    sizes = load_sizes(profile(n, m, units))
    larger = max(n, m) or 1.0
    expected = (n if n > 1e-9 else larger) * units.force, (m if m > 1e-9 else larger) * units.moment
    assert sizes == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("units", [SPECIAL, SI])
def test_the_error_of_what_vanishes_is_small(units: Units) -> None:
    true = profile(0.0, 2.0, units)
    found = replace(true, n0=true.n0 + 1e-9 * units.force)
    assert errors_of(found, true)["error_n0"] == pytest.approx(1e-9 * np.sqrt(3) / 2)


@pytest.mark.parametrize(
    ("estimates", "count"), [([1e-8], 1), ([5e-7, 1e-8], 2), ([1e-3, 5e-6, 1e-6], 3)]
)
def test_the_truth_is_known_ten_times_better_than_what_it_judges(
    monkeypatch: pytest.MonkeyPatch, configs: Path, estimates: list[float], count: int
) -> None:
    meshes: list[int] = []

    def told(pair: Any, scene: Scene, mesh: Any) -> tuple[Measurement, None]:
        meshes.append(mesh.intervals)
        return measured(estimates[len(meshes) - 1]), None

    monkeypatch.setattr(truth, "measure", told)
    found = fine_solves(load_scene(configs / "moebius_half.yaml"), 1e-6)
    assert len(found) == count and meshes == sorted(set(meshes))


def test_the_truth_is_the_best_that_is_verified(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(truth, "row_of", lambda *_: SimpleNamespace(name="inverted", mesh="fine"))
    wrong = measured(1e-15, verified=False)
    best = truth_of([measured(1e-6), wrong, measured(1e-9), measured(1e-7)])
    assert best is not None
    assert best.error == 1e-9
    assert np.linalg.norm(best.profile.n0) == pytest.approx(1e-9)


@pytest.mark.parametrize("name", ["moebius_half", "helix_clamped"])
def test_its_own_estimate_is_the_larger_error_of_both_loads(configs: Path, name: str) -> None:
    scene = load_scene(configs / f"{name}.yaml")
    fine, coarse = (
        measure(FINE, scene, Collocation(degree=degree, intervals=count))[0]
        for degree, count in ((8, 40), (2, 6))
    )
    assert fine.profile is not None and coarse.profile is not None
    errors = errors_of(coarse.profile, fine.profile)
    assert errors["error_n0"] > 1.5 * errors["error_m0"]
    assert coarse.estimate == pytest.approx(errors["error_n0"], rel=0.1)
