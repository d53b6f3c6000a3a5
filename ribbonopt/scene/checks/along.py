"""What is wrong with numbers along the ribbon: formulas of s, and tables that do not cover it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from ribbonopt.scene.along import Along, Table
from ribbonopt.scene.faults import KeyPath, Problem, dotted, shown
from ribbonopt.scene.formulas.words import ARCLENGTH
from ribbonopt.scene.limits import LARGEST, ROWS

if TYPE_CHECKING:
    from ribbonopt.scene.formulas.expressions import Node

SAMPLES, BETWEEN = 101, 4  # points looked at, of the interval and of each piece of a table
PEAKS, CLOSER, ROUNDS, LAST = 5, 9, 20, 6  # largest ones looked at, points of each of its rounds
STILL = 4  # rounds
STILL_GROWS = 1.2  # in the last rounds, 4^-6 as wide: at a pole, however weak, not at a maximum
ROUNDING = 1e-9  # of the interval, by which a table may miss its ends

Interval = tuple[float, float]


class Sample(NamedTuple):
    """A value and its arclength, in the units of the scene."""

    value: float
    s: float


Samples = dict[KeyPath, list[Sample]]


def check_along(
    found: Mapping[KeyPath, Along], interval: Interval, parameters: Mapping[str, float]
) -> tuple[Samples, list[Problem]]:
    """Return what numbers along the ribbon are worth on it, and what is wrong with the others.

    Parameters
    ----------
    found
        What stands in the scene, by path; see `numbers_along`.
    interval, parameters
        Those of the scene.

    Returns
    -------
    dict
        Samples of all that are sound, by path; one for a plain number.
    list of Problem
        One for each of the others.
    """
    samples: Samples = {}
    problems: list[Problem] = []
    formulas = [path for path, value in found.items() if isinstance(value, str)]
    if formulas and ARCLENGTH in parameters:
        message = f"is the arclength in formulas along the ribbon, as in {dotted(formulas[0])}"
        problems.append(Problem(("parameters", ARCLENGTH), f"{message}; choose another name"))
    for path, value in found.items():
        if isinstance(value, str):
            faults = list(_of_formula(path, value, interval, parameters, samples))
        elif isinstance(value, Table):
            faults = list(_of_table(path, value, interval, samples))
        elif isinstance(value, float | int):
            faults, samples[path] = [], [Sample(float(value), interval[0])]
        else:
            continue  # in the units Dw = L = 1 of a scene that was checked in its own
        problems += faults
    return samples, problems


def largest(samples: Samples) -> dict[KeyPath, float]:
    """Return the values of largest size, by path."""
    return {path: max(values, key=lambda v: abs(v.value)).value for path, values in samples.items()}


def _of_formula(
    path: KeyPath,
    text: str,
    interval: Interval,
    parameters: Mapping[str, float],
    samples: Samples,
) -> Iterator[Problem]:
    # Imported late: plain numbers need no grammar.
    from ribbonopt.scene.formulas.parsing import FormulaError, parse_along

    try:
        node = parse_along(text, parameters)
    except FormulaError as error:
        yield Problem(path, str(error))
        return
    values = [Sample(_value(node, s, parameters), s) for s in _spread(*interval, SAMPLES)]
    odd = next((s for value, s in values if not abs(value) <= LARGEST), None)
    if odd is None and len({value for value, _ in values}) > 1:
        found, odd = _between(values, lambda s: _value(node, s, parameters))
        values += found
    if odd is None:
        samples[path] = values
        return
    start, end = interval
    message = f"has no finite real value at s = {odd:.6g}, expected one from {start:g} to {end:g}"
    yield Problem(path, message, shown(text))


def _between(
    values: Sequence[Sample], value: Callable[[float], float]
) -> tuple[list[Sample], float | None]:
    """Look between samples for the least value, and for what is larger than all that was seen.

    Returns
    -------
    list of Sample
        What was found on the way.
    float or None
        An arclength where there is no finite value, at which sizes grow without end, if any.
    """
    inner = range(len(values))
    sizes = [abs(sample.value) for sample in values]
    peaks = [i for i in inner if sizes[i] >= max(sizes[max(i - 1, 0) : i + 2])]
    peaks = sorted(peaks, key=lambda i: -sizes[i])[:PEAKS]
    ways = [(i, 1) for i in peaks] + [(min(inner, key=lambda i: values[i].value), -1)]
    found: list[Sample] = []
    for i, way in ways:
        best, largest = values[i], list[float]()
        a, b = values[max(i - 1, 0)].s, values[min(i + 1, len(values) - 1)].s
        for _ in range(ROUNDS):
            tried = [Sample(value(s), s) for s in _spread(a, b, CLOSER)]
            odd = next((s for number, s in tried if not abs(number) <= LARGEST), None)
            if odd is not None:
                return found, odd
            best = max(best, *tried, key=lambda t: abs(t.value) if way > 0 else -t.value)
            largest.append(abs(best.value))
            if len(set(largest[-STILL:])) == 1 < STILL <= len(largest):
                break  # nothing more comes
            reach = (b - a) / (CLOSER - 1)
            a, b = max(best.s - reach, values[0].s), min(best.s + reach, values[-1].s)
        if way > 0 and len(largest) == ROUNDS and largest[-1] > STILL_GROWS * largest[-1 - LAST]:
            return found, best.s
        found.append(best)
    return found, None


def _value(node: Node, s: float, parameters: Mapping[str, float]) -> float:
    """Return the value at an arclength, nan where there is none."""
    from ribbonopt.scene.formulas.expressions import evaluate
    from ribbonopt.scene.formulas.numeric import NumericEnv

    try:
        value = evaluate(node, NumericEnv({**parameters, ARCLENGTH: s}))
    except (ArithmeticError, ValueError, TypeError):
        return math.nan
    return value if isinstance(value, float) else math.nan


def _of_table(
    path: KeyPath, table: Table, interval: Interval, samples: Samples
) -> Iterator[Problem]:
    count, (start, end) = len(table.s), interval
    if len(table.values) != count:
        message = f"expected as many values as arclengths, {count}"
        yield Problem((*path, "values"), message, f"{len(table.values)}")
        return
    if not 2 <= count <= ROWS:
        remedy = "; thin it" if count > ROWS else "; for the same all along write one number"
        yield Problem((*path, "s"), f"expected from 2 to {ROWS} rows{remedy}", f"{count:,}")
        return
    for (a, b), row in zip(pairwise(table.s), range(1, count), strict=True):
        if not a < b:
            message = f"expected increasing arclengths, more than {a:g} of the row before"
            yield Problem((*path, "s", row), message, f"{b:g}")
            return
    slack = ROUNDING * (end - start)
    if table.s[0] > start + slack or table.s[-1] < end - slack:
        message = f"covers s from {table.s[0]:g} to {table.s[-1]:g}, expected all of the interval, "
        yield Problem((*path, "s"), f"{message}[{start:g}, {end:g}]; add rows, or shorten that")
        return
    import numpy as np  # scenes without tables need none of it to be read

    from ribbonopt.scene.cubics import Cubics

    inside = [s for a, b in pairwise(table.s) for s in _spread(a, b, BETWEEN)]
    places = [*_spread(start, end, SAMPLES), *(s for s in inside if start <= s <= end)]
    with np.errstate(all="ignore"):
        values = Cubics.through(table).at(np.array(places)).tolist()
    if not all(map(math.isfinite, values)):
        yield Problem(path, "its rows are too close for a curve through them; thin it")
        return
    samples[path] = [Sample(*pair) for pair in zip(values, places, strict=True)]


def _spread(start: float, end: float, count: int) -> list[float]:
    """Return arclengths from one to another, both included."""
    return [start + (end - start) * i / (count - 1) for i in range(count)]
