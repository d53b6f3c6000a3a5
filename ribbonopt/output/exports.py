"""What a solution is written as: one class for each kind of file.

An export says which files it may write, so that the next result may replace them. One of your own
is a class with `name`, `files` and `write`, passed to `save_solution`; one that every result has is
a class here with its name at the foot.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from ribbonopt.plain import json_text
from ribbonopt.scene import unsayable
from ribbonopt.scene.quantities import VECTORS
from ribbonopt.scene.text.dump import dump
from ribbonopt.solution.solution import Solution

from .summary import summarize

EQUILIBRIA = "equilibria"
ROWS = 201


class Export(Protocol):
    """One kind of file of a result."""

    @property
    def name(self) -> str:
        """A word for it, for messages."""

    @property
    def files(self) -> tuple[str, ...]:
        """Names of the files, directly in the folder, that it may write."""

    def write(self, solution: Solution, folder: Path) -> Iterable[str] | None:
        """Write a solution into an existing folder; see `equilibria` for the others it has.

        What had to be left out is returned, each with its reason.

        Raises
        ------
        OSError
            If it cannot be written.
        """


def equilibria(solution: Solution, folder: Path) -> Iterator[tuple[Solution, Path]]:
    """Yield a solution with its folder, and other equilibria, which go to `equilibria/2`, ..."""
    yield solution, folder
    for i, other in enumerate(solution.others, start=2):
        inner = folder / EQUILIBRIA / str(i)
        inner.mkdir(parents=True, exist_ok=True)
        yield other, inner


class Fields:
    """`solution.npz`: rows along s in scene units, and what a reload needs."""

    name, files = "fields", ("solution.npz",)

    def write(self, solution: Solution, folder: Path) -> None:
        """Write `s` (k,), vectors (k, 3); in `units` Dw = L = 1 `w`, `theta`, ...

        Rows are evenly spaced; one at a place where n or strains jump has what is behind it.
        """
        for found, inner in equilibria(solution, folder):
            s, dense = np.linspace(*found.scene.interval, ROWS), found.dense
            rows = found.outputs(s)
            arrays: dict[str, Any] = {"s": s} | {name: rows[name] for name in VECTORS}
            arrays |= {"w": dense.w, "widths": dense.blocks.widths(dense.p)}
            arrays |= {"theta": dense.theta, "multipliers": found.multipliers}
            units = found.units
            arrays |= {"units": (units.length, units.force, units.stiffness)}
            arrays |= {"sheets": found.sheets, "elements": dense.blocks.layout.elements}
            np.savez(inner / "solution.npz", **arrays)


class SceneText:
    """`scene.yaml`: the scene that was solved; left out where it was declared in Python."""

    name, files = "scene", ("scene.yaml",)

    def write(self, solution: Solution, folder: Path) -> list[str]:
        """Write the scene of each equilibrium, where a file can say it."""
        reason = unsayable(solution.scene)
        for found, inner in equilibria(solution, folder):
            if reason:
                (inner / "scene.yaml").unlink(missing_ok=True)  # that of an older result
                continue
            # As it is: what was solved is valid.
            (inner / "scene.yaml").write_text(dump(found.scene), encoding="utf-8")
        return [f"scene.yaml: {reason}"] if reason else []


class Summary:
    """`summary.json`: numbers under keys that stay."""

    name, files = "summary", ("summary.json",)

    def write(self, solution: Solution, folder: Path) -> None:
        """Write the summary of each equilibrium."""
        for found, inner in equilibria(solution, folder):
            (inner / "summary.json").write_text(json_text(summarize(found)), encoding="utf-8")


#: what every result has
STANDARD: tuple[Export, ...] = (Fields(), SceneText(), Summary())
