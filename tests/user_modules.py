"""Modules that a user writes beside ribbonopt: `tests/extending/user`, one thing in each.

Tests copy them into a folder of their own and import them from there; CONTRIBUTING.md shows them.
"""

import importlib
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

Import = Callable[[str], ModuleType]

FOLDER = Path(__file__).parent / "extending" / "user"


def importer(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Import:
    """Return what copies one of these modules into a folder and imports it from there."""
    monkeypatch.syspath_prepend(folder)

    def module(name: str) -> ModuleType:
        own = f"my_{name}"
        shutil.copy(FOLDER / f"{name}.py", folder / f"{own}.py")
        importlib.invalidate_caches()
        monkeypatch.delitem(sys.modules, own, raising=False)
        return importlib.import_module(own)

    return module
