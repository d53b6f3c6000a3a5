"""A fresh interpreter: what some code does and loads that nothing ran before."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]


def python(code: str) -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    return subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"PYTHONPATH": path},
    )


def loaded_by(code: str) -> set[str]:
    """Return the top-level modules that a fresh interpreter has loaded after some code."""
    tail = "\nimport sys\nprint(*{name.partition('.')[0] for name in sys.modules})"
    done = python(code + tail)
    assert done.returncode == 0, done.stderr
    return set(done.stdout.split())
