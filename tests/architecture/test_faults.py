"""The list of faults that tests must notice is one of faults that can be put in."""

import ast
import importlib.util
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
SCRIPT = ROOT / "scripts" / "faults.py"


@cache
def script() -> Any:
    spec = importlib.util.spec_from_file_location("faults", SCRIPT)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "faults", module)  # where dataclasses look
        spec.loader.exec_module(module)
    return module


def test_each_fault_can_be_put_in_one_place() -> None:
    found = script().faults()
    assert len(found) >= 60
    for fault in found:
        text = (ROOT / fault.path).read_text(encoding="utf-8")
        ast.parse(script().put_in(fault, text))
        assert fault.before.split() != fault.after.split(), (fault.number, fault.file)
    assert len({(fault.file, fault.before, fault.after) for fault in found}) == len(found)


def test_each_fault_has_a_home_and_a_reason() -> None:
    for fault in script().faults():
        assert fault.why and fault.home
        for home in fault.home:
            place, *names = home.split("::")
            assert (ROOT / place).exists(), home
            assert all(f"def {name}" in (ROOT / place).read_text("utf-8") for name in names), home


def test_a_text_that_is_not_there_once_is_refused() -> None:
    fault = script().faults()[0]
    for text in ("", 2 * fault.before):
        with pytest.raises(ValueError, match="occurs"):
            script().put_in(fault, text)
