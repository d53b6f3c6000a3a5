"""Fixtures of all tests: the shipped scenes, and their solutions, each solved once."""

import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from ribbonopt.solution.solution import Solution

# Before numpy is loaded: workers share the cores, and small matrices gain nothing from threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The same examples in every run; a busy machine may take its time.
settings.register_profile("tests", deadline=None, derandomize=True)
settings.load_profile("tests")

CONFIGS = Path(__file__).parents[1] / "configs"


@pytest.fixture(scope="session")
def configs() -> Path:
    """Folder of the shipped scenes."""
    return CONFIGS


@pytest.fixture(scope="session")
def solved() -> "Callable[..., Solution]":
    """Return the cached solver of shipped scenes: `solved(name, *overrides)`."""
    from ribbonopt.pipeline.prepared import solve
    from ribbonopt.scene import load_scene

    @cache
    def solution(name: str, *overrides: str) -> "Solution":
        result = solve(load_scene(CONFIGS / f"{name}.yaml", overrides))
        assert result.verified, f"{name} {overrides}: {result.message}"
        return result

    return solution
