"""Several starts: the distinct equilibria of one scene, lowest energy first.

Mirrored, twisted by a turn to either side, then perturbed at random (seeded). Equilibria that a
symmetry of the law carries into one another (either sign of each strain, either sense of s) or that
differ by a rigid motion count as one.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import islice, product

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.ledger import Ledger
from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import Guess
from ribbonopt.guess.named import shape_of
from ribbonopt.guess.shapes import Chord, Perturbed, Shape
from ribbonopt.problem import Posed
from ribbonopt.solution.potential import known_potential
from ribbonopt.solution.solution import Solution

from .automatic import Automatic
from .first_shape import shapes_for

SAME = 1e-3  # of strains over the largest strain (root mean square), and of invariants
POINTS = 129
AMPLITUDE = 1.0  # radians, of the first mode of a perturbed start
TRIES = 2  # guesses tried from each shape

Kinds = list[list[list[int]]]


@dataclass(frozen=True, eq=False)
class Described:
    """What tells one equilibrium from others."""

    solution: Solution

    @cached_property
    def invariants(self) -> Array:
        """Energy, |n| and n . m, which no symmetry changes but for signs."""
        at, units = self.solution.at_nodes, self.solution.units
        force = np.linalg.norm(at["n"][0])
        values = np.array([self.solution.energy, force, abs(at["n_dot_m"][0])])
        invariants: Array = values / [units.moment, units.force, units.of("n_dot_m")]
        return invariants

    @cached_property
    def strains(self) -> Array:
        """Strains u (3, k) along the ribbon: dear, and needed where invariants agree."""
        outputs = self.solution.outputs(np.linspace(*self.solution.scene.interval, POINTS))
        strains: Array = outputs["u"].T
        return strains


def equilibria(
    posed: Posed,
    first: Solution | None,
    automatic: Automatic,
    attempt: Callable[[Guess], Solution],
) -> Solution | None:
    """Return the equilibrium of least energy, the other distinct ones as its `others`.

    Parameters
    ----------
    posed
        What is asked; `starts` and `seed` say how many starts, and which perturbations.
    first
        What the first start gave, if anything; returned as it is where no start leads anywhere.
    automatic
        The automatic start of this structure.
    attempt
        Solves from one guess.
    """
    started = time.perf_counter()
    found = [first] if first is not None and first.verified else []
    scene = posed.scene
    found += more_starts(posed, automatic, attempt, range(1, scene.starts))
    if not found:
        return first
    lowest = least(found)
    seconds = time.perf_counter() - started
    count = len(lowest.others) + 1
    words = "1 equilibrium" if count == 1 else f"{count} equilibria"
    step = {"step": f"{scene.starts - 1} more starts: {words} in all", "seconds": seconds}
    before = {} if first is None else first.timings
    spent = {name: before.get(name, 0.0) + seconds for name in ("rest", "total")}
    timings = {**before, **spent}
    return replace(lowest, steps=(*lowest.steps, step), timings=timings)


def more_starts(
    posed: Posed, automatic: Automatic, attempt: Callable[[Guess], Solution], numbers: range
) -> Iterator[Solution]:
    """Yield a verified solution of each start that leads to one; number 0 is the scene's own."""
    for shape in islice(_variants(posed), numbers.start - 1, numbers.stop - 1):
        try:
            found = _from_shape(posed, automatic, attempt, shape)
        except ConvergenceError:  # of this start: what others find is not lost
            continue
        if found is not None:
            yield found


def _from_shape(
    posed: Posed, automatic: Automatic, attempt: Callable[[Guess], Solution], shape: Shape
) -> Solution | None:
    """Return a verified solution that a shape leads to, or None."""
    for guess in islice(automatic.guesses(posed, Ledger(), shape), TRIES):
        solution = attempt(guess)
        if solution.verified:
            return solution
    return None


def least(solutions: Sequence[Solution], kinds: Kinds | None = None) -> Solution:
    """Return the equilibrium of least energy, the other distinct ones as its `others`."""
    lowest, *others = (
        replace(
            solutions[kind[0][0]], times=sum(solutions[i].times for image in kind for i in image)
        )
        for kind in kinds or distinct(solutions)
    )
    return replace(lowest, others=tuple(others))


def distinct(solutions: Sequence[Solution], gap: float = SAME) -> Kinds:
    """Return the indices of each equilibrium's solutions, mirror images apart.

    Equilibria come by increasing energy, images and their solutions in the order given. `gap` is
    the least difference, relative, of two that are not the same.
    """
    kinds: list[list[tuple[Described, list[int]]]] = []
    for i, solution in enumerate(solutions):
        new = Described(solution)
        kind = next((kind for kind in kinds if same(kind[0][0], new, images=True, gap=gap)), None)
        if kind is None:
            kinds.append([(new, [i])])
            continue
        image = next((i for i in kind if same(i[0], new, images=False, gap=gap)), None)
        if image is None:
            kind.append((new, [i]))
        else:
            image[1].append(i)
    kinds.sort(key=lambda kind: known_potential(kind[0][0].solution))
    return [[members for _, members in kind] for kind in kinds]


def _variants(posed: Posed) -> Iterator[Shape]:
    """Yield shapes other than the first one: twisted, then perturbed without end."""
    base = shape_of(posed) or next(shapes_for(posed))
    if isinstance(base, Chord):
        yield replace(base, bow=-base.bow)
        for turns in (1.0, -1.0):
            yield replace(base, turns=turns)
    rng = np.random.default_rng(posed.scene.seed)
    while True:
        yield Perturbed.at_random(base, AMPLITUDE, rng)


def same(a: Described, b: Described, *, images: bool, gap: float = SAME) -> bool:
    """Whether two solutions are the same one, or mirror images where these count as that."""
    off = np.abs(a.invariants - b.invariants)
    if (off > gap * np.maximum(np.abs(a.invariants), np.abs(a.invariants).max() * 1e-3)).any():
        return False
    if a.solution.scene.boundary.loop is not None:
        return True  # the same band may start elsewhere along itself
    size = float(np.abs(a.strains).max()) or 1.0
    for signs in product((1, -1), repeat=3) if images else [(1, 1, 1)]:
        image = b.strains * np.array(signs)[:, None]
        for candidate in (image, image[:, ::-1]) if images else (image,):
            if np.sqrt(np.mean((a.strains - candidate) ** 2)) <= gap * size:
                return True
    return False
