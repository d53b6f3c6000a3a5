"""The guesses that a scene can name: shapes, loads, strains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.frames import number
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import (
    ArcGuess,
    HelixGuess,
    LoadGuess,
    Loop,
    MoebiusGuess,
    SolutionGuess,
    StrainGuess,
)

from .loads import IntegratedLoads
from .shapes import Helical, Shape, TwistedCircle
from .unknowns import Guess

TURN = 16  # samples for each radian
ROD = np.array([0.0, 1.0, 2.0])  # moment over strain of a ribbon that is hardly twisted


@dataclass(frozen=True, eq=False)
class ShapeGuess:
    """A shape, without force unless one is given: nothing to be known of loads.

    The moment is that of `law` for its strains (k, 3), or of a rod of stiffness 1 and 2; it need
    not be in equilibrium. `force` (3,) is in the lab frame.
    """

    shape: Shape
    law: Callable[[Array], Array] | None = None
    force: Array | None = None

    def balanced(self) -> ShapeGuess:
        """Return the same with the constant force that balances its moments best: m' = n x d3.

        Exact for helices; for guesses that wind so often that Newton's method would find another
        equilibrium near by.
        """
        fraction = np.linspace(0, 1, 16 + int(TURN * self.most_turning))
        found = self.fields(fraction)
        d3 = found.frames[1:-1, :, 2]
        rates = np.gradient(found.m, self.shape.length * fraction, axis=0)[1:-1]
        across = np.eye(3) - d3[:, :, None] * d3[:, None, :]
        force = np.linalg.lstsq(across.sum(axis=0), np.cross(d3, rates).sum(axis=0), rcond=1e-8)[0]
        return replace(self, force=force)

    @property
    def most_turning(self) -> float:
        """Bound of the angle (radians) by which the frames turn in all."""
        strains = self.shape.strains(np.linspace(0, 1, 33))
        return self.shape.length * float(np.linalg.norm(strains, axis=1).max())

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        r, frames = self.shape.positions(fraction), self.shape.frames(fraction)
        strains = self.shape.strains(fraction)
        moments = strains * ROD if self.law is None else self.law(strains)
        m = np.einsum("kij,kj->ki", frames, moments)
        n = np.zeros_like(r) if self.force is None else np.tile(self.force, (len(r), 1))
        return RodFields(r, frames, n, m)


def guess_of(posed: Posed, ribbon: Ribbon) -> Guess | None:
    """Return the guess that a scene names; None for `auto` and for saved solutions."""
    guess = posed.scene.guess
    if isinstance(guess, LoadGuess):
        return IntegratedLoads(ribbon, posed, guess)
    shape = shape_of(posed)
    return None if shape is None else ShapeGuess(shape, moments_of(posed, ribbon))


def shape_of(posed: Posed) -> Shape | None:
    """Return the shape that a scene's guess names, or None if it names none."""
    scene, length, place = posed.scene, posed.length, posed.start
    guess, parameters = scene.guess, scene.parameters
    piece = "whole" if scene.boundary.loop is None else scene.boundary.loop.piece
    if guess == "circle":
        return loop_shape(posed, Loop(0, piece))
    if isinstance(guess, MoebiusGuess):
        band = guess.moebius
        return loop_shape(posed, Loop(band.half_twists, band.piece or piece))
    if isinstance(guess, StrainGuess):
        return Helical(*place, np.array([0.0, *guess.strains]), length)
    if isinstance(guess, ArcGuess):
        bent = number(guess.arc, parameters) / length
        return Helical(*place, np.array([0.0, bent, 0.0]), length)
    if isinstance(guess, HelixGuess):
        turn = 2 * np.pi * number(guess.helix.turns, parameters) / length
        rise = guess.helix.rise
        strains = turn * np.array([0.0, np.sqrt(1 - rise**2), rise])
        return Helical(*place, strains, length)
    return None


def loop_shape(posed: Posed, loop: Loop) -> TwistedCircle:
    """Return a twisted circle, or the piece of it that is solved, from where a scene starts.

    The fundamental piece lies about the origin of the lab, as `mechanics.ends.loops` has it.
    """
    if loop.piece == "fundamental" and not loop.half_twists:
        raise ModelError("guess: a circle without half twists has no fundamental piece", "guess")
    length, place = posed.length, posed.start
    if loop.piece == "fundamental":
        radius = loop.pieces * length / (2 * np.pi)
        place = np.array([-radius, 0.0, 0.0]), np.eye(3)
    share = 1 / loop.pieces
    return TwistedCircle(*place, 2 * np.pi * share, np.pi * loop.half_twists * share, length)


def moments_of(posed: Posed, ribbon: Ribbon) -> Callable[[Array], Array]:
    """Return the moments (k, 3) of the law at strains (k, 3), components that it has none of zero.

    Where the law has numbers that depend on s, those at the start.
    """
    u, law = ca.SX.sym("u", 3), ribbon.law
    inputs = [u, ribbon.parameters, ribbon.position]
    moments = ca.Function("m", inputs, [law.whole(law.moment(u))])
    values, start = posed.values, posed.scene.interval[0]

    def moments_at(strains: Array) -> Array:
        count = len(strains)
        repeated = np.repeat(values[:, None], count, axis=1)
        found = moments.map(count)(strains.T, repeated, np.full((1, count), start))
        return np.asarray(np.array(found).T)

    return moments_at


def words(guess: object) -> str:
    """Return a scene's guess in words, for the report."""
    if isinstance(guess, SolutionGuess):
        return f"saved solution {guess.solution}"
    if guess == "circle":
        return "circle"
    kinds = {
        LoadGuess: "force and moment integrated from the start",
        StrainGuess: "constant strains",
        ArcGuess: "circular arc",
        HelixGuess: "helix",
        MoebiusGuess: "twisted circle",
    }
    return kinds[type(guess)]
