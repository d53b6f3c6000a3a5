"""Several starts: the distinct equilibria of one scene, lowest energy first.

Mirrored, twisted by a turn to either side, then perturbed at random (seeded). Equilibria that a
symmetry of the law carries into one another (either sign of each strain, either sense of s) or that
differ by a rigid motion count as one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import islice, product

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.guess import Guess
from ribbonopt.guess.named import shape_of
from ribbonopt.guess.shapes import Chord, Perturbed, Shape
from ribbonopt.scene import Scene
from ribbonopt.solution import Solution

from .automatic import Automatic, Path
from .first import dead_force_of, shapes_for

SAME = 1e-3  # of strains over the largest strain (root mean square), and of invariants
POINTS = 129
AMPLITUDE = 1.0  # radians, of the first mode of a perturbed start
TRIES = 2  # guesses tried from each shape


@dataclass(frozen=True, eq=False)
class _Found:
    """One equilibrium, what tells it from others, and how often it was met."""

    solution: Solution
    invariants: Array
    strains: Array
    times: int


def equilibria(
    scene: Scene, first: Solution, automatic: Automatic, attempt: Callable[[Guess], Solution]
) -> Solution:
    """Return the equilibrium of least energy, the other distinct ones as its `others`.

    Parameters
    ----------
    scene
        What is asked; `starts` and `seed` say how many starts, and which perturbations.
    first
        What the first start gave; returned as it is where no start leads anywhere.
    automatic
        The automatic start of this structure.
    attempt
        Solves from one guess.
    """
    started = time.perf_counter()
    found: list[_Found] = []
    if first.verified:
        _add(found, first)
    path: Path = []
    for shape in islice(_variants(scene), scene.starts - 1):
        for guess in islice(automatic.guesses(scene, path, shape), TRIES):
            solution = attempt(guess)
            if solution.verified:
                _add(found, solution)
                break
    if not found:
        return first
    found.sort(key=lambda f: potential(f.solution))
    seconds = time.perf_counter() - started
    count = "1 equilibrium" if len(found) == 1 else f"{len(found)} equilibria"
    step = {"step": f"{scene.starts - 1} more starts: {count} in all", "seconds": seconds}
    lowest, *others = (replace(f.solution, times=f.times) for f in found)
    spent = {name: first.timings.get(name, 0.0) + seconds for name in ("rest", "total")}
    timings = {**first.timings, **spent}
    return replace(lowest, others=tuple(others), path=(*lowest.path, step), timings=timings)


def potential(solution: Solution) -> float:
    """Strain energy less the work of dead forces, in the units of the solution."""
    s = np.array(solution.scene.interval)
    ends = solution.outputs(s)
    chord = ends["r"][1] - ends["r"][0]
    work = float(dead_force_of(solution.scene) @ chord)
    return float(solution.energy - work)


def _variants(scene: Scene) -> Iterator[Shape]:
    """Yield shapes other than the first one: twisted, then perturbed without end."""
    base = shape_of(scene) or next(shapes_for(scene))
    if isinstance(base, Chord):
        yield replace(base, bow=-base.bow)
        for turns in (1.0, -1.0):
            yield replace(base, turns=turns)
    rng = np.random.default_rng(scene.seed)
    while True:
        yield Perturbed.at_random(base, AMPLITUDE, rng)


def _add(found: list[_Found], solution: Solution) -> None:
    new = _described(solution)
    for i, known in enumerate(found):
        if _same(known, new, loop=solution.scene.boundary.loop is not None):
            found[i] = replace(known, times=known.times + 1)
            return
    found.append(new)


def _described(solution: Solution) -> _Found:
    s = np.linspace(*solution.scene.interval, POINTS)
    outputs = solution.outputs(s)
    force, units = np.linalg.norm(outputs["n"][0]), solution.units
    invariants = np.array([solution.energy, force, abs(outputs["n_dot_m"][0])])
    invariants /= [units.moment, units.force, units.of("n_dot_m")]
    return _Found(solution, invariants, np.stack([outputs["u2"], outputs["u3"]]), 1)


def _same(a: _Found, b: _Found, *, loop: bool) -> bool:
    gap = np.abs(a.invariants - b.invariants)
    if (gap > SAME * np.maximum(np.abs(a.invariants), np.abs(a.invariants).max() * 1e-3)).any():
        return False
    if loop:  # the same band may start elsewhere along itself
        return True
    size = float(np.abs(a.strains).max()) or 1.0
    for signs in product((1, -1), (1, -1)):
        image = b.strains * np.array(signs)[:, None]
        for candidate in (image, image[:, ::-1]):
            if np.sqrt(np.mean((a.strains - candidate) ** 2)) <= SAME * size:
                return True
    return False
