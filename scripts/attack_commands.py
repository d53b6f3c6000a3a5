"""Cases of the attack: hostile scenes, studies and texts, each with a command run on it."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

from attack_cases import Case
from attack_scenes import CONFIGS, Mutant, mutants
from attack_texts import texts

CHECK, SOLVE = 30.0, 300.0  # seconds that a command may take: some mutants are large and sound
ARCH: dict[str, Any] = {
    "name": "arch",
    "law": {"type": "variational", "delta": 0.1},
    "parameters": {"distance": 0.8, "turn": 0.2},
    "boundary": {
        "start": {"support": "clamped", "position": [0, 0, 0], "directors": "identity"},
        "end": {
            "support": "clamped",
            "position": [0, 0.05, "distance"],
            "directors": {"turns": [{"z": "turn"}]},
        },
    },
    "transcription": {"type": "collocation", "degree": 4, "intervals": 6},
}
DISTANCES = {"parameters.distance": [0.7, 0.8]}
STUDIES: dict[str, dict[str, Any]] = {
    "grid": {"sweep": {"grid": DISTANCES}, "time_limit": 60},
    "zip": {"sweep": {"zip": {**DISTANCES, "law.delta": [0.1, 0.2]}}, "save": "all", "name": "two"},
    "list": {"sweep": {"list": [{"parameters.turn": 0.1}, {"law.delta": 0.2}]}},
    "spaced": {"sweep": {"grid": {"law.delta": {"from": 0.1, "to": 0.2, "count": 2}}}},
    "random": {
        "sweep": {
            "random": {"count": 2, "seed": 3, "over": {"parameters.turn": {"uniform": [0, 1]}}}
        },
        "set": {"law.delta": 0.2},
    },
}
PLACES = ("name", "record", "parameter", "formula", "key", "override", "file", "study", "column")


def checks(seed: int, count: int) -> Iterator[Case]:
    """Yield scenes with wild numbers and broken structure, to be read and checked."""
    for mutant in mutants(seed, count, CONFIGS):
        yield _of_scene(mutant, ["check", "scene.yaml"], CHECK)


def solves(seed: int, count: int) -> Iterator[Case]:
    """Yield more of them, to be solved."""
    for mutant in mutants(seed + 1, count, CONFIGS):
        yield _of_scene(mutant, ["solve", "scene.yaml", "--out", "out"], SOLVE)


def studies(seed: int, count: int) -> Iterator[Case]:
    """Yield studies of two ribbons, spoiled in the same way; those that stay sound are solved."""
    with tempfile.TemporaryDirectory() as folder:
        for name, study in STUDIES.items():
            text = json.dumps({"scene": ARCH, **study}, indent=1)
            (Path(folder) / f"{name}.yaml").write_text(text, encoding="utf-8")
        for mutant in mutants(seed + 2, count, folder):
            words = ["batch", "study.yaml", "--jobs", "1", "--out", "out"]
            yield _case(mutant, "study.yaml", words, SOLVE)


def names(seed: int, count: int) -> Iterator[Case]:
    """Yield hostile texts as names, keys, values, files and options."""
    chance = Random(seed)
    for text in texts(seed, count):
        place = chance.choice(PLACES)
        verb = chance.choice((["check"], ["solve", "--out", "out"], ["solve", "--plot", "--json"]))
        scene: dict[str, Any] = json.loads(json.dumps(ARCH))
        words = [verb[0], "scene.yaml", *verb[1:]]
        match place:
            case "name":
                scene["name"] = text
            case "record":
                scene["record"] = {text: "dot(r, ex)"}
            case "parameter":
                scene["parameters"][text] = 1
            case "formula":
                scene["record"] = {"a": text}
            case "key":
                scene[text] = 1
            case "override":
                words += ["--set", f"{_said(text)}=1"]
            case "file":
                scene["guess"] = {"solution": text}
            case "study":
                words = ["batch", "study.yaml", "--jobs", "1"]
            case "column":
                words = ["batch", "study.yaml", "--jobs", "1", "--plot", f"{_said(text)}:energy"]
        study = {"scene": scene, "sweep": {"grid": DISTANCES}}
        study |= {"name": text} if place == "study" else {}
        files = {"scene.yaml": json.dumps(scene).encode(), "study.yaml": json.dumps(study).encode()}
        yield Case(place, repr(text), words, files, SOLVE)


def _said(text: str) -> str:
    """Return a text as a command line can give it."""
    return text.replace("\0", "")


def _of_scene(mutant: Mutant, words: list[str], seconds: float) -> Case:
    sets = [word for text in mutant.overrides for word in ("--set", text)]
    return _case(mutant, "scene.yaml", [*words, *sets], seconds)


def _case(mutant: Mutant, file: str, words: list[str], seconds: float) -> Case:
    kind, _, label = mutant.label.partition(": ")
    files = {file: mutant.text.encode("utf-8", "surrogatepass")}
    return Case(kind, label, words, files, seconds)
