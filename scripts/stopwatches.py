"""Clocks on the parts of a computation, for benchmarks."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any


@contextmanager
def stopwatches(watched: Sequence[tuple[Any, str, str]]) -> Iterator[list[tuple[str, float]]]:
    """Note the CPU seconds of every call of functions (place, name, label), as they end."""
    steps: list[tuple[str, float]] = []
    before = [getattr(place, name) for place, name, _ in watched]
    for (place, name, label), call in zip(watched, before, strict=True):

        def timed(*args: Any, label: str = label, call: Any = call, **options: Any) -> Any:
            start = time.process_time()
            answer = call(*args, **options)
            steps.append((label, time.process_time() - start))
            return answer

        setattr(place, name, timed)
    try:
        yield steps
    finally:
        for (place, name, _), call in zip(watched, before, strict=True):
            setattr(place, name, call)
