"""`solve --plot` and `plot` of what is no ribbon: two pictures, and why there is no third."""

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from user_modules import importer

from ribbonopt.output.results import load_solution
from ribbonopt.scene import Boundary, End, RotationVector, Scene

Run = Callable[..., Any]


@pytest.fixture
def rod(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Scene:
    """Return a rod, which the command line reads whatever file is named."""
    law = importer(tmp_path, monkeypatch)("rod").Rod(k1=0.4, k2=1.0, k3=-0.5)
    start = End("clamped", (0.0, 0.0, 0.0), "identity")
    end = End("clamped", (0.68, 0.15, 0.31), RotationVector((0.0, 2.4, 0.6)))
    scene = Scene("rod", law, Boundary(start, end))

    def load(options: argparse.Namespace) -> tuple[Scene, float]:
        return scene, 0.0

    monkeypatch.setattr("ribbonopt.cli.scene.load", load)
    return scene


@pytest.mark.parametrize("options", [(), ("--json",), ("--quiet",)])
def test_solve_says_what_it_cannot_draw(run: Run, rod: Scene, options: tuple[str, ...]) -> None:
    found = run("solve", "rod.yaml", "--out", "o", "--plot", *options)
    assert found.status == 0
    assert {path.name for path in Path("o").iterdir()} == {
        *("summary.json", "solution.npz", "strains.png", "ribbon.png"),
    }
    told = found.err.splitlines()
    assert [line.split(":")[2].strip() for line in told] == [
        "scene.yaml",
        "plane.png",
    ]
    assert "left out: plane.png: rod may bend in its own plane (u1 is up to 0.17" in told[-1]
    if options == ("--json",):
        assert json.loads(found.out)["u0"][0] == pytest.approx(0.4364123684, abs=1e-9)


def test_plot_says_so_too(run: Run, rod: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run("solve", "rod.yaml", "--out", "o").status == 0
    refused = run("plot", "o")
    assert refused.status == 2
    assert "scene.yaml missing; if the scene was declared in Python" in refused.err
    again = load_solution("o", rod)
    monkeypatch.setattr("ribbonopt.output.results.load_solution", lambda _: again)
    found = run("plot", "o")
    assert found.status == 0
    assert found.out.split() == [str(Path("o") / f"{name}.png") for name in ("strains", "ribbon")]
    assert "left out: plane.png: rod may bend in its own plane" in found.err
