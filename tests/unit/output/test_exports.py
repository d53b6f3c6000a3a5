"""Exports: a new one is a class of its own, and the files that it declares may be replaced."""

import importlib.util
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.errors import OutputError
from ribbonopt.output.declared import MANIFEST, MODES_FILES, PAGE, declare, foreign_in
from ribbonopt.output.exports import STANDARD, Export
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.output.staging import OWN_FILES, staged_result
from ribbonopt.solution.solution import Solution
from ribbonopt.views import Pictures

Solved = Callable[..., Solution]

MODULE = '''
"""The centre line as text."""

import numpy as np


class CentreLine:
    name, files = "centre line", ("centre.txt",)

    def write(self, solution, folder):
        s = np.linspace(*solution.scene.interval, 11)
        np.savetxt(folder / "centre.txt", solution.sample(s, "r"))
'''


@pytest.fixture
def toy(tmp_path: Path) -> Any:
    path = tmp_path / "my_exports.py"
    path.write_text(MODULE, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("my_exports", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.CentreLine()


def test_a_new_export_is_written_and_does_not_block_the_next_result(
    solved: Solved, toy: Export, tmp_path: Path
) -> None:
    folder = tmp_path / "result"
    folder.mkdir()
    save_solution(solved("helix"), folder, exports=[toy])
    assert len((folder / "centre.txt").read_text().splitlines()) == 11
    assert json.loads((folder / MANIFEST).read_text()) == {"files": ["centre.txt"]}
    with staged_result(folder) as stage:  # by who knows nothing of it
        save_solution(solved("helix"), stage.folder)
        stage.commit()
    assert {path.name for path in folder.iterdir()} == {
        name for export in STANDARD for name in export.files
    }


def test_what_nobody_declared_is_still_left_alone(
    solved: Solved, toy: Export, tmp_path: Path
) -> None:
    save_solution(solved("helix"), tmp_path, exports=[toy])
    (tmp_path / "my_exports.py").unlink()
    (tmp_path / "thesis.tex").write_text("mine")
    with pytest.raises(OutputError, match=r"thesis\.tex"), staged_result(tmp_path):
        pass
    assert load_solution(tmp_path).verified


def test_standard_exports_and_pictures_are_known_everywhere() -> None:
    exports: tuple[Export, ...] = (*STANDARD, Pictures())
    files = {name for export in exports for name in export.files}
    assert files | {"equilibria", PAGE, *MODES_FILES} == OWN_FILES


def test_two_exports_cannot_write_one_file(solved: Solved, toy: Any, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match=r"'centre line' writes centre\.txt, as 'centre line'"):
        save_solution(solved("helix"), tmp_path / "none", exports=[toy, toy])
    assert not (tmp_path / "none").exists()


def test_declarations_add_up(tmp_path: Path) -> None:
    for name in ("a.txt", "b.txt", "c.txt"):
        (tmp_path / name).write_text("")
    declare(tmp_path, ["a.txt"])
    declare(tmp_path, ["b.txt"])
    declare(tmp_path, [])
    assert foreign_in(tmp_path, ()) == ["c.txt"]
    assert foreign_in(tmp_path, ("c.txt",)) == []


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"files": 3}', '{"files": [3]}', "\0"])
def test_a_manifest_that_says_nothing_declares_nothing(tmp_path: Path, text: str) -> None:
    (tmp_path / MANIFEST).write_text(text, encoding="utf-8")
    assert foreign_in(tmp_path, ()) == [MANIFEST]
