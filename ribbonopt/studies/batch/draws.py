"""Random inputs: independent draws from named distributions, the same for the same seed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.plain import is_number
from ribbonopt.scene.faults import InvalidSceneError, Problem, shown
from ribbonopt.scene.limits import LARGEST, SEED, VALUES

Two = tuple[float, float]

#: of two numbers each, bounds, or mean and standard deviation: some draws
DISTRIBUTIONS: dict[str, Callable[[np.random.Generator, float, float, int], Array]] = {
    "uniform": lambda rng, a, b, count: rng.uniform(a, b, count),
    "log_uniform": lambda rng, a, b, count: rng.uniform(np.log(a), np.log(b), count),
    "normal": lambda rng, a, b, count: rng.normal(a, b, count),
}
EXAMPLE = "expected {count: 100, seed: 1, over: {parameters.a: {uniform: [0, 1]}}}"


@dataclass(frozen=True)
class Draws:
    """How many ribbons, the seed, and the distribution of each key."""

    count: int
    seed: int
    over: Mapping[str, tuple[str, Two]]

    @classmethod
    def read(cls, value: Any) -> Draws:
        """Read plain data; InvalidSceneError says what is wrong."""
        if not isinstance(value, dict) or set(value) - {"count", "seed", "over"}:
            raise _fault((), EXAMPLE, value)
        over = value.get("over")
        if not isinstance(over, dict) or not over:
            raise _fault(("over",) if "over" in value else (), EXAMPLE, over)
        count = _whole("count", value.get("count"), VALUES)
        seed = _whole("seed", value.get("seed", 0), SEED)
        return cls(count, seed, {str(key): _distribution(key, item) for key, item in over.items()})

    def row(self, index: int) -> dict[str, float]:
        """Return the inputs of a ribbon."""
        return {key: self._value(key, index) for key in self.over}

    @cached_property
    def _drawn(self) -> dict[str, Array]:
        """Draws for all ribbons; each key has a stream of its own."""
        streams = {key: np.random.default_rng([self.seed, i]) for i, key in enumerate(self.over)}
        return {
            key: DISTRIBUTIONS[kind](streams[key], *two, self.count)
            for key, (kind, two) in self.over.items()
        }

    def _value(self, key: str, index: int) -> float:
        (kind, two), drawn = self.over[key], self._drawn[key][index]
        return float(np.clip(np.exp(drawn), *two) if kind == "log_uniform" else drawn)


def _distribution(key: Any, item: Any) -> tuple[str, Two]:
    kinds = " or ".join(f"{{{name}: [a, b]}}" for name in DISTRIBUTIONS)
    path = "over", str(key)
    if not isinstance(item, dict) or len(item) != 1:
        raise _fault(path, f"expected {kinds}", item)
    ((kind, two),) = item.items()
    numbers = isinstance(two, list) and len(two) == 2 and all(map(is_number, two))
    if kind not in DISTRIBUTIONS or not numbers:
        raise _fault(path, f"expected {kinds}", item)
    if kind == "log_uniform" and min(two) <= 0:
        raise _fault(path, "log_uniform needs bounds > 0", item)
    if kind == "normal" and two[1] < 0:
        raise _fault(path, "expected {normal: [mean, standard deviation >= 0]}", item)
    if max(map(abs, two)) > LARGEST:
        raise _fault(path, f"expected numbers of at most {LARGEST:g} in size", item)
    if kind != "normal" and two[0] > two[1]:
        raise _fault(path, f"expected {{{kind}: [lower, upper]}}", item)
    return str(kind), (float(two[0]), float(two[1]))


def _whole(name: str, value: Any, most: int) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise _fault((name,), "expected a whole number >= 0", value)
    if value > most:
        raise _fault((name,), f"expected at most {most:,}", value)
    return value


def _fault(path: tuple[str, ...], message: str, found: Any) -> InvalidSceneError:
    return InvalidSceneError([Problem(("random", *path), message, shown(found))])
