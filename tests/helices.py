"""Clamps at the ends of helices, by algebra: of constant strains (0, u2, u3) from the origin.

Sadowsky's relaxed law: |u2| > |u3| on one sheet, with n, m and H of eqs. (2.4)-(2.7); |u2| < |u3| a
mixture, with n = 4 u3 (u2 d2 + u3 d3), m = 4 u3 d3 and the energy 2 u3^2 per length.
"""

import numpy as np
from scipy.linalg import expm

from ribbonopt.scene import Boundary, Directors, End, Law, Sadowsky, Scene, StrainGuess

Array = np.ndarray


def end_of(u2: float, u3: float) -> tuple[Array, Array]:
    """Position (3,) and frame (3, 3) at s = 1: the exponential of the constant twist."""
    generator = np.zeros((4, 4))
    generator[:3, :3] = [[0, -u3, u2], [u3, 0, 0], [-u2, 0, 0]]
    generator[2, 3] = 1
    placed = expm(generator)
    return placed[:3, 3], placed[:3, :3]


def energy_of(u2: float, u3: float) -> float:
    """Energy of unit length."""
    return 2 * u3**2 if abs(u2) < abs(u3) else (u2**2 + u3**2) ** 2 / (2 * u2**2)


def loads_of(u2: float, u3: float) -> tuple[Array, Array]:
    """Force and moment at the start, along the directors."""
    if abs(u2) < abs(u3):
        return 4 * u3 * np.array([0, u2, u3]), np.array([0, 0, 4 * u3])
    eta = u3 / u2
    n = np.array([0, u2 * u3, u3**2]) * (1 + eta**2) ** 2
    return n, np.array([0, u2 * (1 - eta**4), 2 * u3 * (1 + eta**2)])


def clamped_at(
    position: Array,
    frame: Array,
    law: Law | None = None,
    *,
    known: bool = False,
    strains: tuple[float, float] = (0.0, 0.0),
    tolerance: float = 1e-8,
) -> Scene:
    """Return the ribbon from the origin and the lab axes to a place; `known` strains as guess."""
    directors = Directors(*(tuple(column) for column in frame.T.tolist()))
    start = End(position=(0.0, 0.0, 0.0), directors="identity")
    end = End(position=tuple(position.tolist()), directors=directors)
    guess = StrainGuess(strains) if known else "auto"
    law = law or Sadowsky()
    return Scene("helix", law, Boundary(start, end), guess=guess, tolerance=tolerance)


def drawn(count: int, seed: int, turns: float) -> list[tuple[float, float]]:
    """Draw strains (u2, u3) of up to some turns in all, mixtures and sheets in turn."""
    rng = np.random.default_rng(seed)
    found = []
    for i in range(count):
        angle, side = rng.uniform(0.1 * np.pi, 2 * np.pi * turns), rng.uniform(0, 2 * np.pi)
        u2, u3 = angle * np.cos(side), angle * np.sin(side)
        mixture = abs(u2) < abs(u3)
        found.append((u2, u3) if mixture == (i % 2 == 0) else (u3, u2))
    return found
