"""What all tests of extensions share: the user's modules, and the clamp they are tried in."""

from pathlib import Path

import pytest
from user_modules import Import, importer


@pytest.fixture
def user(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Import:
    """Return the import of a user's module by name."""
    folder: Path = tmp_path_factory.mktemp("user")
    return importer(folder, monkeypatch)
