"""The guesses that a scene can name: shapes, loads, strains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError
from ribbonopt.mechanics import RodFields
from ribbonopt.mechanics.ends.boundary import start_frame, start_position
from ribbonopt.mechanics.ends.frames import number
from ribbonopt.problem import Ribbon, theta_values
from ribbonopt.scene import (
    ArcGuess,
    HelixGuess,
    LoadGuess,
    Loop,
    MoebiusGuess,
    Scene,
    SolutionGuess,
    StrainGuess,
)

from .loads import IntegratedLoads
from .shapes import Helical, Shape, TwistedCircle
from .unknowns import Guess

ROD = np.array([1.0, 2.0])  # moment over strain of a ribbon that is hardly twisted


@dataclass(frozen=True, eq=False)
class ShapeGuess:
    """A shape without force: nothing to be known of loads.

    The moment is that of `law` for its strains (k, 2), or of a rod of stiffness 1 and 2; it need
    not be in equilibrium.
    """

    shape: Shape
    law: Callable[[Array], Array] | None = None

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        r, frames = self.shape.positions(fraction), self.shape.frames(fraction)
        strains = self.shape.strains(fraction)[:, 1:]
        moments = strains * ROD if self.law is None else self.law(strains)
        m = np.einsum("kij,kj->ki", frames[:, :, 1:], moments)
        return RodFields(r, frames, np.zeros_like(r), m)


def guess_of(scene: Scene, ribbon: Ribbon) -> Guess | None:
    """Return the guess that a scene names; None for `auto` and for saved solutions."""
    guess = scene.guess
    if isinstance(guess, LoadGuess):
        return IntegratedLoads(ribbon, scene, guess)
    shape = shape_of(scene)
    return None if shape is None else ShapeGuess(shape, _moments(scene, ribbon))


def shape_of(scene: Scene) -> Shape | None:
    """Return the shape that a scene's guess names, or None if it names none."""
    guess, parameters = scene.guess, scene.parameters
    length = scene.interval[1] - scene.interval[0]
    place = start_position(scene.boundary, parameters), start_frame(scene.boundary, parameters)
    piece = "whole" if scene.boundary.loop is None else scene.boundary.loop.piece
    if guess == "circle":
        return loop_shape(scene, Loop(0, piece), place)
    if isinstance(guess, MoebiusGuess):
        band = guess.moebius
        return loop_shape(scene, Loop(band.half_twists, band.piece or piece), place)
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


def loop_shape(scene: Scene, loop: Loop, place: tuple[Array, Array]) -> TwistedCircle:
    """Return a twisted circle, or the piece of it that is solved, from a position and a frame.

    The fundamental piece lies about the origin of the lab, as `mechanics.ends.loops` has it.
    """
    if loop.piece == "fundamental" and not loop.half_twists:
        raise ModelError("guess: a circle without half twists has no fundamental piece", "guess")
    length = scene.interval[1] - scene.interval[0]
    if loop.piece == "fundamental":
        radius = loop.pieces * length / (2 * np.pi)
        place = np.array([-radius, 0.0, 0.0]), np.eye(3)
    share = 1 / loop.pieces
    return TwistedCircle(*place, 2 * np.pi * share, np.pi * loop.half_twists * share, length)


def _moments(scene: Scene, ribbon: Ribbon) -> Callable[[Array], Array]:
    u = ca.SX.sym("u", 2)
    theta = ca.vertcat(*ribbon.theta.values())
    moments = ca.Function("m", [u, theta], [ca.vertcat(*ribbon.law.moment(u[0], u[1]))])
    values = theta_values(scene)

    def law(strains: Array) -> Array:
        count = len(strains)
        repeated = np.repeat(values[:, None], count, axis=1)
        return np.asarray(np.array(moments.map(count)(strains.T, repeated)).T)

    return law


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
