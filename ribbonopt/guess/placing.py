"""Where the ends of a ribbon may be: positions and frames that meet all kinematic conditions."""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.ends.boundary import ENDS
from ribbonopt.mechanics.ends.conditions import Component, Direction, EndName, Frame
from ribbonopt.mechanics.rotations import matrix_of, turns_about
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.imposed import residuals
from ribbonopt.problem.posed import Place

KINEMATIC = 7  # states of position and unit quaternion, before all others
SLACK = 0.8  # chord of a ribbon whose ends say nothing of it, over its length
STEPS = 30
CLOSE = 1e-10


def place_ends(ribbon: Ribbon, posed: Posed) -> tuple[Place, Place]:
    """Return position and frame (lab) of both ends.

    What is prescribed as a whole is taken as it is; the rest is what is nearest to a straight
    ribbon along d3, by Gauss-Newton steps of least change. Where these do not get there (conditions
    that the ends alone cannot meet), the last of them is returned. The ribbon is that of any scene
    of this structure: functions are made of it once.
    """
    length = posed.length
    first, last = (_frame(posed, name) for name in ENDS)
    start, end = (_position(posed, name) for name in ENDS)
    if np.isnan(start).any() and np.isnan(end).all():
        start = posed.start[0]
    first, last = _completed(first, last, _known_chord(start, end))
    tangent = first[:, 2] + last[:, 2]
    tangent = tangent / max(float(np.linalg.norm(tangent)), 1.0)
    slack = SLACK if np.isfinite(start).any() and np.isfinite(end).any() else 1.0
    start = np.where(np.isfinite(start), start, end - slack * length * tangent)
    start = np.where(np.isfinite(start), start, 0.0)
    end = np.where(np.isfinite(end), end, start + slack * length * tangent)
    fields = RodFields(
        np.stack([start, end]), np.stack([first, last]), np.zeros((2, 3)), np.zeros((2, 3))
    )
    return _met(ribbon, posed, fields)


def _residuals(ribbon: Ribbon) -> ca.Function:
    """Kinematic conditions on the states (14,) of both ends, and how they change with these."""
    least = ribbon.least
    count, rest = KINEMATIC, ca.SX.zeros(len(least.states) - KINEMATIC)
    x = ca.SX.sym("x", 2 * count)
    ends = ca.vertcat(x[:count], rest), ca.vertcat(x[count:], rest)
    constants = ca.SX.zeros(len(least.constants))
    named = residuals(least, *ends, constants, kinematic_only=True)
    end_unit = ca.sumsqr(x[count + 3 :]) - 1
    residual = ca.vertcat(*named.values(), end_unit)
    inputs = [x, ca.vertcat(*ribbon.theta.values())]
    return ca.Function("place", inputs, [residual, ca.densify(ca.jacobian(residual, x))])


def _met(ribbon: Ribbon, posed: Posed, fields: RodFields) -> tuple[Place, Place]:
    """Move both ends by Gauss-Newton steps of least norm until the conditions are met."""
    function, theta = ribbon.kept(_residuals), posed.values
    states, _ = ribbon.least.model.pack(fields, np.zeros(3))
    values = states[:, :KINEMATIC].ravel()
    if np.abs(np.array(function(values, theta)[0])).max() > CLOSE:
        # Off any symmetric place, where a step of least norm has no direction to choose.
        away = 1e-3 * np.sin(1.0 + np.arange(len(values)))
        values = values + away * _free(posed).repeat(KINEMATIC)
    for _ in range(STEPS):
        found, jacobian = (np.array(part) for part in function(values, theta))
        if np.abs(found).max() < CLOSE:
            break
        step = np.linalg.lstsq(jacobian, found.ravel(), rcond=1e-8)[0]
        values = values - min(1.0, 0.5 / max(float(np.linalg.norm(step)), 1e-300)) * step
    start, end = values.reshape(2, KINEMATIC)
    return (start[:3], matrix_of(start[3:7])), (end[:3], matrix_of(end[3:7]))


def _free(posed: Posed) -> Array:
    """For each end, 1 where its frame is not prescribed as a whole, else 0."""
    held = {c.end for c in posed.conditions if isinstance(c, Frame)}
    return np.array([float(end not in held) for end in ("start", "end")])


def _frame(posed: Posed, end: EndName) -> Array | None:
    """Frame prescribed at an end, or the one that a prescribed director needs, or None."""
    at_end = [c for c in posed.conditions if getattr(c, "end", None) == end]
    for condition in at_end:
        if isinstance(condition, Frame):
            return condition.frame
    for condition in at_end:
        if isinstance(condition, Direction):
            index = ("d1", "d2", "d3").index(condition.director)
            return _least_turn(np.eye(3)[index], np.array(condition.target))
    return None


def _completed(first: Array | None, last: Array | None, chord: Array | None) -> tuple[Array, Array]:
    """Both frames; one that nothing is known of is parallel to the other, or along the chord."""
    if first is None and last is None:
        along = np.eye(3)[2] if chord is None else chord
        first = last = _least_turn(np.eye(3)[2], along)
    first = last if first is None else first
    last = first if last is None else last
    assert first is not None and last is not None
    return first, last


def _known_chord(start: Array, end: Array) -> Array | None:
    chord = end - start
    size = float(np.linalg.norm(chord))
    return chord / size if np.isfinite(size) and size > 1e-9 else None


def _position(posed: Posed, end: EndName) -> Array:
    """Prescribed lab components (3,) of an end, not a number where free."""
    position = np.full(3, np.nan)
    for c in posed.conditions:
        if isinstance(c, Component) and (c.end, c.quantity) == (end, "position"):
            position["xyz".index(c.axis)] = c.value
    return position


def _least_turn(source: Array, target: Array) -> Array:
    """Matrix of the shortest rotation from one unit vector to another."""
    target = target / np.linalg.norm(target)
    axis, cosine = np.cross(source, target), float(source @ target)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-12 and cosine < 0:
        across = np.cross(source, np.eye(3)[int(np.argmin(np.abs(source)))])
        axis, sine = across / np.linalg.norm(across), 1.0
        return np.asarray(turns_about(np.pi * axis[None])[0])
    if sine < 1e-12:
        return np.eye(3)
    return np.asarray(turns_about(np.arctan2(sine, cosine) * axis[None] / sine)[0])
