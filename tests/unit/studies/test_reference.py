"""A truth that a scene states is what a comparison measures against."""

from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS

from ribbonopt.scene import dump_scene, load_scene, loads_scene
from ribbonopt.studies.comparison.compare import compare

STATED = "reference={{n0: {n0}, m0: {m0}}}"


def test_errors_are_measured_against_it(configs: Path) -> None:
    wrong = STATED.format(n0=[0, 43, 42], m0=[0, 2, -9])
    scene = load_scene(configs / "moebius_half.yaml", [wrong])
    found = compare(scene, ["inverted"], ["gauss"], [1e-2])
    assert found.truth == "the reference of the scene"
    n = np.array(HALF_MOEBIUS["n0"])
    expected = np.linalg.norm(n - [0, 43, 42]) / np.linalg.norm([0, 43, 42])
    assert found.rows[-1].error_n0 == pytest.approx(expected, rel=1e-2)


def test_it_is_dumped_and_loaded(configs: Path) -> None:
    stated = STATED.format(n0=list(HALF_MOEBIUS["n0"]), m0=list(HALF_MOEBIUS["m0"]))
    scene = load_scene(configs / "moebius_half.yaml", [stated])
    assert scene.reference is not None
    assert loads_scene(dump_scene(scene)) == scene
