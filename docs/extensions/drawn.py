"""One scene of the gallery, solved and drawn in a process of its own."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from ribbonopt import load_scene, load_study, loads_scene, solve, summarize
from ribbonopt.output.report import report
from ribbonopt.scene import Scene
from ribbonopt.studies.batch.sweep import is_study

DPI = 110


@dataclass(frozen=True)
class Drawn:
    """What is shown of a scene: its picture, its report, and what kind of file it is."""

    picture: Path
    report: str
    study: bool
    continued: bool
    mapped: bool

    @classmethod
    def of(cls, folder: Path) -> Drawn:
        """Return what `draw` has written to a folder."""
        kind = (folder / "kind.txt").read_text(encoding="utf-8").split()
        text = (folder / "report.txt").read_text(encoding="utf-8")
        of_kind = ("study" in kind, "continued" in kind, "mapped" in kind)
        return cls(folder / "ribbon.png", text, *of_kind)


def draw(path: Path, folder: Path) -> None:
    """Solve a scene, or the first ribbon of a study, and write picture, kind and report."""
    import matplotlib

    matplotlib.use("Agg")
    study = is_study(path)
    scene = _first(path) if study else load_scene(path)
    solution = solve(scene)
    if not solution.verified:
        raise RuntimeError(f"{path}: {solution.message}")
    solution.plot("ribbon").savefig(folder / "ribbon.png", dpi=DPI, bbox_inches="tight")
    alone = {"continued": scene.continuation, "mapped": scene.map}
    kind = "study" if study else " ".join(name for name, value in alone.items() if value)
    (folder / "kind.txt").write_text(kind, encoding="utf-8")
    text = report(summarize(solution))
    (folder / "report.txt").write_text(text, encoding="utf-8")  # last: then all is there


def _first(path: Path) -> Scene:
    """Return the scene of the first ribbon of a study."""
    ribbon = next(load_study([path]).ribbons)
    return loads_scene(ribbon.source.text, ribbon.source.name, ribbon.overrides)
