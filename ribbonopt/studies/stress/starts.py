"""Starts under stress: noise on the scene's own, and starts that single nothing out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.mechanics.rotations import matrix_of, quaternions_from
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import ArcGuess, LoadGuess, Scene, StrainGuess

from .trial import Trial, one_of

LEVELS = (0.01, 0.03, 0.1, 0.3, 1.0)
SEEDS, FEW_SEEDS = 10, 2
NOTHING = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Noisy:
    """A guess with every number changed by up to `level` of itself; n and m(0) as constants are."""

    guess: Guess
    level: float
    seed: int

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        rng = np.random.default_rng(self.seed)

        def changed(values: Array) -> Array:
            return np.asarray(values * (1 + self.level * rng.uniform(-1, 1, values.shape)))

        f = self.guess.fields(fraction)
        r, q = changed(f.r), changed(quaternions_from(f.frames))
        change = changed(f.n[0]) - f.n[0]
        n = f.n + change
        m = f.m + (changed(f.m[0]) - f.m[0]) + np.cross(change, r - r[0])
        own = {name: changed(values) for name, values in f.own.items()}
        return RodFields(r, np.stack([matrix_of(v) for v in q]), n, m, own)


@dataclass(frozen=True)
class _Noise:
    level: float
    seed: int

    def __call__(self, prepared: Prepared) -> Guess:
        return Noisy(prepared.guess(), self.level, self.seed)


def noise(scene: Scene, quick: bool) -> list[Trial]:
    """Every number of the start changed by its own share of itself."""
    seeds = range(FEW_SEEDS if quick else SEEDS)
    levels = one_of(quick, (0.1, 0.3, 1.0), LEVELS)
    return [
        Trial(f"{level:.0%}, seed {seed}", scene, f"{level:.0%}", True, _Noise(level, seed))
        for level in levels
        for seed in seeds
    ]


def degenerate(scene: Scene, quick: bool) -> list[Trial]:
    """Start straight, without loads, or as symmetric as can be: nothing is singled out."""
    starts = {
        "straight, no loads": LoadGuess(NOTHING, NOTHING),
        "no strains": StrainGuess((0.0, 0.0)),
        "a breath of bending": StrainGuess((1e-12, 0.0)),
        "twist alone": StrainGuess((0.0, 1.0)),
        "a plane arc": ArcGuess(np.pi / 2),
        "a plane circle": ArcGuess(2 * np.pi),
        "no guess": "auto",
    }
    return [
        Trial(name, replace(scene, guess=guess), name, True)  # type: ignore[arg-type]
        for name, guess in starts.items()
    ]
