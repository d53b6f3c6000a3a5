"""Strips between clamps that half a turn maps to each other: half of one stands for all of it.

Half a turn R about an axis e through the middle p of the chord reverses the ribbon, and so takes
r(s) to r(L - s) and the directors to those there, d3 and one of d1, d2 with the other sign:
F1 = R F0 S, S = diag(1, -1, -1) with d1 along the axis in the middle, diag(-1, 1, -1) with d2. So
R = F1 S F0^T must be half a turn, and the chord be across its axis. The half ends on the axis, as
at a support `flip`. Not all equilibria between such clamps have the symmetry.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.asymmetry import FLIPS, changed_by_sliding, flipped, numbers_alone
from ribbonopt.mechanics.rotations import turn_vector, turns_about
from ribbonopt.scene import (
    ArcGuess,
    Boundary,
    End,
    Guess,
    HelixGuess,
    LoadGuess,
    Loads,
    Scene,
    StrainGuess,
    Value,
)
from ribbonopt.scene.lens import with_value
from ribbonopt.scene.stages import begin_of, ends_of, stages_of
from ribbonopt.scene.units import in_special_units

from .conditions import Component, Condition, Frame
from .frames import DIRECTORS, by_axis, components, frame_of
from .winding import winding

CLOSE = 1e-9
ON_THE_WAY = (0.0, 0.21, 0.43, 0.78, 1.0)  # of a continuation
KEY = "symmetric"
ARBITRARY = (LoadGuess, StrainGuess, ArcGuess, HelixGuess)  # guesses that are known for a half


@dataclass(frozen=True, eq=False)
class Axis:
    """An axis of two-fold symmetry: its direction (3,), and the director along it in the middle."""

    director: str
    along: Array


def axes_of(scene: Scene, conditions: tuple[Condition, ...]) -> list[Axis]:
    """Return the axes that half a turn maps a clamped scene about; none if anything breaks it."""
    if next(_broken(scene, conditions), ""):
        return []
    found = (_axis(scene, director) for director in FLIPS)
    return [axis for axis in found if isinstance(axis, Axis)]


def halved(scene: Scene, conditions: tuple[Condition, ...]) -> Scene:
    """Return the half of a scene that is declared `symmetric`, in its own units.

    Raises
    ------
    ModelError
        If it has no such symmetry, with what breaks it, or more than one axis.
    """
    special, asked = in_special_units(scene), scene.symmetric
    if why := next(_broken(special, conditions), ""):
        raise _refused(why)
    sign = -1.0 if isinstance(asked, str) and asked.startswith("-") else 1.0
    names = [asked.removeprefix("-")] if isinstance(asked, str) else list(FLIPS)
    found = [_axis(special, name) for name in names]
    axes = [axis for axis in found if isinstance(axis, Axis)]
    if not axes:
        raise _refused("; ".join(str(why) for why in found))
    if len(axes) > 1:
        raise _refused(
            "there are two axes, write symmetric: d1 for the normal along the axis in the middle, "
            "as an arch has it, or symmetric: d2 for the width along it, as a strip bent to an S",
        )
    start, end = scene.interval
    boundary, axis = scene.boundary, axes[0]
    x, y, z = (float(v) + 0.0 for v in sign * axis.along)
    _refuse_turning(scene, axis)
    flip = End("flip", position=_middle(boundary), axis=axis.director, along=(x, y, z))  # type: ignore[arg-type]
    return replace(
        scene,
        symmetric=False,
        interval=(start, (start + end) / 2),
        boundary=replace(boundary, end=flip),
        guess=_half_guess(scene),
    )


def _refuse_turning(scene: Scene, axis: Axis) -> None:
    """Refuse a continuation along which the axis turns, or is lost: the half would not follow."""
    for stage in stages_of(scene) if scene.continuation is not None else ():
        if not stage.moved.startswith(("law.", "parameters.")):
            raise _refused(f"{stage.moved} moves along its continuation, not a parameter of it")
        first = begin_of(stage, scene)
        for goal in ends_of(stage):
            for share in ON_THE_WAY:
                value = first + share * (goal - first)
                there = in_special_units(with_value(scene, stage.moved, value))
                other = _axis(there, axis.director)
                if isinstance(other, str) or np.abs(other.along - axis.along).max() > CLOSE:
                    lost = other if isinstance(other, str) else "the axis turns"
                    raise _refused(f"along its continuation, at {value:.6g}: {lost}")


def _refused(why: str) -> ModelError:
    return ModelError(f"symmetric: {why}; leave it out to solve all of the strip", KEY)


def _broken(scene: Scene, conditions: tuple[Condition, ...]) -> Iterator[str]:
    """Yield what breaks the symmetry of a scene in units Dw = L = 1, whatever the axis."""
    boundary = scene.boundary
    if boundary.loop is not None:
        yield "a loop has pieces of its own, write boundary.loop.piece: auto"
    for name in ("start", "end"):
        place = [c for c in conditions if isinstance(c, Component | Frame) and c.end == name]
        held = {c.axis for c in place if isinstance(c, Component) and c.quantity == "position"}
        if held != set("xyz") or len(place) != 4:
            yield f"boundary.{name} is no clamp, which holds position and directors"
    if boundary.also:
        yield "boundary.also may break it"
    if scene.loads != Loads() or scene.gravity is not None or scene.supports:
        yield "what acts or holds between the ends may break it"
    if isinstance(scene.switching, tuple):
        yield "switching names places in all of the strip"
    if winding(boundary, scene.parameters) is not None:
        yield "the ends say how often the strip is turned, which its half cannot"
    if scene.guess != "auto" and not isinstance(scene.guess, ARBITRARY):
        yield "the guess is one of all of the strip"
    if changed_by_sliding(scene, odd=False):
        yield "law or width vary along the strip"


def _axis(scene: Scene, director: str) -> Axis | str:
    """Return the axis with a director along it in the middle, or what breaks the symmetry."""
    boundary, parameters = scene.boundary, scene.parameters
    first, last = (frame_of(end, parameters) for end in (boundary.start, boundary.end))
    assert first is not None and last is not None
    turn = last @ np.diag(-FLIPS[director]) @ first.T
    if np.abs(turn - turn.T).max() > CLOSE or abs(np.trace(turn) + 1) > CLOSE:
        return f"no half a turn with {director} along its axis maps the directors of the ends"
    axis = np.linalg.eigh((turn + turn.T) / 2)[1][:, -1]
    chord = _positions(boundary, parameters)
    if abs((chord[1] - chord[0]) @ axis) > CLOSE:
        return f"half a turn with {director} along its axis does not map the ends to each other"
    if flipped(scene, numbers_alone(scene), director):
        return f"a flip about {director} changes the natural strains"
    # The sense of the director in the middle is that of the least turn from end to end.
    middle = first @ turns_about(turn_vector(first.T @ last)[None] / 2)[0]
    along = float(middle[:, DIRECTORS.index(director)] @ axis)
    if abs(along) < CLOSE:  # a turn by pi, of either sense
        along = float(axis[np.abs(axis).argmax()])
    return Axis(director, axis * np.sign(along))


def _positions(boundary: Boundary, parameters: dict[str, float]) -> Array:
    found = (components(end.position, parameters) for end in (boundary.start, boundary.end))
    return np.array([[place[axis] for axis in "xyz"] for place in found])


def _middle(boundary: Boundary) -> tuple[Value, Value, Value]:
    """Return the middle of the chord, as formulas where the ends' positions are."""
    first, last = (dict(by_axis(end.position)) for end in (boundary.start, boundary.end))
    x, y, z = (_mean(first[axis], last[axis]) for axis in "xyz")
    return x, y, z


def _mean(a: Value, b: Value) -> Value:
    if isinstance(a, str) or isinstance(b, str):
        return f"(({a}) + ({b}))/2"
    return (a + b) / 2


def _half_guess(scene: Scene) -> Guess:
    """Return the guess for the half: shapes bend half as far in all."""
    guess = scene.guess
    if isinstance(guess, ArcGuess):
        return replace(guess, arc=_mean(guess.arc, 0.0))
    if isinstance(guess, HelixGuess):
        return replace(guess, helix=replace(guess.helix, turns=_mean(guess.helix.turns, 0.0)))
    return guess
