"""The parts of the attack: what each makes of a seed and a count."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from .cases import Case
from .scenes import CONFIGS, mutants
from .texts import hostile

SOLVE_SECONDS = 240.0  # of a solve, some of which are large
HEAVY = 20  # ribbons that a mutated study may have, at most, before it is only checked
ARCH = """\
{
 "scene": {
  "name": "arch",
  "law": {"type": "variational", "delta": 0.1},
  "parameters": {"distance": 0.8, "turn": 0.2},
  "boundary": {
   "start": {"support": "clamped", "position": [0, 0, 0], "directors": "identity"},
   "end": {"support": "clamped", "position": [0, 0.05, "distance"],
    "directors": {"turns": [{"z": "turn"}]}}
  },
  "transcription": {"type": "collocation", "degree": 4, "intervals": 6}
 },
"""
STUDIES = (
    ARCH + ' "sweep": {"grid": {"parameters.distance": [0.7, 0.8]}},\n "time_limit": 60\n}\n',
    ARCH + ' "name": "two", "set": {"law.delta": 0.2}, "save": "all",\n'
    ' "sweep": {"zip": {"parameters.distance": [0.7, 0.8], "parameters.turn": [0, 0.1]}}\n}\n',
    ARCH + ' "sweep": {"list": [{"parameters.turn": 0.1}, {"law.delta": 0.2}]}\n}\n',
    ARCH + ' "sweep": {"random": {"count": 2, "seed": 3, "over": '
    '{"parameters.turn": {"uniform": [0, 1]}}}}\n}\n',
    ARCH + ' "sweep": {"grid": {"law.delta": {"from": 0.1, "to": 0.2, "count": 2}}}\n}\n',
)


@dataclass(frozen=True)
class Part:
    """How many cases the whole attack has of it, and what they are."""

    count: int
    cases: Callable[[int, int], Iterator[Case]]


def warm() -> None:
    """Import what most commands do, so that a process forked from this one need not."""
    import ribbonopt.cli.batch
    import ribbonopt.cli.scene
    import ribbonopt.output.results
    import ribbonopt.pipeline.check
    import ribbonopt.pipeline.prepared
    import ribbonopt.studies.batch.files
    import ribbonopt.views.report  # noqa: F401


def checks(seed: int, count: int) -> Iterator[Case]:
    """Scenes with wild numbers and broken structure, read and checked."""
    for mutant in mutants(seed, count, CONFIGS):
        yield _of_scene(mutant, ["check", "scene.yaml"], 30.0)


def solves(seed: int, count: int) -> Iterator[Case]:
    """The same, solved."""
    for mutant in mutants(seed + 1, count, CONFIGS):
        yield _of_scene(mutant, ["solve", "scene.yaml", "--out", "out"], SOLVE_SECONDS)


def _of_scene(mutant, words: list[str], seconds: float) -> Case:
    kind = mutant.label.partition(":")[0]
    sets = [word for text in mutant.overrides for word in ("--set", text)]
    files = {"scene.yaml": mutant.text.encode("utf-8", "surrogatepass")}
    return Case(kind, mutant.label, [*words, *sets], files, seconds)


def studies(seed: int, count: int) -> Iterator[Case]:
    """Studies, spoiled in the same way; those that stay sound are solved, two ribbons each."""
    folder = Path(__file__).parent / "studies"
    for mutant in mutants(seed + 2, count, folder):
        words = ["batch", "study.yaml", "--jobs", "1", "--out", "out"]
        files = {"study.yaml": mutant.text.encode("utf-8", "surrogatepass")}
        yield Case(mutant.label.partition(":")[0], mutant.label, words, files, SOLVE_SECONDS)


def names(seed: int, count: int) -> Iterator[Case]:
    """Hostile texts as names, keys, values, files and options, through every verb."""
    chance = random.Random(seed)
    scene = json.loads(ARCH + ' "sweep": {}\n}')["scene"]
    for _ in range(count):
        text = hostile(chance)
        place = chance.choice(("name", "record", "parameter", "formula", "key", "override", "file"))
        verb = chance.choice((["check"], ["solve", "--out", "out"], ["solve", "--plot", "--json"]))
        mine = {**scene, "name": text if place == "name" else "arch"}
        name = "scene.yaml"
        match place:
            case "record":
                mine["record"] = {text: "dot(r, ex)"}
            case "parameter":
                mine["parameters"] = {**scene["parameters"], text: 1}
            case "formula":
                mine["record"] = {"a": text}
            case "key":
                mine[text] = 1
        sets = ["--set", f"{text}=1"] if place == "override" else []
        if place == "file":
            sets = ["--set", f"guess={json.dumps({'solution': text})}"]
        content = json.dumps(mine).encode()
        yield Case(place, repr(text)[:80], [verb[0], name, *verb[1:], *sets], {name: content}, 120)


PARTS = {
    "scenes": Part(20_000, checks),
    "solves": Part(2_000, solves),
    "studies": Part(300, studies),
    "names": Part(500, names),
}
