"""Studies of half a Moebius ribbon, for the tests of studies and their chunks."""

from pathlib import Path
from typing import Any

from ribbonopt.studies.batch.inputs import rows_of
from ribbonopt.studies.batch.study import Source, Study, Sweep
from ribbonopt.studies.batch.sweep import load_study

SCENE = """\
name: half
law: {type: regularized, epsilon: 0.1}
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}
  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}
guess: {force: [0, 43, 42], moment: [0, 2, -9]}
tolerance: 1e-7
"""
VARIATIONAL = SCENE.replace("regularized, epsilon", "variational, delta")
BAD = SCENE.replace("boundary", "bondary")


def loaded(folder: Path, text: str, *overrides: str) -> Study:
    """Return the study of a text, `scene.yaml` beside it."""
    (folder / "scene.yaml").write_text(SCENE, encoding="utf-8")
    (folder / "study.yaml").write_text(text, encoding="utf-8")
    return load_study([folder / "study.yaml"], overrides)


def swept(*, source: str = "scene.yaml", **sweep: Any) -> Study:
    return Study("swept", (Sweep(Source(source, SCENE), {}, rows_of(Path(), sweep)),))
