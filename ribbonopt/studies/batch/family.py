"""The equilibria that are known of a ribbon, each followed to the next ribbon of its chunk.

Of a scene with `starts: N` the first ribbon of a chunk is started N times. The next ones follow all
that was found, mirror images too, are started once more each, in another way every time, and take
the equilibrium of least energy. Where that is lost, N starts look for others.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial

from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError
from ribbonopt.pipeline.neighbour import Neighbour
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene
from ribbonopt.solution.potential import known_potential
from ribbonopt.solution.solution import Solution

MOST = 2  # times as many equilibria as starts are followed, the lowest
NEAR = 1.0  # times the least energy, that others may be above it to be followed at any cost


@dataclass(frozen=True, eq=False)
class Family:
    """Equilibria of a ribbon, the one of least energy first.

    Attributes
    ----------
    members : tuple of Neighbour
        The equilibria.
    number : int
        Number of the ribbon.
    turn : int
        How many ribbons were solved beside one another before this one.
    """

    members: tuple[Neighbour, ...]
    number: int
    turn: int = 0

    def near(self, member: Neighbour) -> bool:
        """Whether one may become that of least energy within a few ribbons."""
        lowest = known_potential(self.members[0].solution)
        return known_potential(member.solution) - lowest <= NEAR * abs(lowest)


def solve_beside(
    prepared: Prepared, scene: Scene | Posed, number: int, before: Family | None
) -> tuple[Solution, str, Family | None]:
    """Solve a ribbon from the one before, if that is near, else from nothing.

    Returns its solution, what it was started from, and what the next one may start from.
    """
    posed = prepared.posed(scene)
    if before is not None and before.members[0].prepared is not prepared:
        before = None
    if posed.given.equilibria is not None:
        return _all(prepared, posed, number, before)
    if posed.scene.starts > 1:
        return _least(prepared, posed, number, before)
    nearest = before.members[0] if before is not None else None
    name = f"ribbon {before.number}" if before is not None else ""
    beside = nearest and nearest.solve(posed)
    if beside is not None:
        return beside.solution, name, Family((beside,), number)
    found, start = prepared.solve(posed), "own"
    if nearest is not None and not found.verified:
        other = nearest.solve_at_any_cost(posed)
        if other.verified:
            told = f"its own start led nowhere ({found.status.failure}): it was solved from {name}"
            found, start = replace(other, fell_back=(*other.fell_back, told)), name
    family = Family((Neighbour(prepared, found),), number) if found.verified else None
    return found, start, family


def _least(
    prepared: Prepared, posed: Posed, number: int, before: Family | None
) -> tuple[Solution, str, Family | None]:
    """Solve a ribbon in all ways that are known; the equilibrium of least energy is its own."""
    from ribbonopt.starts.equilibria import distinct, least  # few scenes ask for it

    turn = before.turn + 1 if before is not None else 0
    followed = [_followed(member, posed, before) for member in before.members] if before else []
    known = [member for member in followed if member is not None]
    count = len(known)
    near = followed and followed[0] is not None
    own = turn % posed.scene.starts
    known += _started(prepared, posed, range(own, own + 1) if near else range(posed.scene.starts))
    if not known:
        return prepared.solve(posed), "own", None
    solutions = [member.solution for member in known]
    kinds = distinct(solutions)
    firsts = [image[0] for kind in kinds for image in kind][: MOST * posed.scene.starts]
    family = Family(tuple(known[i] for i in firsts), number, turn)
    start = f"ribbon {before.number}" if before and firsts[0] < count else "own"
    return least(solutions, kinds), start, family


def _all(
    prepared: Prepared, posed: Posed, number: int, before: Family | None
) -> tuple[Solution, str, Family | None]:
    """Search for all equilibria of a ribbon, from those of the ribbon before as well."""
    from ribbonopt.studies.equilibria.solved import solved  # few scenes ask for it

    near = [member.solution for member in before.members] if before else []
    found = solved(posed.given, prepared, known=near)
    members = tuple(Neighbour(prepared, each) for each in (found, *found.others))
    return found, f"ribbon {before.number}" if before else "own", Family(members, number)


def _followed(member: Neighbour, posed: Posed, before: Family) -> Neighbour | None:
    beside = member.solve(posed)
    if beside is None and before.near(member):
        found = member.solve_at_any_cost(posed)
        beside = Neighbour(member.prepared, found) if found.verified else None
    if beside is None:
        return None
    return replace(beside, solution=replace(beside.solution, times=member.solution.times))


def _started(prepared: Prepared, posed: Posed, numbers: range) -> list[Neighbour]:
    """Start a scene in the ways of these numbers; return what is verified."""
    from ribbonopt.starts.equilibria import more_starts

    found: list[Solution] = []
    attempt = partial(prepared.polish, scene=posed)
    further = range(max(numbers.start, 1), numbers.stop)
    with suppress(ConvergenceError):  # raised again where nothing else is known
        if 0 in numbers:
            found.append(prepared.solve(posed))
        for solution in more_starts(posed, prepared.automatic, attempt, further):
            found.append(solution)
    return [Neighbour(prepared, solution) for solution in found if solution.verified]
