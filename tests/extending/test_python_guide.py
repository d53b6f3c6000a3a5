"""docs/python.md is one program: it runs as it stands, and prints what it says it prints."""

import re
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

GUIDE = Path(__file__).parents[2] / "docs" / "python.md"
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", GUIDE.read_text(encoding="utf-8"), re.DOTALL)
NUMBER = re.compile(r"-?\d+(?:\.\d*)?(?:e[+-]?\d+)?")
BAR = re.compile(r"\+- \S+?(?=[,;>\s]|$)")


def words_and_numbers(text: str) -> tuple[list[str], list[float]]:
    """Take apart what is printed; bars, which are of the size of rounding, are left out."""
    text = BAR.sub("+-", text)
    return NUMBER.sub("#", text).split(), [float(found) for found in NUMBER.findall(text)]


@pytest.mark.slow
def test_the_guide_runs_and_prints_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    program: dict[str, Any] = {"__name__": "guide"}
    told, said, printed = "", "", StringIO()
    for kind, text in BLOCKS:
        if kind == "python":
            with redirect_stdout(printed):
                exec(compile(text, str(GUIDE), "exec"), program)
        else:
            assert kind == "text"
            words, numbers = words_and_numbers(printed.getvalue())
            told, said = printed.getvalue(), text
            expected = words_and_numbers(said)
            assert words == expected[0], told
            assert numbers == pytest.approx(expected[1], rel=1e-6, abs=1e-9), told
            printed = StringIO()
    assert printed.getvalue() == ""  # nothing is printed that is not shown
    assert sum(kind == "python" for kind, _ in BLOCKS) == 8
    for name in ("ribbon", "strains", "energy", "angles"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
