"""What ends a stage, as its scene asks: conditions on what is recorded, and special points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.scene import ContinuationStage
from ribbonopt.scene.stages import parse_stop, special_stop, words_of
from ribbonopt.solution.sampling import evaluate_formula

Condition = tuple[str, str, str, str]  # the text, its left side, sign and right side


def conditions_of(stage: ContinuationStage) -> Iterator[Condition]:
    """Yield the conditions of a stage, parsed."""
    for text in stage.stop:
        if special_stop(text) is None:
            yield text, *parse_stop(text)


@dataclass(frozen=True, eq=False)
class Stops:
    """What ends one stage."""

    stage: ContinuationStage

    @cached_property
    def conditions(self) -> tuple[Condition, ...]:
        """Conditions on what is recorded."""
        return tuple(conditions_of(self.stage))

    @cached_property
    def words(self) -> frozenset[str]:
        """Names that conditions speak of."""
        sides = (side for _, left, _, right in self.conditions for side in (left, right))
        return frozenset(word for side in sides for word in words_of(side))

    def met(self, row: Mapping[str, Any]) -> str:
        """Return the condition that a row meets, "" if none."""
        return next((text for text, margin in self.margins(row).items() if margin > 0), "")

    def margins(self, row: Mapping[str, Any]) -> dict[str, float]:
        """Return how far a row is beyond each condition: > 0 where met.

        Conditions on what the row does not have, or what is no number there, are left out.
        """
        values = {
            name: np.array([float(value)])
            for name, value in row.items()
            if isinstance(value, int | float)
        }
        found = {}
        for text, left, sign, right in self.conditions:
            if any(word not in values for word in (*words_of(left), *words_of(right))):
                continue
            with np.errstate(all="ignore"):
                a, b = (float(evaluate_formula(side, values)[0]) for side in (left, right))
            margin = a - b if sign == ">" else b - a
            if np.isfinite(margin):
                found[text] = margin
        return found

    def met_at(self, kind: str, count: int) -> str:
        """Return what is met by the special point of a kind and number from 1, "" if nothing."""
        return next((t for t in self.stage.stop if special_stop(t) == (kind, count)), "")
