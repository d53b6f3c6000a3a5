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

TESTS = Path(__file__).parent
CONFIGS = TESTS.parent / "configs"


def pytest_configure(config: pytest.Config) -> None:
    """Make errors of the warnings that the tests cause, as pyproject.toml does for ribbonopt."""
    names = {"my_.*"}  # of tests/user_modules.py
    for path in TESTS.rglob("*.py"):
        names.add(path.parent.name if (path.parent / "__init__.py").exists() else path.stem)
    own = "|".join(sorted(names))
    config.addinivalue_line("filterwarnings", rf"error:::({own})(\.|$)")


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
