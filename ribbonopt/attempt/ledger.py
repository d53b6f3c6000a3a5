"""What a search has cost: the steps that were taken, and the reports of its solvers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.solvers import SolveReport

Step = Mapping[str, Any]


@dataclass(eq=False)
class Ledger:
    """Steps in order, each with its cost, and reports of the solvers that worked on the scene.

    Steps on the way to a guess are notes: their iterations are their own. What a user asked for and
    was not done is given up, in words; what was tried first on the way and led nowhere is what the
    search fell back from, by what was tried; what turned out to be needless is spared, with why.
    """

    steps: list[Step] = field(default_factory=list)
    reports: list[SolveReport] = field(default_factory=list)
    given_up: list[str] = field(default_factory=list)
    fell_back: dict[str, str] = field(default_factory=dict)
    spared: list[str] = field(default_factory=list)

    def note(self, step: str, seconds: float, iterations: int | None = None) -> None:
        """Note a step that needed no solver of the scene itself."""
        count = {} if iterations is None else {"iterations": iterations}
        self.steps.append({"step": step, **count, "seconds": seconds})

    def give_up(self, what: str) -> None:
        """Say what was asked for and is not what led to the answer."""
        self.given_up.append(what)

    def spare(self, what: str) -> None:
        """Say what was not done because something that is known serves in its place."""
        self.spared.append(what)

    def fall_back(self, tried: str, words: str) -> None:
        """Say what was tried, led nowhere, and what was done instead; the last word counts."""
        self.fell_back[tried] = words

    def enter(self, report: SolveReport, words: str) -> None:
        """Enter what a solver reports, one step for each solver that was tried."""
        for tried in report.tried:
            outcome = "" if tried.status.converged else f" ({tried.status.name.lower()})"
            self.note(f"{tried.solver}, {words}{outcome}", tried.total, tried.iterations)
            self.reports.append(tried)

    @property
    def iterations(self) -> int:
        """Iterations of all solvers."""
        return sum(report.iterations for report in self.reports)

    @property
    def solvers(self) -> tuple[str, ...]:
        """Names of the solvers used, IPOPT of the automatic start among them."""
        named = tuple(report.solver for report in self.reports)
        return (*named, "ipopt") if any("ipopt" in step["step"] for step in self.steps) else named

    def timings(self, build: float, seconds: float) -> dict[str, float]:
        """Seconds to build, of functions, of linear algebra, of all else, and in all."""
        evaluate = sum(report.evaluate for report in self.reports)
        linear = sum(report.linear for report in self.reports)
        rest = seconds - evaluate - linear
        spent = {"build": build, "evaluate": evaluate, "linear": linear, "rest": rest}
        return spent | {"total": seconds + build}
