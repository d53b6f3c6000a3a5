"""Solvers read no options from the working folder."""

from pathlib import Path

import pytest

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene


@pytest.mark.parametrize("line", ["max_iter 1", "nonsense 3", "print_level 5"])
def test_ipopt_reads_no_options_of_the_working_folder(
    configs: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    line: str,
) -> None:
    scene = load_scene(configs / "moebius_half.yaml", ["solver={type: ipopt}"])
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ipopt.opt").write_text(line + "\n")
    assert solve(scene).verified
    assert capfd.readouterr() == ("", "")
