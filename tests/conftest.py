"""Fixtures of all tests: the shipped scenes, and their solutions, each solved once."""

import gc
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

# Graphs of symbols are many objects and few circles: to look for those less often saves 5 %.
gc.set_threshold(100_000, 20, 20)

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


#: lines of slow.txt that name no test
STALE = pytest.StashKey[list[str]]()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what slow.txt lists, before slow tests are left out."""
    lines = (TESTS / "slow.txt").read_text(encoding="utf-8").splitlines()
    listed = {line for line in lines if line and not line.startswith("#")}
    for item in items:
        if item.nodeid in listed:
            item.add_marker(pytest.mark.slow)
    found = {item.nodeid for item in items}
    whole = {item.nodeid.partition("::")[0] for item in items}
    if any("::" in argument for argument in config.args):
        whole = set()  # some tests of a file only
    config.stash[STALE] = sorted(x for x in listed - found if x.partition("::")[0] in whole)


@pytest.fixture
def stale(pytestconfig: pytest.Config) -> list[str]:
    """Lines of slow.txt that name no test, of the files that are collected in this run."""
    return pytestconfig.stash[STALE]


@pytest.fixture(scope="module", autouse=True)
def _what_is_here_is_kept() -> None:
    """Let searches for garbage leave out what earlier files made and keep.

    That is most of a gigabyte at the end of a run, and `interleaved` has it searched each time.
    """
    gc.collect()
    gc.freeze()


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


@pytest.fixture(params=["as it is", "without the kernel"])
def each_way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run with the compiled kernel, where there is one, and again without."""
    if request.param == "without the kernel":
        monkeypatch.setattr("ribbonopt.kernel.programs.COMPILED", None)
        monkeypatch.setattr("ribbonopt.transcription.collocation.compiled.COMPILED", None)
