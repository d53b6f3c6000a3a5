"""Whether the kernel is used is said, and it can be turned off; without it all goes on."""

import os

import pytest
from fresh import python

from ribbonopt.kernel import COMPILED, STATE
from ribbonopt.output.summary import versions

TOLD = "from ribbonopt.kernel import COMPILED, STATE; print(COMPILED is None, STATE)"
#: a module in the place of the compiled one
STANDS_IN = "import sys, types; sys.modules['ribbonopt.kernel._compiled'] = "


def told(before: str = "") -> str:
    """Return what a fresh interpreter says of the kernel."""
    done = python(f"{before}\n{TOLD}")
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_a_summary_says_whether_it_is_used() -> None:
    assert versions()["kernel"] == STATE
    assert (COMPILED is None) == (STATE != "compiled")


@pytest.mark.parametrize("word", ["off", "OFF ", "0", "no", "false"])
def test_it_can_be_turned_off(monkeypatch: pytest.MonkeyPatch, word: str) -> None:
    monkeypatch.setenv("RIBBONOPT_KERNEL", word)
    assert told() == "True off (RIBBONOPT_KERNEL)"


def test_where_it_is_not_built_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("RIBBONOPT_KERNEL", raising=False)
    assert told(f"{STANDS_IN}None") == "True not built"


def test_one_of_other_sources_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("RIBBONOPT_KERNEL", raising=False)
    assert told(f"{STANDS_IN}types.ModuleType('old')") == (
        "True not built (of other sources: install again)"
    )


@pytest.mark.usefixtures("kernel")
def test_it_is_used_unless_something_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("RIBBONOPT_KERNEL", raising=False)
    assert told() == "False compiled"


def test_a_build_that_is_asked_for_is_there() -> None:
    """Where the environment says that the kernel must have been built, as it does in CI."""
    if os.environ.get("RIBBONOPT_KERNEL") == "on":
        assert STATE == "compiled"
