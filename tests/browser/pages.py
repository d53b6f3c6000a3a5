"""The pages that are opened in browsers, each made when it is first asked for."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

from made_modes import made_modes

from ribbonopt import Branch, Continuation, Solution, load, load_scene, solve
from ribbonopt.studies.batch.results import Batch
from ribbonopt.viewer import embedded
from ribbonopt.viewer.looking import view_of
from ribbonopt.viewer.page import page_of
from ribbonopt.viewer.view import View

#: what would act if a page did not take it for text
HOSTILE = (
    "</script><script>acted = 1</script><img src=x onerror='acted = 1'> \"'` ${acted} &amp; 環é🎗"
)
BATCH = """\
name: arches
save: all
scene:
  name: arch
  law: {type: variational, delta: 0.1}
  parameters: {distance: 0.8, turn: 0.2}
  boundary:
    start: {support: clamped, position: [0, 0, 0], directors: identity}
    end: {support: clamped, position: [0, 0.05, distance], directors: {turns: [{z: turn}]}}
  transcription: {type: collocation, scheme: gauss, degree: 6, intervals: 8}
  tolerance: 1e-4
  record: {deflection: "dot(r, ex) at 0.5"}
sweep:
  list:
"""
DISTANCES, TURNS, LOST = (0.6, 0.75, 0.9), (-0.9, 0.3, 0.6), 1.3  # the last is beyond its reach
MANY = 400
FAILED = 10  # number of the row without an answer
FAILING = ("solver.type=newton", "solver.max_iterations=1")


class Pages:
    """Files of pages in a folder, and what they show: `pages.file("batch")`, `pages.view(...)`."""

    def __init__(self, folder: Path, configs: Path) -> None:
        self.folder, self.configs = folder, configs
        self.solved: Callable[..., Solution] = cache(self._solved)
        self.view: Callable[[str], View] = cache(self._view)
        self.file: Callable[[str], Path] = cache(self._file)
        self.branch: Callable[[], Branch] = cache(self._branch)
        self.batch: Callable[[], Batch] = cache(self._batch)

    def _solved(self, name: str, *overrides: str) -> Solution:
        return solve(load_scene(self.configs / f"{name}.yaml", overrides))

    def _branch(self) -> Branch:
        overrides = ["tolerance=1e-6", "continuation.largest=8", "transcription.intervals=8"]
        return Branch.of(Continuation(load_scene(self.configs / "snap.yaml", overrides)))

    def _batch(self) -> Batch:
        from ribbonopt.cli import main

        rows = [(d, t) for d in DISTANCES for t in TURNS] + [(LOST, 0.1)]
        text = "".join(f"  - {{parameters.distance: {d}, parameters.turn: {t}}}\n" for d, t in rows)
        study = self.folder / "study.yaml"
        study.write_text(BATCH + text, encoding="utf-8")
        out = self.folder / "batch"
        main(["batch", str(study), "--out", str(out), "--quiet", "--jobs", "1"])
        found = load(out)
        assert isinstance(found, Batch)
        return found

    def _view(self, name: str) -> View:
        """Return the view of a name: "branch", "batch", another below, or a scene of `configs`."""
        if name == "branch":
            return view_of(self.branch())
        if name == "batch":
            return view_of(self.batch())
        if name == "point":  # a branch of one
            branch = self.branch()
            return view_of(Branch(branch.scene, branch._lines[:1]))
        if name == "equilibria":
            first = self.solved("clamped_arch")
            return view_of(replace(first, others=(self.solved("clamped_twist"), first)))
        if name == "modes":
            arch = self.solved("snap")
            return view_of(arch, modes=made_modes(arch))
        if name == "failed":
            solution = self.solved("clamped_arch", *FAILING)
            assert not solution.verified
            return view_of(solution)
        if name == "hostile":
            view = self.view("branch")
            one = replace(view.ribbons[0], caption=HOSTILE, note=HOSTILE, warnings=(HOSTILE,))
            one = replace(one, numbers=((HOSTILE, HOSTILE),))
            return replace(view, name=HOSTILE, about=HOSTILE, ribbons=(one, *view.ribbons[1:]))
        if name == "many":  # without a diagram: as many equilibria
            view = self.view("branch")
            ribbons = (view.ribbons * MANY)[:MANY]
            told = tuple(replace(one, caption=f"shape {i}") for i, one in enumerate(ribbons))
            return replace(view, kind="result", ribbons=told, diagram=None)
        return view_of(self.solved(name))

    def _file(self, name: str) -> Path:
        path = self.folder / f"{name}.html"
        if name == "report":
            self.batch()
            return self.folder / "batch" / "report.html"
        if name == "notebook":
            shown = [embedded(self.solved(one)) for one in ("moebius_half", "clamped_arch")]
            text = "<!DOCTYPE html><meta charset=utf-8><title>notebook</title><body>"
            text += "<p>between</p>".join(shown)
        else:
            text = page_of(self.view(name))
        path.write_text(text, encoding="utf-8")
        return path
