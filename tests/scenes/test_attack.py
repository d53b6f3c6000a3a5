"""A fiftieth of the attack: scenes, studies, names, saved files, environments and kills."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are forked")
def test_nothing_breaks_it(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "scripts" / "attack.py"), "--share", "0.02"]
    done = subprocess.run(
        [*command, "--seed", "11", "--keep", str(tmp_path)],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert ", 0 faults" in done.stdout.splitlines()[-1]
