"""Meshes and tolerances under stress: from two intervals to ten thousand, from 1e-2 to 1e-13."""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.scene import Collocation, Scene, Shooting

from .trial import Trial, Trials, one_of

#: (degree, intervals)
FEW = ((1, 2), (6, 2), (3, 5), (10, 5), (1, 50), (6, 200))
MANY = (
    *((1, 2), (2, 2), (3, 2), (6, 2), (10, 2), (1, 5), (3, 5), (6, 5), (10, 5), (2, 10), (6, 10)),
    *((3, 20), (6, 20), (10, 20), (1, 50), (6, 50), (1, 200), (3, 200), (6, 200), (10, 200)),
    *((3, 1000), (6, 1000), (1, 10_000), (3, 10_000), (6, 10_000)),
)
USUAL = 1e-8  # tolerance of scenes that have none
STEPS = 64  # of shooting in all, whatever the intervals


def meshes(scene: Scene, quick: bool) -> list[Trial]:
    """Meshes as they are, without a tolerance: errors are large, and have to be told."""
    return _on(replace(scene, tolerance=None), quick)


def refined(scene: Scene, quick: bool) -> list[Trial]:
    """Meshes to begin with, for a tolerance."""
    return _on(replace(scene, tolerance=scene.tolerance or USUAL), quick)


def _on(scene: Scene, quick: bool) -> list[Trial]:
    given = scene.transcription
    scheme = given.scheme if isinstance(given, Collocation) else "gauss"
    return [
        Trial(
            f"degree {degree}, {intervals} intervals",
            replace(scene, transcription=Collocation("collocation", scheme, degree, intervals)),
            f"{intervals}",
            same=True,
        )
        for degree, intervals in sorted(FEW if quick else MANY, key=lambda pair: pair[::-1])
    ]


def tolerances(scene: Scene, quick: bool) -> list[Trial]:
    """Tolerances, on the scene's own mesh to begin with."""
    values = one_of(quick, (1e-2, 1e-6, 1e-10, 1e-13), [10.0**-k for k in range(2, 14)])
    return [
        Trial(f"{value:.0e}", replace(scene, tolerance=value), f"{value:.0e}", same=True)
        for value in values
    ]


def shooting(scene: Scene, quick: bool) -> Trials:
    """Single shooting (one interval) against multiple shooting, by as many steps in all."""
    counts = (1, 8) if quick else (1, 2, 4, 16, 64)
    schemes = ("rk8",) if quick else ("rk4", "rk8", "gauss")
    found = []
    for scheme in schemes:
        for count in counts:
            steps = 1 if scheme == "gauss" else STEPS // count
            mesh = Shooting("shooting", scheme, steps, 8, count)  # type: ignore[arg-type]
            changed = replace(scene, transcription=mesh)
            found.append(Trial(f"{scheme}, intervals: {count}", changed, f"{count}", same=True))
    return found
