"""Numbers that are read off one solution, by the names that a row gives them.

    n0.x m0.z        loads at the start, lab frame         u0.2     strains there, along directors
    energy H potential twist                               negative half_twists switches
    r(0.5).x d1(end).z u(0).2 m2(0.25) H(end)              any named output at an arclength
    record.NAME      what the scene records                switch.1 reaction.2.x
    frequency.1      natural frequencies of small vibrations, those of zero left out

A new one is one entry of NUMBERS: its pattern, and what makes it from what the pattern found.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from re import Match
from typing import TypeVar

from ribbonopt.accuracy.carried import reaction_errors
from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.arrays import Array
from ribbonopt.scene import Scene
from ribbonopt.scene.faults import suggestion
from ribbonopt.scene.quantities import OUTPUTS
from ribbonopt.solution.acting import reactions
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution

from .along import AXES, along, norm, record
from .bars import carried
from .measured import NoAnswerError
from .number import Number, Read, UnknownNumberError

T = TypeVar("T")
Make = Callable[[Match[str], Scene], Number]


def number(text: str, scene: Scene) -> Number:
    """Return what a name stands for; UnknownNumberError where it is none of this scene."""
    for pattern, make in NUMBERS:
        if found := re.fullmatch(pattern, text):
            return make(found, scene)
    word = re.split(r"[.(]", text)[0]
    raise UnknownNumberError(
        f"found {text!r}, expected a number of a solution{suggestion(word, WORDS)}: "
        f"{', '.join(EXAMPLES)}"
    )


def _start(found: Match[str], scene: Scene) -> Number:
    """Components of the loads and the strains at the start."""
    name, axis = found["name"], _axis(found["axis"])

    def vector(solution: Solution) -> Array:
        return {"n0": solution.n0, "m0": solution.m0, "u0": solution.u0}[name]

    return Number(lambda s: float(vector(s)[axis]), _summed(name), lambda s: norm(vector(s)))


def _whole(found: Match[str], scene: Scene) -> Number:
    """Energies and H."""
    name = found["name"]
    if name == "energy":
        return Number(lambda s: s.energy, _summed("energy"))
    if name == "H":
        return Number(lambda s: float(s.start["H"]), _summed("H0"))
    return Number(_potential, _summed("potential"))


def _potential(solution: Solution) -> float:
    value = potential(solution)
    if value is None:
        raise NoAnswerError("some load of the scene has no potential")
    return value


def _twist(found: Match[str], scene: Scene) -> Number:
    return Number(lambda s: s.twist, lambda s: carried(s, lambda each: each.twist, 1.0))


def _reaction(found: Match[str], scene: Scene) -> Number:
    """Component of the force of a support, in order of arclength."""
    k, axis = int(found["number"]), _axis(found["axis"])

    def force(solution: Solution) -> Array:
        return _one(reactions(solution), k, "supports").force

    return Number(
        lambda s: float(force(s)[axis]),
        lambda s: reaction_errors(s)[k - 1],
        lambda s: norm(force(s)),
    )


def _switch(found: Match[str], scene: Scene) -> Number:
    """Arclength where the law switches from one phase to the next."""
    k, (start, end) = int(found["number"]), scene.interval

    def place(solution: Solution) -> float:
        return float(_one(tuple(solution.switch_points), k, "switch points"))

    length = end - start
    return Number(place, lambda s: carried(s, place, length), lambda s: length)


def _count(found: Match[str], scene: Scene) -> Number:
    return Number(COUNTS[found["name"]], None)


def _negative(solution: Solution) -> float:
    from ribbonopt.checks.stability import negative_directions  # builds second derivatives

    count = negative_directions(solution)
    if count is None:
        raise NoAnswerError("negative directions cannot be counted here")
    return float(count)


def _half_twists(solution: Solution) -> float:
    from ribbonopt.checks.topology import count_half_twists  # of closed bands only

    count = count_half_twists(solution)
    if count is None:
        raise NoAnswerError("this is no closed band")
    return float(count)


def _frequency(found: Match[str], scene: Scene) -> Number:
    """Return the k-th natural frequency, below zero where it is a rate of growth."""
    k = int(found["number"])

    def read(solution: Solution) -> tuple[float, float]:
        from ribbonopt.checks.modes import modes_of  # builds second derivatives

        modes = modes_of(solution, k)
        if isinstance(modes, str):
            raise NoAnswerError(modes)
        value = float(_one(tuple(modes.frequencies), k, "natural frequencies"))
        return value, float(modes.errors[k - 1]) * abs(value)

    return Number(lambda solution: read(solution)[0], lambda solution: read(solution)[1])


def _summed(name: str) -> Read:
    return lambda solution: estimate_error(solution)[name]


def _one(found: Sequence[T], k: int, what: str) -> T:
    if not 1 <= k <= len(found):
        raise NoAnswerError(f"there are {len(found)} {what}, expected {k} or more")
    return found[k - 1]


def _axis(letter: str) -> int:
    return AXES.index(letter) if letter in AXES else int(letter) - 1


COUNTS: dict[str, Read] = {
    "negative": _negative,
    "half_twists": _half_twists,
    "switches": lambda solution: float(len(solution.switch_points)),
}
NUMBERS: tuple[tuple[str, Make], ...] = (
    (r"(?P<name>[nm]0)\.(?P<axis>[xyz])", _start),
    (r"(?P<name>u0)\.(?P<axis>[123])", _start),
    (r"(?P<name>energy|H|potential)", _whole),
    (r"twist", _twist),
    (r"(?P<name>negative|half_twists|switches)", _count),
    (r"record\.(?P<name>\w+)", record),
    (r"reaction\.(?P<number>[0-9]{1,3})\.(?P<axis>[xyz])", _reaction),
    (r"switch\.(?P<number>[0-9]{1,3})", _switch),
    (r"frequency\.(?P<number>[1-9][0-9]{0,2})", _frequency),
    (r"(?P<name>\w+)\((?P<place>.+)\)(?:\.(?P<axis>[xyz123]))?", along),
)
WORDS = (*("n0", "m0", "u0", "energy", "H", "potential", "twist"), *COUNTS, *OUTPUTS)
WORDS += ("record", "reaction", "switch", "frequency")
EXAMPLES = (
    "n0.x",
    "u0.2",
    "energy",
    "H",
    "twist",
    "negative",
    "r(0.5).x",
    "m2(end)",
    "record.NAME",
)
