"""Every sensible pair of formulation and transcription finds the same ribbon."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS, REGULARIZED, VARIATIONAL

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.errors import TranscriptionError
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]

FREE = "{type: algebraic, bounds: false}"
COLLOCATION = ("gauss, degree: 6", "radau, degree: 6", "lobatto, degree: 7")
EXPLICIT = ("rk4, steps: 20", "rk8, steps: 2")
IMPLICIT = ("gauss, degree: 4",)
PAIRS = [
    *((f, "collocation", s) for f in ("inverted", FREE, "differentiated") for s in COLLOCATION),
    *((f, "shooting", s) for f in ("inverted", "differentiated") for s in EXPLICIT),
    *((f, "shooting", s) for f in ("inverted", FREE, "differentiated") for s in IMPLICIT),
]
each_pair = pytest.mark.parametrize(("formulation", "kind", "scheme"), PAIRS)

# Schemes with a stage at s = 1/2, where Sadowsky's law jumps, need its analytic sheet there.
SHEET = "law={type: single_sheet, chi: 1}"


def loads(found: Solution) -> np.ndarray:
    return np.concatenate([found.n0, found.m0])


def pair(formulation: str, kind: str, scheme: str, intervals: int) -> tuple[str, str]:
    transcription = f"{{type: {kind}, scheme: {scheme}, intervals: {intervals}}}"
    return f"formulation={formulation}", f"transcription={transcription}"


def agrees(found: Solution, truth: np.ndarray, known: float) -> bool:
    bars = estimate_error(found)
    bar = max(bars["n0"], bars["m0"])
    return bool(np.abs(loads(found) - truth).max() <= 5 * bar + known)


@each_pair
def test_half_moebius(solved: Solved, formulation: str, kind: str, scheme: str) -> None:
    found = solved("moebius_half", SHEET, *pair(formulation, kind, scheme, 12))
    assert agrees(found, np.array([*HALF_MOEBIUS["n0"], *HALF_MOEBIUS["m0"]]), 1e-11)


@each_pair
def test_clamped_helix(solved: Solved, formulation: str, kind: str, scheme: str) -> None:
    near = "guess={force: [0, 12, 6], moment: [0, 3.5, 5]}"
    found = solved("helix_clamped", near, *pair(formulation, kind, scheme, 12))
    assert agrees(found, np.array([0, 12.5, 6.25, 0, 3.75, 5]), 1e-10)


@each_pair
def test_planar_elastica(solved: Solved, formulation: str, kind: str, scheme: str) -> None:
    # Kirchhoff's law: in the plane the same elastica, without the singular point m = 0.
    law = "law={type: kirchhoff}"
    found = solved("elastica_clamped", law, *pair(formulation, kind, scheme, 16))
    assert agrees(found, np.array([0, 0, -45.2259556678, 0, 6.61180050, 0]), 1e-8)


@pytest.mark.parametrize(
    ("formulation", "kind", "scheme"), [p for p in PAIRS if p[0] != "differentiated"]
)
def test_whole_moebius_regularized(
    solved: Solved, formulation: str, kind: str, scheme: str
) -> None:
    """The kink at s = 1/2 leaves every scheme order 2 to 3 there: a node sits on it.

    (The differentiated form and the full states are in `test_formulations`.)
    """
    found = solved("moebius_regularized", *pair(formulation, kind, scheme, 40))
    truth = np.array([*REGULARIZED[1e-2]["n0"], *REGULARIZED[1e-2]["m0"]])
    assert agrees(found, truth, 1e-11)


DELTA = "law={type: variational, delta: 0.01}"


@pytest.mark.parametrize("scheme", COLLOCATION)
@pytest.mark.parametrize("formulation", ["inverted", FREE])
def test_whole_moebius_variational(solved: Solved, formulation: str, scheme: str) -> None:
    """Against the half-interval solution of the same law, and SCIENCE's u2(0) at delta = 0.01."""
    half = solved("moebius_variational", "transcription.intervals=80")
    found = solved("moebius_regularized", DELTA, *pair(formulation, "collocation", scheme, 80))
    # A hundredth of the ribbon's length holds the layer of the law at s = 1/2.
    np.testing.assert_allclose(loads(found), loads(half), atol=2e-4)
    assert found.u0[1] == pytest.approx(float(VARIATIONAL[0.01][0]), abs=2e-5)


# Not Radau: one-sided, it drags the loop along itself, which costs no energy.
@pytest.mark.parametrize("scheme", [COLLOCATION[0], COLLOCATION[2]])
def test_whole_moebius_minimises_the_energy(solved: Solved, configs: Path, scheme: str) -> None:
    """Closed in x too: with x(1) free, n1(0) = 0 is natural and the closed loop no minimum."""
    closed = ("boundary.start.force=null", "boundary.end.position=[0, 0, 0]")
    mesh = pair("energy", "collocation", scheme, 80)
    scene = load_scene(configs / "moebius_regularized.yaml", [DELTA, *closed, *mesh])
    found = prepare(scene).solve(guess=solved("moebius_regularized", DELTA))
    assert found.verified
    half = solved("moebius_variational", "transcription.intervals=80")
    # SCIENCE section 4: E = H L for a closed loop without load.
    assert found.energy == pytest.approx(float(half.start["H"]), rel=1e-8)
    np.testing.assert_allclose(loads(found), loads(half), atol=2e-4)


@pytest.mark.parametrize(
    ("formulation", "kind", "scheme", "message"),
    [
        (FREE, "shooting", "rk8", "explicit and integrates ordinary differential equations only"),
        ("algebraic", "shooting", "gauss", "no unknowns inside the intervals"),
        ("energy", "shooting", "gauss", "cannot minimise a cost"),
        ("inverted", "collocation", "lobatto, degree: 1", "degree"),
    ],
)
def test_pairs_without_sense_are_refused_in_a_sentence(
    configs: Path, formulation: str, kind: str, scheme: str, message: str
) -> None:
    with pytest.raises(TranscriptionError, match=message) as refusal:
        prepare(load_scene(configs / "moebius_half.yaml", pair(formulation, kind, scheme, 10)))
    assert "\n" not in str(refusal.value)


def test_one_interval_is_single_shooting(solved: Solved) -> None:
    single = "transcription={type: shooting, scheme: rk8, steps: 40, intervals: 1}"
    found = solved("moebius_half", SHEET, single)
    assert found.dense.blocks.layout.unknowns == 2 * 7 + 6
    np.testing.assert_allclose(found.n0, HALF_MOEBIUS["n0"], atol=1e-8)
