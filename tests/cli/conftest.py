"""The command line as tests call it."""

import gc
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from batches import STUDY
from branches import LONG, Whole, finished, points, written
from half_studies import SCENE

from ribbonopt.cli import main


class Outcome(NamedTuple):
    """Exit status and what was printed."""

    status: int
    out: str
    err: str


Run = Callable[..., Outcome]


@pytest.fixture
def run(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Run]:
    """Return the runner of one command in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments: object) -> Outcome:
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        return Outcome(status, *capsys.readouterr())

    yield call
    gc.enable()


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Return a study file, its scene beside it."""
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "study.yaml").write_text(STUDY)
    return tmp_path / "study.yaml"


@pytest.fixture(scope="session")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Whole]:
    """Return the cached maker of uninterrupted branches, each by a process of its own."""

    @cache
    def made(name: str) -> Whole:
        text, expected, meshes = LONG[name]
        folder = tmp_path_factory.mktemp("whole")
        scene = written(folder, text)
        status, out, err = finished(scene, "--out", folder / "branch", "--quiet")
        assert (status, out) == (expected, b"")
        assert (err == b"") == (expected == 0)
        result = Whole(scene, folder / "branch")
        rows = points(result.folder)
        assert len({row["intervals"] for row in rows}) >= meshes
        return result

    return made
