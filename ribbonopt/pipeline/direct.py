"""Guesses for a law whose energy form is another problem: what minimises that, near a smooth law's.

Wunderlich's equations grow by exp(sqrt(24) s / w) in either sense and are singular where the
curvature changes its sign, so that Newton's method on them needs all states from the first; the
energy form has neither difficulty, and tells how many sign changes there are. Its own states must
not change faster than the law allows, else minimising leads astray.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.structure import Structure
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.mechanics.ends.edges import EdgeHeld
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import Collocation, Ipopt
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

MESH = Collocation(scheme="gauss", degree=3, intervals=30)
FINE = Collocation(scheme="gauss", degree=6, intervals=60)  # where Newton's method needs a better
SOLVER = Ipopt(tolerance=1e-7, max_iterations=60)
ENDS = 2.0  # how much they gather at the ends, where a clamp makes a layer
PLACES = 401  # where states are made slower
SLOWER = 0.8  # of the largest rate


@dataclass(frozen=True, eq=False)
class Slowed:
    """A solution as a guess, with own states and controls `own` (k,) at fractions `places` (k,)."""

    solution: Solution
    places: Array
    own: Mapping[str, Array]

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        own = {name: np.interp(fraction, self.places, v) for name, v in self.own.items()}
        return replace(self.solution.fields(fraction), own=own)


class Direct:
    """The energy form of a scene, from nearby equilibria of other laws."""

    def __init__(self, posed: Posed, ledger: Ledger) -> None:
        settings = {"formulation": "energy", "states": "reduced", "solver": SOLVER}
        self.posed = posed.under(transcription=MESH, **settings)
        self.fine = posed.under(transcription=FINE, **settings)
        self.ledger = ledger

    @cached_property
    def structure(self) -> Structure:
        """Its equations, without loads that have no potential."""
        return Structure.least_energy(self.posed)

    @cached_property
    def finer(self) -> Structure:
        """The same on a finer mesh."""
        return replace(self.structure, posed=self.fine, _programs={}, _phased={})

    def guesses(self, others: Callable[..., Iterable[Guess]]) -> Callable[..., Iterator[Guess]]:
        """Return what gives minima near the solutions that others give, and the rest as it is.

        Each again on a finer mesh, if it led nowhere, and at last the solution itself.
        """

        def found(**shape: Any) -> Iterator[Guess]:
            for guess in others(**shape):
                if not isinstance(guess, Solution):
                    yield guess
                    continue
                near = self._minimum(self.structure, self.posed, self._slowed(guess))
                if near is not None:
                    yield near
                    near = self._minimum(self.finer, self.fine, near)
                if near is not None:
                    yield near
                yield guess  # least energy knows no loads without a potential

        return found

    def _minimum(self, structure: Structure, posed: Posed, near: Guess) -> Solution | None:
        """Return a minimum near a guess, if one is found."""
        mesh = _mesh(posed.scene.transcription.intervals)
        attempt = structure.attempt(posed, self.ledger, mesh)
        attempt.run(near, check=False)
        best = attempt.best
        return best if best is not None and best.status.converged else None

    def _slowed(self, near: Solution) -> Slowed:
        """Return a solution with own states that the law allows, and the controls for them."""
        ribbon, places = self.structure.ribbon, np.linspace(0.0, 1.0, PLACES)
        start, end = self.posed.scene.interval
        s, fields = start + (end - start) * places, near.fields(places)
        local = np.hstack([np.einsum("ki,kij->kj", v, fields.frames) for v in (fields.n, fields.m)])
        theta = np.repeat(self.posed.values[:, None], PLACES, axis=1)
        first, controls = ribbon.kept(_guessed)
        own, most = (np.array(v) for v in first.map(PLACES)(local.T, theta, s[None]))
        for end_held in self._held:
            own[:, end_held] = 0.0
        reach = SLOWER * most.min(axis=1) * (end - start)
        pairs = zip(own, reach, strict=True)
        own = np.array([_slower(row, places, float(rate)) for row, rate in pairs])
        rates = np.gradient(own, s, axis=1)
        rates = np.clip(rates, -SLOWER * most, SLOWER * most)
        found = np.array(controls.map(PLACES)(local.T, own, rates, theta, s[None]))
        names = (*ribbon.law.states, *ribbon.law.controls)
        return Slowed(near, places, dict(zip(names, np.vstack([own, found]), strict=True)))

    @property
    def _held(self) -> list[int]:
        """Places of the ends whose edges are straight."""
        held = [c.end for c in self.posed.conditions if isinstance(c, EdgeHeld) and c.kinematic]
        return [{"start": 0, "end": -1}[end] for end in held]


def _guessed(ribbon: Ribbon) -> tuple[ca.Function, ca.Function]:
    """Functions of n and m along the directors: own states and largest rates, and controls."""
    law, local = ribbon.law, ca.SX.sym("local", 6)
    own, rates = (ca.SX.sym(name, len(law.states)) for name in ("own", "rates"))
    stress = Stress(local[:3], local[3:], own)
    inputs = ribbon.parameters, ribbon.position
    guess = [ca.densify(law.own_guess(stress)), ca.densify(law.most_rate())]
    controls = [ca.densify(law.controls_for(stress, rates))]
    return (
        ca.Function("guessed", [local, *inputs], guess),
        ca.Function("controls", [local, own, rates, *inputs], controls),
    )


def _slower(values: Array, places: Array, rate: float) -> Array:
    """Return values (k,) that change no faster: half way between the envelopes that do not."""
    if not np.isfinite(rate):
        return values
    apart = rate * np.abs(places[:, None] - places)
    above, below = (values + apart).min(axis=1), (values - apart).max(axis=1)
    return np.asarray((above + below) / 2)


def _mesh(count: int) -> Mesh:
    """Return a mesh that gathers at both ends."""
    x = np.linspace(-1, 1, count + 1)
    return Mesh((np.diff(np.tanh(ENDS * x)) / (2 * np.tanh(ENDS)),))
