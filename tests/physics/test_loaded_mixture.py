"""Mixtures of both sheets under loads: what keeps m2 at zero along an arc moves with the loads.

Clamps whose ribbons have mixtures without loads and with; confirmed by `tests/independent`, whose
mixtures are checked by themselves (`test_confirm.py`).
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from independent.confirm import confirm

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))

from loaded_clamps import loaded

from ribbonopt import solve
from ribbonopt.scene import Loads, Sadowsky

FORCE = (2.0, -3.0, 1.0)
SEED = 16  # m2 > 0, a mixture, m2 > 0


def test_under_a_dead_force() -> None:
    scene = replace(loaded(SEED), law=Sadowsky(), loads=Loads(force=FORCE))
    found = solve(scene)
    assert found.verified
    assert 0 in found.sheets
    assert confirm(found) < 1e-9
    # H + f . r, which no equation asks for
    kept = found.at_nodes["H"] + found.at_nodes["r"] @ np.array(FORCE)
    np.testing.assert_allclose(kept, kept[0], rtol=0, atol=1e-7)
