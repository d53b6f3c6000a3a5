"""Roots of test functions between two points of a locus.

Where nothing is singular they are read as near to the root as one likes; where loci meet no point
of the locus is found next to the place, and the root is that of a polynomial through values afar.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ribbonopt.solution.solution import Solution

from ..walk.beside import Beside, Probe

ROUNDS, KNOTS = 20, 4  # of secants; points that they go through
SETTLED = 1e-9  # change of a root, in arclength
AFAR = 0.02  # arclength between places that a root is found from, where loci meet
OFFSETS = (-3, -2, -1, 1, 2, 3)  # of these, in spacings
NEAR = 0.05  # of a step: points nearer to each other than that interpolate nothing

Test = Callable[[Probe[Solution]], float]


class Apart(Beside[Solution]):
    """The same beside two points, however near to each other it has been read.

    `doubt` says how far the root that was found last is off, as fewer values tell.
    """

    doubt = 0.0

    def _nearest(self, arc: float) -> list[Probe[Solution]]:
        found: list[Probe[Solution]] = []
        for probe in sorted(self.known.values(), key=lambda probe: abs(probe.arc - arc)):
            if all(abs(probe.arc - other.arc) > NEAR * abs(self.whole) for other in found):
                found.append(probe)
        return found[:KNOTS]


def regular(beside: Beside[Solution], test: Test) -> float | None:
    """Return the root of a test function that can be read next to it, by secants of its inverse."""
    values = {probe.arc: test(probe) for probe in beside.ends}
    low, high = sorted(values)
    if values[low] * values[high] > 0:
        return None
    arc = low + (high - low) * values[low] / (values[low] - values[high])
    for _ in range(ROUNDS):
        probe = beside.at(arc, 0.0)
        if probe is None:
            return None
        values[arc] = test(probe)
        low, high = (arc, high) if values[arc] * values[low] > 0 else (low, arc)
        nearest = sorted(values, key=lambda place: abs(values[place]))[:KNOTS]
        found = _inverse({place: values[place] for place in nearest})
        if not low < found < high:
            found = (low + high) / 2
        if abs(found - arc) <= SETTLED:
            return found
        arc = found
    return None


def from_afar(beside: Apart, test: Test, ends: tuple[float, float]) -> float | None:
    """Return the root of the polynomial through a test function's values at some distance.

    `ends` are values, at both ends, of a function that vanishes where the test function does: that
    itself may not be comparable there.
    """
    first, last = ends
    root = beside.whole * first / (first - last)
    spacing = max(abs(beside.whole) / 8, AFAR)
    probes = [beside.at(root + offset * spacing, 0.0) for offset in OFFSETS]
    values = {
        probe.arc: test(probe) for probe in probes if probe is not None and probe not in beside.ends
    }
    if len(values) < KNOTS:
        return None
    nearest = sorted(values, key=lambda place: abs(place - root))
    found, less = (
        _fitted({place: values[place] for place in some}, root) for some in (nearest, nearest[:-1])
    )
    if found is not None:
        beside.doubt = abs(found - (root if less is None else less))
    return found


def _fitted(values: Mapping[float, float], near: float) -> float | None:
    """Return the root nearest to a place of the polynomial through some values, None for none."""
    fitted = np.polynomial.Polynomial.fit(list(values), list(values.values()), len(values) - 1)
    roots = [float(z.real) for z in fitted.roots() if abs(z.imag) <= 1e-9]
    return min(roots, key=lambda place: abs(place - near), default=None)


def _inverse(values: Mapping[float, float]) -> float:
    """Return where a function vanishes, by the polynomial of its inverse through some values."""
    found = 0.0
    for place, value in values.items():
        others = (other for other in values.values() if other != value)
        weight = float(np.prod([other / (other - value) for other in others]))
        found += weight * place
    return found
