"""A small study, and what is asked of its rows, for the tests of batches."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

STUDY = """\
name: study
scene: scene.yaml
sweep:
  grid: {law.epsilon: {from: 0.1, to: 0.01, count: 30, scale: log}}
"""
# A module that every process loads first: what some scenes do to their worker.
ON_PURPOSE = """\
import os, sys, time
from ribbonopt.scene.document import Document
whole = Document.scene
def scene(document, overrides=()):
    if any("name" in o and "crash" in o for o in overrides):
        os._exit(9)
    if any("name" in o and "hang" in o for o in overrides):
        with open("hanging", "a") as file:
            print(os.getpid(), file=file)
        time.sleep(600)
    return whole(document, overrides)
Document.scene = scene
"""
COMMAND = [sys.executable, "-m", "ribbonopt", "batch"]


def without_times(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return rows by number, without what no two runs have in common."""
    rows = [{k: v for k, v in row.items() if k != "seconds"} for row in rows]
    return sorted(rows, key=lambda row: row["number"])


def written(folder: Path) -> list[dict[str, Any]]:
    """Return the rows of a folder."""
    lines = (folder / "rows.jsonl").read_text().splitlines()
    return without_times([json.loads(line) for line in lines])


def on_purpose(study: Path, name: str, count: int = 6, **more: Any) -> dict[str, str]:
    """Make a study of so many, the fourth of which crashes or hangs; return the environment."""
    names = [f"r{i}" if i != 3 else name for i in range(count)]
    data = {"scene": "scene.yaml", "sweep": {"list": [{"name": n} for n in names]}} | more
    study.write_text(json.dumps(data))
    (study.parent / "sitecustomize.py").write_text(ON_PURPOSE)
    path = os.pathsep.join([str(study.parent), os.environ.get("PYTHONPATH", "")])
    return os.environ | {"PYTHONPATH": path}


def lost(study: Path, name: str, *arguments: str, **more: Any) -> list[dict[str, Any]]:
    """Run that study, which fails in one ribbon; return its rows."""
    environment = on_purpose(study, name, **more)
    done = subprocess.run(
        [*COMMAND, str(study), "--quiet", "--out", str(study.parent / "out"), *arguments],
        env=environment,
        cwd=study.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 3, done.stderr
    assert "1 of 6 ribbons failed" in done.stderr
    return written(study.parent / "out")
