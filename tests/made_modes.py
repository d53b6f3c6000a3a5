"""Modes that are known by heart: waves across a ribbon, for tests of what tells and shows them."""

import numpy as np

from ribbonopt.checks.modes import Modes
from ribbonopt.solution.solution import Solution

FREQUENCIES = (-3.25, 22.3732854481, 61.6728228679, 120.903391727)
PLANES = (1.0, 0.0, 0.25, float("nan"))
ERRORS = (1e-6, 1e-11, float("nan"), 3e-4)


def wave(s: np.ndarray, k: int) -> tuple[np.ndarray, np.ndarray]:
    """Return sin(pi s) sin(k pi s) (n,) and its slope: symmetric about the middle for odd k."""
    a, b = np.pi * s, k * np.pi * s
    slope = np.pi * (np.cos(a) * np.sin(b) + k * np.sin(a) * np.cos(b))
    return np.sin(a) * np.sin(b), slope


def made_modes(solution: Solution, count: int = 4, unit: str = "sqrt(Dw/(rho L^4))") -> Modes:
    """Return waves along d1, then d2, ... at rest of a ribbon of length one, the first growing."""
    s = np.linspace(*solution.scene.interval, 161)
    o = solution.outputs(s)
    moved, turned = [], []
    for i in range(count):
        w, slope = wave(s, i // 2 + 1)
        across, about = (o["d1"], o["d2"]) if i % 2 == 0 else (o["d2"], -o["d1"])
        moved.append(w[:, None] * across)
        turned.append(slope[:, None] * about)
    values = np.array(FREQUENCIES[:count])
    return Modes(
        squared=np.sign(values) * values**2,
        frequencies=values,
        errors=np.array(ERRORS[:count]),
        zero=("translation along x", "sliding along itself"),
        in_plane=np.array(PLANES[:count]),
        s=s,
        displacement=np.array(moved).reshape(count, len(s), 3),
        rotation=np.array(turned).reshape(count, len(s), 3),
        unit=unit,
        negative=1,
        told="of waves",
        bounds=1e-9 * values**2,
    )
