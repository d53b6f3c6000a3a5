"""All ways to solve a scene: formulations, states, transcriptions and solvers."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

from ribbonopt.scene import Collocation, Ipopt, Newton, Scene, Shooting
from ribbonopt.studies.comparison.pairs import FORMULATIONS

from .trial import Trial

SCHEMES = ("gauss", "radau", "lobatto", "rk4", "rk8", "shooting-gauss")
STEPS = {"rk4": 8, "rk8": 2}
SOLVERS: dict[str, Ipopt | Newton] = {"newton": Newton(), "ipopt": Ipopt()}


def ways(scene: Scene, quick: bool) -> list[Trial]:
    """Every formulation by all states, transcriptions and both solvers, the rest as it was."""
    states = ("reduced", "full") if scene.states != "planar" else ("reduced", "planar", "full")
    every = product(FORMULATIONS, states, SCHEMES, SOLVERS)
    return [
        Trial(", ".join(way), _by(scene, *way), f"{way[0]}, {way[3]}", same=True)
        for way in every
        if not quick or _few(*way)
    ]


def _few(formulation: str, states: str, scheme: str, solver: str) -> bool:
    """Whether a way is one of few: each formulation once by each solver, each scheme once."""
    plain = scheme == "gauss" and states == "reduced"
    return plain or (formulation, states, solver) == ("inverted", "full", "newton")


def _by(scene: Scene, formulation: str, states: str, scheme: str, solver: str) -> Scene:
    given = scene.transcription
    count, degree = given.intervals, given.degree
    mesh: Collocation | Shooting
    if scheme in STEPS:
        mesh = Shooting(scheme=scheme, steps=STEPS[scheme], intervals=count)  # type: ignore[arg-type]
    elif scheme == "shooting-gauss":
        mesh = Shooting(scheme="gauss", degree=degree, intervals=count)
    else:
        mesh = Collocation(scheme=scheme, degree=degree, intervals=count)  # type: ignore[arg-type]
    return replace(
        scene,
        formulation=FORMULATIONS[formulation],
        states=states,  # type: ignore[arg-type]
        transcription=mesh,
        solver=SOLVERS[solver],
    )
