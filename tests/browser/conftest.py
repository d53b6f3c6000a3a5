"""Fixtures of pages in real browsers: one session of each browser for all tests."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from browsers import NEEDED, require, started
from pages import Pages
from tab import Tab


@pytest.fixture(scope="session", params=NEEDED)
def tab(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tab]:
    """A tab of each browser."""
    require(request.param)
    with started(request.param, tmp_path_factory.mktemp(request.param)) as bidi:
        yield Tab(request.param, bidi)


@pytest.fixture(scope="session")
def pages(tmp_path_factory: pytest.TempPathFactory, configs: Path) -> Pages:
    """Pages, each made once."""
    return Pages(tmp_path_factory.mktemp("pages"), configs)
