"""A map that was drawn: loci, regions and counts as plain data, branches and shapes on demand.

found = ribbonopt.load("results/NAME-map")
found.plot()
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ribbonopt.doors import map_drawn
from ribbonopt.output.results import Built, load_solution
from ribbonopt.output.saved import read_scene
from ribbonopt.plain import Row
from ribbonopt.reading import read_json
from ribbonopt.scene import Scene
from ribbonopt.solution.at_home import in_notebook
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.text import one_line, shortened

from .saved import FILE, MAP, SCENE, read_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Map:
    """The map of a scene, as `ribbonopt map` has written it.

    Attributes
    ----------
    data : dict
        What `map.json` says: `x`, `y`, `ranges`, `lines`, `loci`, `regions`, `points`, `doubts`.
    folder : Path
        Where it was read from.
    """

    def __init__(self, data: Mapping[str, Any], folder: Path) -> None:
        """Take what `map.json` says, checked."""
        self.data, self.folder = data, folder
        self._built: Built = {}

    @classmethod
    def load(cls, folder: str | Path) -> Map:
        """Return the map of a folder; OutputError if it holds none, or is damaged."""
        folder = Path(folder)
        read_map(folder)
        return cls(read_json(folder / FILE, MAP), folder)

    @property
    def name(self) -> str:
        """Name of the scene."""
        return str(self.data["name"])

    @cached_property
    def scene(self) -> Scene:
        """The scene, whose `map` says what was asked for."""
        return read_scene(self.folder / SCENE)

    @property
    def regions(self) -> list[Row]:
        """The regions, the largest first: `at`, `count`, `stable`, `rings`, and more."""
        return list(self.data["regions"])

    @property
    def doubts(self) -> list[str]:
        """What does not fit together, in words."""
        return list(self.data["doubts"])

    @property
    def loci(self) -> list[Branch]:
        """The loci, each as the branch that it is."""
        return [Branch.load(self.folder / locus["folder"]) for locus in self.data["loci"]]

    @property
    def held(self) -> str:
        """What it holds that can be looked at by itself, in words for who asks for the whole."""
        names = [f"{line['folder']}/1" for line in self.data["lines"]][:1]
        names += [each["folder"] for each in self.data["loci"]][:1]
        names += [f"{each['folder']}/1" for each in self.data["points"]][:1]
        some = ", ".join(one_line(str(self.folder / name)) for name in names)
        return (
            f"{one_line(str(self.folder))}: is a map, which is drawn by ribbonopt plot; choose a "
            f"branch, a locus or a shape in it, such as {some}"
        )

    def shapes(self, point: int) -> list[Solution]:
        """Return the equilibria at a counted point, by its number from 1; those saved."""
        found = {each["number"]: each for each in self.data["points"]}
        if point not in found:
            raise KeyError(f"{point}: no counted point of that number; there are {len(found)}")
        place = self.folder / found[point]["folder"]
        numbers = range(1, len(found[point]["shapes"]) + 1)
        return [load_solution(place / str(n), built=self._built) for n in numbers]

    def pictured(self) -> dict[int, list[Solution]]:
        """Return the stable shapes at the first counted point of each region, by its number."""
        firsts: dict[int, Row] = {}
        for point in self.data["points"]:
            if point["verified"]:
                firsts.setdefault(point["region"], point)
        found = {}
        for point in firsts.values():
            stable = [i for i, shape in enumerate(point["shapes"], start=1) if shape["stable"]]
            place = self.folder / point["folder"]
            found[point["number"]] = [
                load_solution(place / str(i), built=self._built) for i in stable
            ]
        return found

    def plot(self, style: object | None = None) -> Figure:
        """Return the figure; `style` is a `ribbonopt.views.Style`."""
        return map_drawn(self.data, self.pictured(), style)

    def __repr__(self) -> str:
        """Say what it is in one line."""
        name = shortened(one_line(self.name), 40)
        axes = shortened(one_line(f"{self.data['x']} and {self.data['y']}"), 80)
        loci, regions = len(self.data["loci"]), len(self.data["regions"])
        words = f"{loci} {'locus' if loci == 1 else 'loci'}, {regions} region{'s' * (regions != 1)}"
        doubts = f"; {len(self.doubts)} in doubt" if self.doubts else ""
        return f"<Map {name}: {axes}; {words}{doubts}>"

    def _repr_html_(self) -> str | None:
        return in_notebook(self)
