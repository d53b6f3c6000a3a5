"""Saved files as bad disks, editors, other programs and other versions leave them; seeded.

    python scripts/attack_files.py 5000 --seed 1

writes a solution, a branch, a batch, a scene and a study, spoils a file of one of them in one way,
reads it by all that reads it, and counts by kind of file what came of it: read, refused (one
message), or a fault of ours, each of which is told once with the mutation that led to it. Tests
and other attacks take `Originals` and `mutations`.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import shutil
import signal
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

from mutators import archived, bytewise, jsonwise, odd_node

from ribbonopt import reading
from ribbonopt.errors import RibbonoptError

SECONDS = 30  # longest that any file may take
MEMORY = 4 * 2**30  # bytes that all of it may take
COLUMN = """\
name: column
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {P: 30, turn: 0.1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {position: {x: 0}, force: {y: 3, z: -P}, d3: {x: 0}, d1: {y: turn}, moment: {d1: 0}}
guess: {force: [0, 3, -30], moment: [0, 0, 0]}
tolerance: 1e-6
transcription: {type: collocation, degree: 4, intervals: 6}
record: {shortening: "1 - dot(r, ez)"}
"""
BRANCH = COLUMN + "continuation: {parameter: parameters.P, from: 20, to: 26, largest: 3}\n"
STUDY = """\
name: study
scene: scene.yaml
sweep: {csv: rows.csv}
"""
CSV = "parameters.P,name\n30,a\n31,b\n32.5,c\n"
FILES = {
    "solution": ("summary.json", "solution.npz", "scene.yaml"),
    "branch": ("branch.jsonl", "scene.yaml"),
    "batch": ("rows.jsonl", "study.json", "exports.json"),
    "study": ("study.yaml", "scene.yaml", "rows.csv"),
}


class Mutation(NamedTuple):
    """A spoiled copy: of what kind, which file, how, and the folder that it is in."""

    kind: str
    file: str
    label: str
    folder: Path


class Originals:
    """Sound folders of every kind, and others of the same kind whose files may be mixed up."""

    def __init__(self, folder: Path) -> None:
        """Solve what they hold; a second or two."""
        from ribbonopt.output.results import save_solution
        from ribbonopt.pipeline.prepared import solve
        from ribbonopt.scene import loads_scene
        from ribbonopt.studies.batch.files import BatchFolder
        from ribbonopt.studies.batch.processes import message
        from ribbonopt.studies.batch.sweep import load_study
        from ribbonopt.studies.batch.worker import Worker
        from ribbonopt.studies.continuation.continuation import Continuation
        from ribbonopt.studies.continuation.files import BranchFolder

        self.folder = folder
        for name, given in (("solution", []), ("solution.other", ["parameters.P=31"])):
            (folder / name).mkdir(parents=True)
            save_solution(solve(loads_scene(COLUMN, overrides=given)), folder / name)
        for name, given in (("branch", []), ("branch.other", ["law.B2=1.1"])):
            scene = loads_scene(BRANCH, overrides=given)
            list(BranchFolder(folder / name, scene, resume=False).follow(Continuation(scene)))
        for name, text in (("study", CSV), ("study.other", CSV.replace("31", "31.5"))):
            (folder / name).mkdir()
            (folder / name / "scene.yaml").write_text(COLUMN)
            (folder / name / "study.yaml").write_text(STUDY)
            (folder / name / "rows.csv").write_text(text)
            study = load_study([folder / name / "study.yaml"])
            batch = BatchFolder(folder / name.replace("study", "batch"), study, resume=False)
            worker = Worker()
            chunk = message(study.ribbons, [], [], "none", "")
            for answer in worker.answers(chunk):
                if "row" in answer:
                    batch.append(answer["row"])
            batch.close()
            (batch.folder / "exports.json").write_text('{"files": ["mine.txt"]}\n')
            (batch.folder / "mine.txt").write_text("mine\n")

    def copy(self, kind: str, to: Path) -> Path:
        """Return a sound copy of a kind in a new place."""
        shutil.rmtree(to, ignore_errors=True)
        shutil.copytree(self.folder / kind, to)
        return to


def mutations(
    seed: int, originals: Originals, scratch: Path, *, kinds: tuple[str, ...] = tuple(FILES)
) -> Iterator[Mutation]:
    """Yield spoiled copies without end; each takes the place of the one before."""
    chance = random.Random(seed)
    while True:
        kind = chance.choice(kinds)
        name = chance.choice(FILES[kind])
        folder = originals.copy(kind, scratch / kind)
        path = folder / name
        other = originals.folder / f"{kind}.other" / name
        ways: list[Callable[[], str]] = [
            lambda path=path: bytewise(chance, path),
            lambda path=path: bytewise(chance, path),
            lambda path=path: odd_node(chance, path),
            lambda path=path, other=other: mixed_up(path, other),
        ]
        if name.endswith((".json", ".jsonl")):
            ways[2:2] = [lambda path=path, other=other: jsonwise(chance, path, other)] * 8
        if name.endswith(".npz"):
            ways[2:2] = [lambda path=path: archived(chance, path)] * 8
        yield Mutation(kind, name, chance.choice(ways)(), folder)


def mixed_up(path: Path, other: Path) -> str:
    """Put the file of another result in the place of a file."""
    if other.exists():
        shutil.copy(other, path)
    return "the file of another"


def read(mutation: Mutation, originals: Originals) -> None:
    """Read a spoiled copy by all that reads it; raises RibbonoptError where it is refused."""
    {"solution": _solution, "branch": _branch, "batch": _batch, "study": _study}[mutation.kind](
        mutation.folder, originals
    )


def _solution(folder: Path, originals: Originals) -> None:
    from ribbonopt.output.results import load_solution
    from ribbonopt.output.summary import summarize

    loaded = load_solution(folder)
    loaded.sample(loaded.nodes, "r")
    json.dumps(summarize(loaded), allow_nan=False)
    if loaded.status.converged and abs(abs(loaded.n0[2]) - 30) > 1e-3:
        raise AssertionError("deceived: another load than the scene's")


def _branch(folder: Path, originals: Originals) -> None:
    from ribbonopt.scene import loads_scene
    from ribbonopt.studies.continuation.continuation import Continuation
    from ribbonopt.studies.continuation.files import BranchFolder, load_branch, rows_of
    from ribbonopt.studies.continuation.stored import restored

    scene, lines = load_branch(folder)
    numbers = [row["number"] for row in rows_of(lines)]
    for _, solution in restored(Continuation(scene), lines, numbers):
        solution.sample(solution.nodes, "r")
    scene = loads_scene(BRANCH)
    list(BranchFolder(folder, scene, resume=True).follow(Continuation(scene)))
    sound = rows_of(load_branch(originals.folder / "branch")[1])
    found = rows_of(load_branch(folder)[1])
    if [row["number"] for row in found] != [row["number"] for row in sound]:
        raise AssertionError("deceived: points are not those of the branch")
    for row, other in zip(found, sound, strict=True):
        known = row.get("energy") is not None
        if known and abs(row["energy"] - other["energy"]) > 1e-6 * abs(other["energy"]):
            raise AssertionError("deceived: points are not those of the branch")


def _batch(folder: Path, originals: Originals) -> None:
    from ribbonopt.studies.batch.files import BatchFolder, load_batch
    from ribbonopt.studies.batch.sweep import load_study
    from ribbonopt.viewer.report import write_report

    rows = _lines(folder / "rows.jsonl")
    record, loaded = load_batch(folder)
    name, count = record["name"], record["ribbons"]
    write_report(loaded, record["inputs"], folder / "report.html", name=name, count=count)
    if len(loaded) < rows:
        raise AssertionError("deceived: rows are dropped in silence")
    study = load_study([originals.folder / "study" / "study.yaml"])
    BatchFolder(folder, study, resume=True).close()


def _lines(path: Path) -> int:
    """Ribbons that whole lines of a file are of: a ribbon whose line stands twice has one row."""
    if not path.is_file() or path.stat().st_size > 1e6:
        return 0
    *whole, _ = path.read_bytes().split(b"\n")
    return len({_ribbon(line) for line in whole if line.strip()})


def _ribbon(line: bytes) -> object:
    try:
        return str(json.loads(line)["number"])
    except (ValueError, KeyError, TypeError, RecursionError):
        return line


def _study(folder: Path, originals: Originals) -> None:
    from ribbonopt.studies.batch.sweep import load_study

    study = load_study([folder / "study.yaml"])
    study.check()
    list(study.ribbons)


@contextmanager
def limited(seconds: int) -> Iterator[None]:
    """Raise TimeoutError where something takes longer; where there are alarms."""

    def ring(*_: object) -> None:
        raise TimeoutError(f"took more than {seconds} s")

    if not hasattr(signal, "SIGALRM"):
        yield
        return
    before = signal.signal(signal.SIGALRM, ring)
    signal.alarm(seconds)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def outcome(mutation: Mutation, originals: Originals) -> tuple[str, str]:
    """Return what came of reading a spoiled copy, in a word, and what was said."""
    try:
        with limited(SECONDS):
            read(mutation, originals)
    except RibbonoptError as error:
        told = str(error)
        if len(told) > 2000 or "Traceback" in told:
            return "fault", f"message of {len(told)} letters: {told[:200]}"
        return "refused", told
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        place = [frame for frame in frames if "ribbonopt/" in frame.filename or frame is frames[0]][
            -1
        ]
        text = str(error).splitlines()[0][:120] if str(error) else ""
        where = f"{Path(place.filename).name}:{place.lineno}"
        return "fault", f"{type(error).__name__}: {text} ({where})"
    return "read", ""


def main() -> int:
    """Run mutations and tell what came of them."""
    options = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    options.add_argument("count", type=int, nargs="?", default=500)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--kinds", nargs="+", default=tuple(FILES), choices=tuple(FILES))
    options.add_argument("--messages", action="store_true", help="print all messages")
    given = options.parse_args()
    reading.PATIENCE = 0.2  # there are many pipes that nobody writes to
    counts: Counter[tuple[str, str, str]] = Counter()
    faults: dict[str, str] = {}
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with suppress(ImportError):  # a file without end must not take the machine with it
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    with tempfile.TemporaryDirectory() as place:
        originals = Originals(Path(place) / "sound")
        spoiled = mutations(given.seed, originals, Path(place) / "o", kinds=tuple(given.kinds))
        for mutation in (next(spoiled) for _ in range(given.count)):
            word, told = outcome(mutation, originals)
            counts[mutation.kind, mutation.file, word] += 1
            if word == "fault":
                faults.setdefault(told, f"{mutation.kind}/{mutation.file}: {mutation.label}")
            if given.messages:
                told = told.replace(place, "")
                print(f"{word}: {mutation.file}: {mutation.label}\n    {told}")
    for kind, names in FILES.items():
        for name in names if kind in given.kinds else ():
            words = (
                f"{counts[kind, name, word]:5} {word}" for word in ("read", "refused", "fault")
            )
            print(f"{kind + '/' + name:24}", *words)
    total: Counter[str] = Counter()
    for (_, _, word), count in counts.items():
        total[word] += count
    print(", ".join(f"{count} {word}" for word, count in sorted(total.items())))
    for told, where in faults.items():
        print(f"  {where}\n    {told.replace(place, '')}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
