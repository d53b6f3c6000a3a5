"""The survey of a map: branches on lines, loci of their special points, regions, shapes in each.

What is done next depends on what was found, in an order that no number of workers changes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.plain import Row
from ribbonopt.scene import Scene
from ribbonopt.scene.maps import MapPlan

from . import jobs
from .agreement import disagreement, pairs_of, partial
from .inner import innermost
from .jobs import Job
from .loci import Locus, at, inside, told_of, value_of
from .regions import Region, regions_of

Do = Callable[[str, Sequence[Job]], list[Row]]
MOST = 200  # loci
TRIES = 2  # of special points at one place
AT_ONCE = 2  # of the loci of a line, however many workers there are
IMAGE = 1e-6  # of the square: special points nearer than this are of mirror images


@dataclass(frozen=True, eq=False)
class Survey:
    """What a map has come to so far.

    Attributes
    ----------
    scene, plan : Scene, MapPlan
        What is mapped.
    do : callable
        Does jobs, told what they are, and returns their rows in the same order; those that failed
        say so in their `status`.
    """

    scene: Scene
    plan: MapPlan
    do: Do
    lines: list[Row] = field(default_factory=list)
    loci: list[Locus] = field(default_factory=list)
    regions: list[Region] = field(default_factory=list)
    points: list[Row] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def explore(self) -> None:
        """Do all of it."""
        self._follow_lines()
        for row in self.lines:
            self._follow_loci(row)
        self.regions.extend(regions_of([locus.curve for locus in self._drawn]))
        self._count()
        self._agree()
        self._note()

    @property
    def found(self) -> int:
        """How many special points the lines have found."""
        return sum(len(row.get("specials", ())) for row in self.lines)

    def counted_in(self, region: int) -> list[Row]:
        """Return the counts at points of a region, the first one at its innermost point."""
        return [row for row in self.points if row["region"] == region and row["verified"]]

    def _follow_lines(self) -> None:
        x, y = self.plan.x, self.plan.y
        wanted = [(x, value) for value in self.plan.levels]
        wanted += [(y, value) for value in self.plan.across]
        asked = [
            jobs.line(self.scene, self.plan, i, along, value)
            for i, (along, value) in enumerate(wanted, start=1)
        ]
        self.lines.extend(self.do("lines", asked))

    def _follow_loci(self, line: Row) -> None:
        """Follow the loci of the special points of a line that are on none of those known.

        A few at once: one that was followed may lead through the others. Of mirror images, which
        are at one place, another is tried where the first leads nowhere.
        """
        groups, lost = self._begins(line), dict[int, str]()
        for which in range(TRIES):
            left = [i for i, group in enumerate(groups) if len(group) > which]
            while left and len(self.loci) < MOST:
                left = [i for i in left if not self._is_known(groups[i][0])]
                some, left = left[:AT_ONCE], left[AT_ONCE:]
                told = self._follow([groups[i][which] for i in some])
                lost |= {i: words for i, words in zip(some, told, strict=True) if words}
        self.doubts.extend(words for i, words in lost.items() if not self._is_known(groups[i][0]))

    def _begins(self, line: Row) -> list[list[Row]]:
        """Return the special points of a line that loci may begin with, by their places."""
        groups: list[list[Row]] = []
        for special in line.get("specials", ()):
            place = np.array(at(special, self.plan))
            if special["kind"] not in self.plan.of or not inside(place):
                continue
            for group in groups:
                gap = np.hypot(*(np.array(at(group[0], self.plan)) - place))
                if group[0]["kind"] == special["kind"] and gap < IMAGE:
                    group.append(special)
                    break
            else:
                groups.append([special])
        return groups

    def _follow(self, begins: Sequence[Row]) -> list[str]:
        """Follow loci; return for each what it failed by, "" if it did not."""
        first, lost = len(self.loci) + 1, []
        asked = [
            jobs.locus(self.scene, self.plan, number, begin)
            for number, begin in enumerate(begins, start=first)
        ]
        rows = self.do("loci", asked) if asked else []
        for begin, number, row in zip(begins, range(first, first + len(rows)), rows, strict=True):
            found = row.get("points", ())
            lost.append("" if found else told_of("locus", begin, self.plan, row))
            again = self._is_known(begin)
            points = [begin] if again or not found else found
            ended = str(row.get("ending", row["message"]))
            ending = "the same as one before" if again else ended
            self.loci.append(Locus.of(number, begin["kind"], points, self.plan, ending))
        return lost

    def _is_known(self, special: Row) -> bool:
        place = np.array(at(special, self.plan))
        return any(
            locus.kind == special["kind"] and locus.goes_through(place) for locus in self._drawn
        )

    def _count(self) -> None:
        """Count shapes at the innermost point of each region, and where the plan says."""
        wide = [i for i, region in enumerate(self.regions) if not region.narrow]
        wanted = [(i, value_of(self.regions[i].point, self.plan)) for i in wide]
        for x, y in self.plan.points:
            place = np.array(at({self.plan.x: x, self.plan.y: y}, self.plan))
            wanted.append((self._region_at(place), (x, y)))
        self._count_at(wanted)

    def _agree(self) -> None:
        """Compare counts across loci; count once more where they do not agree, and tell."""
        suspects = {region for pair, _ in self._faults() for region in pair}
        again = []
        for i in sorted(suspects):
            known = np.array([at(row, self.plan) for row in self.counted_in(i)])
            point, clear = innermost(self.regions[i].face, known)
            if clear > 0:
                again.append((i, value_of(point, self.plan)))
        self._count_at(again)
        for i in range(len(self.regions)):
            counts = {(row["stable"], row["count"]) for row in self.counted_in(i)}
            if len({stable for stable, _ in counts}) > 1:
                told = " and ".join(str(stable) for stable, _ in sorted(counts))
                self.doubts.append(
                    f"region {i + 1}: {told} stable shapes at different points of it: a locus or a "
                    "shape was missed; give `lines` closer together"
                )
        self.doubts.extend(
            f"regions {a + 1} and {b + 1}: {fault}: a locus or a shape was missed"
            for (a, b), fault in self._faults()
        )

    def _note(self) -> None:
        """Tell where counts of neighbours cannot be compared as they are."""
        for a, b, number in pairs_of([region.beside for region in self.regions]):
            here, there = self.best(a), self.best(b)
            if here and there and (why := partial(self._drawn[number].kind, here, there)):
                self.notes.append(f"regions {a + 1} and {b + 1}: {why}")

    def _faults(self) -> list[tuple[tuple[int, int], str]]:
        """Return pairs of regions whose counts do not fit what is between them."""
        found = []
        for a, b, number in pairs_of([region.beside for region in self.regions]):
            here, there = (self.best(i) for i in (a, b))
            if here is None or there is None:
                continue
            locus = self._drawn[number]
            known = [row["negative"] for row in locus.rows if row.get("negative") is not None]
            fault = disagreement(locus.kind, min(known, default=None), here, there)
            if fault:
                found.append(((a, b), fault))
        return found

    def best(self, region: int) -> Row | None:
        """Return the count of a region that found most; None where there is none."""
        return max(self.counted_in(region), key=lambda row: row["count"], default=None)

    def changes(self, locus: Locus) -> bool | None:
        """Return whether the number of stable shapes changes across a locus; None: not known."""
        number = self._drawn.index(locus)
        counts = [
            (self.best(a), self.best(b))
            for a, b, line in pairs_of([region.beside for region in self.regions])
            if line == number
        ]
        known = [(a["stable"], b["stable"]) for a, b in counts if a and b]
        return any(a != b for a, b in known) if known else None

    @property
    def _drawn(self) -> list[Locus]:
        """The loci that are lines."""
        return [locus for locus in self.loci if len(locus.points) > 1]

    def _count_at(self, wanted: Sequence[tuple[int, tuple[float, float]]]) -> None:
        first = len(self.points) + 1
        asked = [
            jobs.shapes(self.scene, self.plan, number, *place)
            for number, (_, place) in enumerate(wanted, start=first)
        ]
        rows = self.do("shapes", asked)
        for (region, _), job, row in zip(wanted, asked, rows, strict=True):
            self.points.append({**row, "region": region, "folder": job.place})
            if not row["verified"]:
                self.doubts.append(told_of("count", job.inputs, self.plan, row))

    def _region_at(self, place: Array) -> int:
        """Return the region that a point of the square is in; the largest if it is on a border."""
        holds = (bool(region.face.contains(place[None])[0]) for region in self.regions)
        return next((i for i, inside in enumerate(holds) if inside), 0)
