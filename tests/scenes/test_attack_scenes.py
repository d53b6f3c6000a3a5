"""Scenes nobody would write, a few of the many that `scripts/attack_scenes.py` makes."""

import sys
from pathlib import Path

import pytest

from ribbonopt.scene import Scene

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))

from attack_scenes import mutants, numeric_fields, outcome

REFUSED_OR_FINE = {"refused", "valid", "out of reach"}


def test_every_numeric_field_is_attacked() -> None:
    paths = {".".join(field.path) for field in numeric_fields(Scene)}
    assert {"law.epsilon", "interval.1", "parameters.a", "ribbon.thickness", "starts"} <= paths
    assert {"boundary.loop.half_twists", "continuation.0.values.0", "guess.helix.turns"} <= paths
    assert {"loads.force.x", "loads.points.0.at", "supports.0.position.y", "gravity.2"} <= paths
    assert {"natural.curvature", "width.values.0", "law.B.1", "ribbon.density"} <= paths
    assert len(paths) > 150


def test_the_same_seed_makes_the_same_mutants() -> None:
    first, again, other = (list(mutants(seed, 40)) for seed in (3, 3, 4))
    assert first == again != other


@pytest.mark.parametrize("seed", range(4))
def test_mutants_are_scenes_or_are_refused(seed: int) -> None:
    wrong = {
        m.label: found for m in mutants(seed, 60) if (found := outcome(m)) not in REFUSED_OR_FINE
    }
    assert not wrong
