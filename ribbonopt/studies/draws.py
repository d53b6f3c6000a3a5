"""Random inputs: independent draws from named distributions, the same for the same seed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

Two = tuple[float, float]

#: two numbers each: bounds, or mean and standard deviation
DISTRIBUTIONS: dict[str, Callable[[np.random.Generator, float, float], float]] = {
    "uniform": lambda rng, a, b: float(rng.uniform(a, b)),
    "log_uniform": lambda rng, a, b: float(np.exp(rng.uniform(np.log(a), np.log(b)))),
    "normal": lambda rng, a, b: float(rng.normal(a, b)),
}


@dataclass(frozen=True)
class Draw:
    """How many ribbons, the seed, and the distribution of each key."""

    count: int
    seed: int
    over: Mapping[str, tuple[str, Two]]

    @classmethod
    def read(cls, value: Any) -> Draw:
        """Read plain data; ValueError says what is wrong."""
        expected = "expected {count: 100, seed: 1, over: {parameters.a: {uniform: [0, 1]}}}"
        if not isinstance(value, dict) or set(value) - {"count", "seed", "over"}:
            raise ValueError(f"found {value!r}, {expected}")
        over = value.get("over")
        count, seed = (_whole(n, value.get(n, d)) for n, d in (("count", None), ("seed", 0)))
        if not isinstance(over, dict) or not over:
            raise ValueError(f"over: found {over!r}, {expected}")
        return cls(count, seed, {str(key): _distribution(key, item) for key, item in over.items()})


def draws_of(draw: Draw) -> list[dict[str, float]]:
    """Return the inputs of all ribbons; each key has a stream of its own."""
    streams = {key: np.random.default_rng([draw.seed, i]) for i, key in enumerate(draw.over)}
    return [
        {key: DISTRIBUTIONS[kind](streams[key], *two) for key, (kind, two) in draw.over.items()}
        for _ in range(draw.count)
    ]


def _distribution(key: Any, item: Any) -> tuple[str, Two]:
    kinds = ", ".join(f"{{{name}: [a, b]}}" for name in DISTRIBUTIONS)
    if not isinstance(item, dict) or len(item) != 1:
        raise ValueError(f"over.{key}: found {item!r}, expected one of {kinds}")
    ((kind, two),) = item.items()
    numbers = isinstance(two, list) and len(two) == 2 and all(_is_number(n) for n in two)
    if kind not in DISTRIBUTIONS or not numbers:
        raise ValueError(f"over.{key}: found {item!r}, expected one of {kinds}")
    if kind == "log_uniform" and min(two) <= 0:
        raise ValueError(f"over.{key}: log_uniform needs bounds > 0, found {two}")
    return str(kind), (float(two[0]), float(two[1]))


def _whole(name: str, value: Any) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise ValueError(f"{name}: found {value!r}, expected a whole number >= 0")
    return value


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
