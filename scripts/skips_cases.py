"""What is skipped, each with the longer way beside it: the cases of `bench_skips.py`.

A case builds what it needs and returns two calls, the short way and the long one, both of which end
in the same answer. Where the package no longer goes the long way, it is led there for that call.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from starts_noise import Noisy

import ribbonopt.pipeline.neighbour as neighbour
import ribbonopt.pipeline.search as search
import ribbonopt.transcription.collocation.compiled as compiled
from ribbonopt.accuracy.estimate import analyse
from ribbonopt.checks.arcs import Arcs
from ribbonopt.pipeline.neighbour import Latest
from ribbonopt.pipeline.prepared import Prepared, prepare, solve
from ribbonopt.pipeline.search import Search
from ribbonopt.pipeline.tried import Tried
from ribbonopt.problem import Ribbon
from ribbonopt.scene import Scene, load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.automatic import Automatic

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
SMOOTH = "law={type: variational, delta: 0.05}"
TOLERANCE = "tolerance=1e-9"

Way = Callable[[], Any]


@dataclass(frozen=True)
class Case:
    """What is skipped and why, on which scene, and both ways; `turns` where one is slow."""

    skipped: str
    why: str
    scene: str
    ways: Callable[[], tuple[Way, Way]]
    turns: int | None = None


def scene(name: str, *overrides: str) -> Scene:
    """Return a shipped scene."""
    return load_scene(CONFIGS / f"{name}.yaml", overrides)


@contextmanager
def instead(place: Any, name: str, value: Any) -> Iterator[None]:
    """Put a value in the place of an attribute."""
    before = vars(place)[name]
    setattr(place, name, value)
    try:
        yield
    finally:
        setattr(place, name, before)


def led(way: Way, place: Any, name: str, value: Any) -> Way:
    """Return a way with a value in the place of an attribute."""

    def longer() -> Any:
        with instead(place, name, value):
            return way()

    return longer


def warm(short: Scene, long: Scene) -> tuple[Way, Way]:
    """Return two scenes solved again, all built before."""
    return prepare(short).solve, prepare(long).solve


def anew(prepared: Prepared, guess: Solution) -> Way:
    """Return a solve from a guess, with nothing kept of the one before."""
    fresh = replace(prepared, _latest=Latest())
    return lambda: replace(fresh, _latest=Latest()).solve(guess=guess)


def of_smooth(name: str, *overrides: str) -> tuple[Prepared, Solution]:
    """Return a scene built, and as a guess the answer under a smooth law."""
    other = scene(name, SMOOTH, *overrides)
    return prepare(scene(name, *overrides)), solve(replace(other, tolerance=None))


def _pass_without_phases() -> tuple[Way, Way]:
    short = anew(*of_smooth("moebius_regularized"))
    run = Search.run

    def longer(self: Search, guess: Any, *, quick: bool = False, shown: bool = True) -> bool:
        return run(self, guess, quick=quick, shown=False)

    return short, led(short, Search, "run", longer)


def _settled() -> tuple[Way, Way]:
    prepared = prepare(scene("moebius_regularized"))
    start = prepared.guess()
    for seed in range(50):  # the first noise in which no phases show, and which leads to them
        noisy = Noisy(start, 0.1, seed)
        short: Way = lambda guess=noisy: prepared.solve(guess=guess)  # noqa: E731
        found = short()
        plain = [step for step in found.steps if step["step"].endswith("intervals")]
        if found.verified and found.sheets and len(plain) == 1 and len(found.steps) == 3:
            return short, led(short, search, "SETTLED", 0.0)
    raise RuntimeError("no noise leads to phases by a pass without them")


def _second_verification() -> tuple[Way, Way]:
    short = anew(*of_smooth("moebius_whole", "law={type: variational, delta: 0.01}"))
    return short, led(short, Tried, "refined_alone", property(lambda _: False))


def _mesh_of_guess() -> tuple[Way, Way]:
    found = solve(scene("moebius_whole"))
    short = anew(prepare(scene("moebius_whole")), found)
    return short, led(short, neighbour, "_of_mesh", lambda *_: None)


def _factors() -> tuple[Way, Way]:
    first = scene("moebius_regularized", TOLERANCE)
    prepared = prepare(first)
    found = prepared.solve()
    near = replace(first, law=replace(first.law, epsilon=0.0102))
    return lambda: prepared.solve(near, guess=found), lambda: replace(
        prepared, _latest=Latest()
    ).solve(near, guess=found)


def _bars() -> tuple[Way, Way]:
    prepared = prepare(scene("moebius_regularized"))

    def longer() -> Solution:
        found = prepared.solve()
        analyse(found)
        return found

    return prepared.solve, longer


def _program() -> tuple[Way, Way]:
    one = scene("moebius_regularized")

    def longer() -> Solution:
        prepared = prepare(one)
        prepared.structure.build()
        return prepared.solve()

    return lambda: solve(one), longer


def _mechanics() -> tuple[Way, Way]:
    prepared = prepare(scene("end_moment"))

    def made(self: Automatic) -> Ribbon:
        return Ribbon.of(self.posed.under(formulation="inverted", states="reduced"))

    return prepared.solve, led(prepared.solve, Automatic, "_inverted", property(made))


def _eliminated() -> tuple[Way, Way]:
    short, long = prepare(scene("moebius_half")), prepare(scene("moebius_half"))
    w, p = short.start()

    def none(phases: Any, count: int) -> Any:
        return np.empty(0, np.intp)

    with instead(compiled, "integrated_states", none):
        long.nlp.blocks.compiled  # noqa: B018  (built with all states in the elements' systems)
    return lambda: short.solver.solve(w, p), lambda: long.solver.solve(w, p)


def _vain_ipopt() -> tuple[Way, Way]:
    prepared = prepare(scene("moebius_whole", "law={type: regularized, epsilon: 0.01}"))
    start = Noisy(prepare(scene("moebius_regularized")).guess(), 1.0, 4)
    return (
        lambda: prepared.solve(guess=start),
        lambda: prepared.solve(guess=start, fallback=False),
    )


def _files() -> tuple[Way, Way]:
    from ribbonopt.output.results import save_solution
    from ribbonopt.views.files import draw_figures

    prepared = prepare(scene("moebius_half"))

    def longer() -> Solution:
        found = prepared.solve()
        with TemporaryDirectory() as folder:
            save_solution(found, Path(folder))
            draw_figures(found, Path(folder))
        return found

    return prepared.solve, longer


def _phases() -> tuple[Way, Way]:
    """Return both ways of a ribbon of one sign: as it is, and in a phase of that sign."""
    prepared = prepare(scene("moebius_half", TOLERANCE))
    start = prepared.guess()

    def longer() -> bool:
        one = prepared.search()
        return one.run_in(Arcs((1,), np.empty(0)), start)

    return lambda: prepared.search().run(start), longer


HALF = "moebius_half"
CASES = (
    Case(
        "nine director components, n and m as states",
        "a quaternion carries the frame; n is constant, m follows from r",
        "half Moebius",
        lambda: warm(scene(HALF), scene(HALF, "states=full")),
    ),
    Case(
        "IPOPT and the sparse Jacobian",
        "Newton's method condenses element by element",
        "half Moebius",
        lambda: warm(scene(HALF), scene(HALF, "solver={type: ipopt}")),
        9,
    ),
    Case(
        "states in the systems of the elements",
        "no rate of r contains r: 6 x 4 unknowns, not 6 x 7",
        "half Moebius, Newton's method alone",
        _eliminated,
    ),
    Case(
        "building",
        "only numbers have changed",
        "half Moebius",
        lambda: (prepare(scene(HALF)).solve, lambda: solve(scene(HALF))),
        9,
    ),
    Case(
        "the automatic start",
        "a guess is given",
        "whole Moebius, epsilon = 0.01",
        lambda: warm(
            scene("moebius_regularized", TOLERANCE),
            scene("moebius_regularized", "guess=auto", TOLERANCE),
        ),
        9,
    ),
    Case(
        "refinement and its bar",
        "no tolerance is asked for",
        "half Moebius",
        lambda: warm(scene(HALF), scene(HALF, TOLERANCE)),
    ),
    Case(
        "pictures and files",
        "neither is asked for",
        "half Moebius",
        _files,
        5,
    ),
    Case(
        "IPOPT after Newton's method",
        "the automatic start comes first, and leads on",
        "whole Moebius, start with noise of 100 %",
        _vain_ipopt,
        3,
    ),
    Case(
        "phases",
        "m2 keeps its sign",
        "half Moebius",
        _phases,
    ),
    Case(
        "a pass without phases",
        "the guess, a solution of a smooth law, shows them",
        "whole Moebius, epsilon = 0.01",
        _pass_without_phases,
    ),
    Case(
        "the last steps of a pass without phases",
        "signs of m2 are settled; the rest is done in phases",
        "the same, start with noise of 10 %",
        _settled,
    ),
    Case(
        "bars",
        "nobody asks for them, and no sign of m2 is in doubt",
        "whole Moebius, epsilon = 0.01",
        _bars,
    ),
    Case(
        "a verification",
        "what will be refined is verified then",
        "whole Moebius, delta = 0.01, from delta = 0.05",
        _second_verification,
    ),
    Case(
        "a pass on the scene's own mesh",
        "the guess has one for its tolerance",
        "whole Moebius, delta = 0.01, from a saved answer",
        _mesh_of_guess,
    ),
    Case(
        "factors",
        "those of the ribbon before serve",
        "whole Moebius, epsilon from 0.01 to 0.0102",
        _factors,
    ),
    Case(
        "the program without phases",
        "all is solved in phases",
        "whole Moebius, epsilon = 0.01, built and solved",
        _program,
        9,
    ),
    Case(
        "mechanics of known loads, built again",
        "those of the structure serve",
        "end_moment, solved again",
        _mechanics,
    ),
)
