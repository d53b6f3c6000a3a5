"""CONTRIBUTING.md and docs/extending.md say what is so: code is tested, files and rooms exist."""

import re
from pathlib import Path

import pytest
from user_modules import FOLDER

ROOT = Path(__file__).parents[2]
HOUSE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
EXTENDING = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
GUIDE = HOUSE + EXTENDING
BLOCKS = list(dict.fromkeys(re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)))
PATHS = sorted(set(re.findall(r"`((?:ribbonopt|tests|scripts|configs)/[^`\s]*)`", GUIDE)))


def test_it_is_short() -> None:
    assert len(HOUSE.splitlines()) <= 150
    assert "docs/extending.md" in HOUSE or "## Extending it" in HOUSE


def test_every_extension_has_an_example() -> None:
    found = re.split(r"^## ", EXTENDING, flags=re.MULTILINE)[1:]
    kinds = ["law", "support", "load", "formulation", "scheme", "export"]
    assert [next(k for k in kinds if k in part.splitlines()[0]) for part in found] == kinds
    assert all("```python" in part for part in found)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda text: text.splitlines()[0])
def test_its_code_is_code_that_is_tested(block: str) -> None:
    files = (*FOLDER.glob("*.py"), ROOT / "ribbonopt" / "problem" / "inverted.py")
    assert any(block in path.read_text(encoding="utf-8") for path in files)


@pytest.mark.parametrize("path", PATHS)
def test_its_files_exist(path: str) -> None:
    assert (ROOT / path).exists() or (ROOT / path.replace("NAME", "__init__")).exists()


def test_its_rooms_are_all_rooms_in_their_order() -> None:
    rows = re.findall(r"^\| (`[a-z]+`(?:, `[a-z]+`)*) \|", HOUSE, re.MULTILINE)
    listed = [set(re.findall(r"[a-z]+", row)) for row in rows if "ribbonopt" not in row]
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    contract = re.search(r'type = "layers"\nlayers = \[(.*?)\n\]', text, re.DOTALL)
    assert contract
    levels = re.findall(r'"([^"]*)"', contract.group(1))
    layers = [set(re.findall(r"ribbonopt\.([a-z]+)", level)) for level in levels]
    assert listed == layers[::-1][1:]  # but for errors, version, arrays, plain
