"""Ends under stress: half twists of bands, ribbons that are nearly straight, ends that meet."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.mechanics.ends.frames import number
from ribbonopt.scene import Scene

from .trial import Trial, Trials, one_of


def half_twists(scene: Scene, quick: bool) -> Trials:
    """Bands of more and fewer half twists, from nothing."""
    loop = scene.boundary.loop
    if loop is None:
        return "it is no closed band (`boundary.loop`)"
    counts = (0, 1, 2, 3) if quick else range(10)
    found = []
    whole = (scene.interval[1] - scene.interval[0]) * loop.pieces
    for count in counts:
        small = count < 2 and loop.piece == "fundamental"  # which such a band has not
        other = replace(loop, half_twists=count, piece="half" if small else loop.piece)
        start = scene.interval[0]
        changed = replace(
            scene,
            boundary=replace(scene.boundary, loop=other),
            interval=(start, start + whole / other.pieces),
            guess="auto",
            reference=None,
        )
        found.append(Trial(f"{count}", changed, f"{count}", same=count == loop.half_twists))
    return found


def distances(scene: Scene, quick: bool) -> Trials:
    """Move the ends along the line between them, until they meet, or the ribbon is straight."""
    start, end = scene.boundary.start.position, scene.boundary.end.position
    if not (isinstance(start, tuple) and isinstance(end, tuple)):
        return "its ends are not both held in place"
    a, b = (np.array([number(v, scene.parameters) for v in p]) for p in (start, end))
    apart, length = float(np.linalg.norm(b - a)), scene.interval[1] - scene.interval[0]
    if not apart:
        return "its ends meet already"
    short = (1e-2, 1e-8) if quick else (0.1, 1e-2, 1e-4, 1e-6, 1e-8, 0.0)
    shares = {f"1 - {v:.0e}" if v else "1": 1 - v for v in short}
    shares |= {f"{v:g}": v for v in one_of(quick, (0.0,), (0.1, 1e-2, 1e-4, 1e-8, 0.0))}
    found = []
    for name, share in shares.items():
        x, y, z = (float(v) for v in a + (b - a) * (share * length / apart))
        ends = replace(scene.boundary, end=replace(scene.boundary.end, position=(x, y, z)))
        found.append(Trial(f"{name} of its length", replace(scene, boundary=ends), name))
    return found
