"""One solve of a comparison, measured: size, own error estimate, drifts, samples along s.

What is refused or does not converge is a measurement too, with the message that says why.
"""

from __future__ import annotations

import time
from dataclasses import replace
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import analyse
from ribbonopt.accuracy.gaps import ROUNDING
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError, RibbonoptError
from ribbonopt.guess import Guess
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.outputs import own_name
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import Scene
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution

from .pairs import Mesh, Pair
from .profile import SAMPLES, Profile, errors_of, relative


@dataclass(frozen=True, eq=False)
class Measurement:
    """One solve.

    Attributes
    ----------
    pair, mesh : Pair, Mesh
        How the scene was solved.
    status, message, verified : str, str, bool
        How it ended; the message in one line.
    numbers : mapping of str to int, float or None
        `unknowns`, `nonzeros`, `iterations`; CPU seconds `build`, and `solve` of the whole try;
        `drift_invariant`, `drift_law`, `drift_frame`. Empty where nothing was solved.
    profile : Profile or None
        None unless the equations are solved.
    estimate : float or None
        The solution's own estimate of its relative error of n(0), m(0).
    """

    pair: Pair
    mesh: Mesh
    status: str
    message: str
    verified: bool
    numbers: dict[str, Any]
    profile: Profile | None = None
    estimate: float | None = None

    @property
    def refused(self) -> bool:
        """Whether the pair makes no sense, so that other meshes need no try."""
        return self.status == "refused"


@dataclass(frozen=True, eq=False)
class LawResidual:
    """Departure from the constitutive law along a solution: |u - u*(m)| relative to |u|."""

    posed: Posed

    def __call__(self, s: Array, outputs: dict[str, Array], units: Units) -> float:
        """Return the largest departure on outputs sampled at arclengths s (k,)."""
        known = [outputs[f"{v}{i}"] / units.of(v) for v in "nm" for i in (1, 2, 3)]
        own = [outputs[own_name(state)] for state in capabilities(self.posed.scene).states]
        expected = np.array(self._strain(np.stack([*known, *own, s / units.length])))
        found = outputs["u"].T / units.strain
        return relative(found - expected, found)

    @cached_property
    def _strain(self) -> ca.Function:
        ribbon = Ribbon.of(self.posed)
        n, m, own = ca.SX.sym("n", 3), ca.SX.sym("m", 3), ca.SX.sym("own", len(ribbon.law.states))
        u = ribbon.law.strain(Stress(n, m, own))
        u = ca.substitute(u, ribbon.parameters, ca.DM(self.posed.values))
        return ca.Function("strain", [ca.vertcat(n, m, own, ribbon.position)], [u])


@dataclass(frozen=True, eq=False)
class Repeated:
    """A prepared scene that is solved again and again, from one guess."""

    prepared: Prepared

    @cached_property
    def guess(self) -> Guess:
        """The first guess, made once."""
        return self.prepared.guess()

    @cached_property
    def start(self) -> tuple[Array, Array]:
        """Unknowns and parameters of the guess, made once: the same for all pairs."""
        return self.prepared.start(guess=self.guess)

    def __call__(self) -> tuple[float, float]:
        """Solve again, checks left out; return the shares of functions and of linear algebra."""
        reports = self.prepared.solver.solve(*self.start).tried
        total = sum(report.total for report in reports) or 1.0
        evaluate, linear = (r.evaluate for r in reports), (r.linear for r in reports)
        return sum(evaluate) / total, sum(linear) / total


def measure(pair: Pair, scene: Scene, mesh: Mesh) -> tuple[Measurement, Repeated | None]:
    """Solve a scene by a pair on a mesh.

    What was built is returned too, to be timed; None where there is no verified solution.
    """
    try:
        started = time.process_time()
        built = Repeated(prepare(pair.scene(scene, mesh)))
        middle = time.process_time()
        # The one guess: a pair that needs another start than the rest has failed here.
        solution = built.prepared.solve(guess=built.guess, fallback=False)
        seconds = {"build": middle - started, "solve": time.process_time() - middle}
        found = _measured(pair, mesh, built.prepared, solution, seconds)
        return found, built if found.verified else None
    except ConvergenceError as error:
        return _failed(pair, mesh, error.status, error), None
    except np.linalg.LinAlgError as error:
        return _failed(pair, mesh, "singular", error), None
    except RibbonoptError as error:
        return _failed(pair, mesh, "refused", error), None


def _measured(
    pair: Pair, mesh: Mesh, prepared: Prepared, solution: Solution, seconds: dict[str, float]
) -> Measurement:
    numbers: dict[str, Any] = {
        "unknowns": prepared.nlp.unknowns,
        "nonzeros": prepared.nlp.functions.jacobian.sparsity_out(1).nnz(),
        "iterations": solution.iterations,
        **seconds,
    }
    profile = estimate = None
    if solution.status.converged:
        start, end = solution.scene.interval
        s = start + (end - start) * (np.arange(SAMPLES) + 0.5) / SAMPLES
        o = solution.outputs(s)
        profile = Profile(solution.n0, solution.m0, o["u"], solution.units)
        estimate = _estimate(solution, profile)
        numbers |= {
            "drift_invariant": solution.verification.invariant,
            "drift_law": LawResidual(solution.posed)(s, o, solution.units),
            "drift_frame": float(o["orthonormality"].max()),
        }
    message = "" if solution.verified else _line(solution.message)
    status = solution.status.name.lower()
    return Measurement(pair, mesh, status, message, solution.verified, numbers, profile, estimate)


def _estimate(solution: Solution, profile: Profile) -> float | None:
    """Own estimate of the error of n(0), m(0) alone; None where it is not known."""
    if alone(solution):
        return None
    found, units = analyse(solution), solution.units
    if not found.known:
        return None
    better = found.other.at_nodes
    n0, m0 = better["n"][0] * units.force, better["m"][0] * units.moment
    errors = errors_of(replace(profile, n0=n0, m0=m0), profile)
    return max(errors["error_n0"], errors["error_m0"], ROUNDING)


def _failed(pair: Pair, mesh: Mesh, status: str, error: Exception) -> Measurement:
    return Measurement(pair, mesh, status, _line(str(error)), False, {})


def _line(text: str) -> str:
    return " ".join(text.split())
