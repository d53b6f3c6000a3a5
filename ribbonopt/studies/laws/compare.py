"""Compare the laws that can carry a scene: one row each, differences to the scene's own law."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.output.summary import versions
from ribbonopt.plain import Row
from ribbonopt.scene import Scene
from ribbonopt.scene.units import units_of
from ribbonopt.studies.machine import machine

from .choice import Choice, Sizes, choices, names_of, under
from .described import Described
from .makers import ALL
from .rows import columns, row_of, table_row
from .solved import Outcome, near, own

NOTHING = Sizes()


@dataclass(frozen=True)
class LawComparison:
    """One scene under several laws.

    Attributes
    ----------
    name : str
        Of the scene.
    reference : str
        The law that differences are taken to; "" where none gave a verified solution.
    units : str
        Of energies, forces and moments.
    rows : tuple of Row
        One for each law, the scene's own first.
    """

    name: str
    reference: str
    units: str
    rows: tuple[Row, ...]

    columns = columns()

    @property
    def solved(self) -> bool:
        """Whether any law gave a verified solution."""
        return any(row["verified"] for row in self.rows)

    def plain(self) -> dict[str, Any]:
        """Everything but curves as plain data for JSON."""
        return {
            "name": self.name,
            "reference": self.reference,
            "units": self.units,
            "rows": [table_row(row) for row in self.rows],
            "machine": machine(),
            "versions": versions(),
        }

    def with_curves(self) -> dict[str, Any]:
        """Return everything, with what a figure draws."""
        return self.plain() | {"rows": list(self.rows)}


def compare_laws(
    scene: Scene,
    laws: Iterable[str] = (ALL,),
    sizes: Sizes = NOTHING,
    told: Callable[[str], None] = lambda text: None,
) -> LawComparison:
    """Solve a scene under its own law and under others.

    Parameters
    ----------
    scene
        What to solve; a `continuation` is not followed (see `branches`).
    laws
        Types of laws, or "all".
    sizes
        Of the ribbon, in units of the scene, where it has no `ribbon`.
    told
        Is told which law it is at.

    Raises
    ------
    SceneError
        If a law is not known, or sizes are given twice. What a law cannot carry is a row.
    """
    scene = replace(scene, continuation=None)
    chosen = list(choices(scene, names_of(laws), sizes))
    outcomes = _outcomes(scene, chosen, told)
    first = next((i for i, one in enumerate(outcomes) if one is not None and one.verified), None)
    reference, name = None, ""
    if first is not None:
        solution = outcomes[first].solution  # type: ignore[union-attr]
        assert solution is not None
        reference, name = Described(solution), chosen[first].name
    rows = [row_of(*pair, reference) for pair in zip(chosen, outcomes, strict=True)]
    return LawComparison(scene.name, name, units_of(scene).name, tuple(rows))


def _outcomes(
    scene: Scene, chosen: list[Choice], told: Callable[[str], None]
) -> list[Outcome | None]:
    """Solve under each law that is not left out, from the first solution that there is."""
    found: list[Outcome | None] = []
    guess = None
    for i, choice in enumerate(chosen):
        if choice.law is None:
            found.append(None)
            continue
        told(choice.name)
        one = own(scene) if i == 0 else near(under(scene, choice), guess)
        guess = guess or (one.solution if one.verified else None)
        found.append(one)
    return found
