"""`all_equilibria`: the search for all equilibria of one scene, from its own starts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

import numpy as np

from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline.once import no_start
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene
from ribbonopt.scene.equilibria import Equilibria
from ribbonopt.scene.lens import paths_of
from ribbonopt.scene.stages import located_stages
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.equilibria import distinct

from .found import Equilibrium, Found
from .line import Line
from .search import AGREES, Search, Tell, quiet
from .seeds import first_load_energy, seeds, waves
from .symmetry import symmetry_of
from .told import told

PARAMETERS, END = "parameters.", "boundary.end.position."
LEAST, ONE_TURN = 1e-6, 2 * np.pi**2  # energies, Dw = L = 1: none, of a strip bent to a ring
LOADS = 5.0  # times the energy of the strip as it buckles first: the limit, where none is given
GAP, COARSE = 1e-5, 1e-3  # of two that are images: relative, without a tolerance


def all_equilibria(
    scene: Scene,
    prepared: Prepared | None = None,
    *,
    known: Iterable[Solution] = (),
    tell: Tell = quiet,
) -> Found:
    """Search for all equilibria of a scene, unstable ones too.

    Parameters
    ----------
    scene
        The scene; its `equilibria` say along what is searched, defaults where it has none.
    prepared
        What was built for scenes of this structure.
    known
        Equilibria of scenes near by, from which is started besides.
    tell
        Called with what there is so far, in words, at every point.

    Raises
    ------
    ModelError
        If the scene is no square system of equations.
    ConvergenceError
        If no equilibrium is found.
    """
    prepared = prepared or prepare(scene)
    if not prepared.problem.square:
        raise ModelError(
            f"equilibria: the formulation {scene.formulation} is not a square system of equations, "
            "along which branches are followed; use inverted, differentiated, or algebraic without "
            "bounds",
            "equilibria",
        )
    posed = prepared.posed(scene)
    settings = scene.equilibria if isinstance(scene.equilibria, Equilibria) else Equilibria()
    started = list(chain(_near(prepared, posed, known), seeds(prepared, posed, settings.modes)))
    if not started:
        raise no_start()
    below = settings.below or _limit(posed, [solution.energy for _, solution in started])
    search = Search(prepared, posed, below, settings.points, tell)
    for name, solution in started:
        search.enter(solution, name)
    lines = list(_lines(prepared, scene, settings, started[0][1]))
    if len(started) <= 2 * settings.modes:
        _from_home(search, lines, settings.modes)
    search.run(lines)
    return _found(search, lines, len(started))


def _near(
    prepared: Prepared, posed: Posed, known: Iterable[Solution]
) -> Iterator[tuple[str, Solution]]:
    """Yield what equilibria of scenes near by lead to."""
    for solution in known:
        try:
            found = prepared.solve(posed, guess=solution, fallback=False, quick=True)
        except ConvergenceError:  # of this one: others may lead somewhere
            continue
        if found.verified:
            yield "equilibrium near by", found


def _limit(posed: Posed, energies: Sequence[float]) -> float:
    """Return the strain energy up to which is looked, by that of the first buckled shape."""
    unit = posed.units.moment
    first = first_load_energy(posed) * unit
    found = max(min(energies), first) if first else max(energies)
    return LOADS * (found if found > LEAST * unit else ONE_TURN * unit / posed.length)


def _lines(
    prepared: Prepared, scene: Scene, settings: Equilibria, first: Solution
) -> Iterator[Line]:
    """Yield the lines of the numbers that move; ModelError where one that is named changes nothing.

    Of the parameters that are taken where none is named, those that change something.
    """
    ranges = settings.ranges
    if not ranges:
        moved = [stage.parameter for _, stage in located_stages(scene)]
        stages = [path for one in moved for path in ((one,) if isinstance(one, str) else one)]
        named = [f"{PARAMETERS}{name}" for name in scene.parameters]
        ends = [path for path in paths_of(scene) if path.startswith(END)]
        ranges = dict.fromkeys(stages or named or ends)
    for path, range_ in ranges.items():
        line = Line.of(prepared, scene, path, range_, first)
        if line is not None:
            yield line
        elif path in settings.ranges:
            raise ModelError(
                f"equilibria.along: {path} changes nothing in this scene; name a number that its "
                "equations contain",
                "equilibria.along",
            )


def _from_home(search: Search, lines: Sequence[Line], modes: int) -> None:
    """Enter buckled shapes at zero of the numbers that move, where they led nowhere as it is."""
    for line in lines:
        if line.home is not None:
            for name, solution in waves(line.prepared, line.curve.posed_at(line.home), modes):
                search.enter(solution, name, line.name)


def _found(search: Search, lines: Sequence[Line], starts: int) -> Found:
    """Return what a search has come to, of all within its limit of energy."""
    tolerance = search.posed.scene.tolerance
    gap = COARSE if tolerance is None else max(GAP, AGREES * tolerance)
    nodes = [node for node in search.nodes.all if node.solution.energy <= search.below]
    above = len(search.nodes.all) - len(nodes)
    nodes = nodes or [min(search.nodes.all, key=lambda node: node.solution.energy)]
    kinds = []
    for kind in distinct([node.solution for node in nodes], gap):
        members = [nodes[i] for image in kind for i in image]
        images = tuple(member.solution for member in members)
        kinds.append(Equilibrium(images, symmetry_of(images[0], gap), members[0].found_by))
    return Found(tuple(kinds), told(search, lines, starts, above), search.below, search.points)
