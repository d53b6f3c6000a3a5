"""Attack ribbonopt: hostile scenes, studies, names, saved files and environments, and kills.

    python scripts/attack.py                        # all of it: some forty minutes on two cores
    python scripts/attack.py --share 0.01           # a hundredth of everything
    python scripts/attack.py --part scenes --count 2000 --seed 7

Whatever it is given, ribbonopt ends in time, with exit status 0, 2 or 3 and one message, leaves
nothing behind and loses nothing. Counts are printed by kind; every fault with what was done, and
its files are kept to have it again (`--keep`). Exit status 1 if there is any. The same seed gives
the same attack. Linux and macOS.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import attack_commands
import attack_environments
import attack_files
import attack_kills
from attack_cases import Case, attempted
from attack_runs import GOOD, MEMORY, warm


class Answer(NamedTuple):
    """What an attack came to: `ended` is an exit status or a word, `fault` "" if all is right."""

    part: str
    kind: str
    label: str
    ended: str
    fault: str


class Task(NamedTuple):
    """The share of one process in a part: every `jobs`-th attack, from `first`."""

    part: str
    seed: int
    count: int
    first: int
    jobs: int
    scratch: Path
    keep: Path


def _commands(task: Task) -> Iterator[Answer]:
    """Run commands on hostile files."""
    cases = {
        "scenes": attack_commands.checks,
        "solves": attack_commands.solves,
        "studies": attack_commands.studies,
        "names": attack_commands.names,
    }[task.part]
    warm()
    for index, case in enumerate(cases(task.seed, task.count)):
        if index % task.jobs == task.first:
            outcome = attempted(case, task.scratch / f"{task.part}-{index}")
            if outcome.fault:
                _keep(case, outcome.fault, task.keep / f"{task.part}-{index}")
            ended, label = str(outcome.run.status), f"{index} {case.label}"
            yield Answer(task.part, case.kind, label, ended, outcome.fault)


def _keep(case: Case, fault: str, folder: Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    case.write(folder)
    words = {"arguments": list(case.arguments), "label": case.label, "fault": fault}
    (folder / "fault.json").write_text(json.dumps(words, indent=2), encoding="utf-8")


def _files(task: Task) -> Iterator[Answer]:
    """Spoil saved files, and read them by all that reads them."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    place = task.scratch / f"files-{task.first}"
    originals = attack_files.Originals(place / "sound")
    spoiled = attack_files.mutations(task.seed * task.jobs + task.first, originals, place / "o")
    for _ in range(task.first, task.count, task.jobs):
        mutation = next(spoiled)
        word, told = attack_files.outcome(mutation, originals)
        kind, fault = f"{mutation.kind}/{mutation.file}", told if word == "fault" else ""
        yield Answer("files", kind, mutation.label, word, fault)


def _environments(task: Task) -> Iterator[Answer]:
    """Run each verb in each hostile environment, `count` of them."""
    place = task.scratch / f"environments-{task.first}"
    for index, (label, verb, status, fault) in enumerate(
        attack_environments.runs(place, task.seed, task.count, task.first, task.jobs)
    ):
        yield Answer("environments", verb, f"{index} {label}", str(status), fault)


def _kills(task: Task) -> Iterator[Answer]:
    """Kill commands at random times."""
    place = task.scratch / f"kills-{task.first}"
    place.mkdir()
    kills = len(range(task.first, task.count, task.jobs))
    report = attack_kills.attack(place, kills, task.seed * task.jobs + task.first)
    for ending, count in report.endings.items():
        for _ in range(count):
            yield Answer("kills", ending.partition(":")[0], "", "killed", "")
    for fault in report.faults:
        yield Answer("kills", "lost or left", "", "fault", fault)


VERBS = len(attack_environments.VERBS)
PARTS: dict[str, tuple[int, Callable[[Task], Iterator[Answer]]]] = {
    "scenes": (20_000, _commands),
    "solves": (2_000, _commands),
    "studies": (300, _commands),
    "names": (600, _commands),
    "files": (5_000, _files),
    "environments": (len(list(attack_environments.environments())) * VERBS, _environments),
    "kills": (100, _kills),
}


def _share(task: Task) -> None:
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that what it has begun ends with it
    with open(_answers(task), "w", encoding="utf-8") as file:
        for answer in PARTS[task.part][1](task):
            file.write(json.dumps(answer) + "\n")


def _answers(task: Task) -> Path:
    return task.scratch / f"{task.part}-{task.first}.jsonl"


def _told(task: Task, status: int | None) -> Iterator[Answer]:
    """Yield what a process has found; that it did not come to its end is a fault too."""
    for line in _answers(task).read_text(encoding="utf-8").splitlines():
        yield Answer(*json.loads(line))
    if status:
        yield Answer(task.part, "the attack itself", "", str(status), "has died")


def attack(counts: dict[str, int], seed: int, jobs: int, keep: Path) -> list[Answer]:
    """Return what the attacks of each part came to; `counts` says how many."""
    found: list[Answer] = []
    with tempfile.TemporaryDirectory(prefix="attack") as scratch:
        for part, count in counts.items():
            started = time.perf_counter()
            tasks = [Task(part, seed, count, i, jobs, Path(scratch), keep) for i in range(jobs)]
            fork = multiprocessing.get_context("fork")
            shares = [fork.Process(target=_share, args=(task,)) for task in tasks]
            for share in shares:
                share.start()
            for share in shares:
                share.join()
            codes = zip(tasks, (share.exitcode for share in shares), strict=True)
            answers = [answer for task, code in codes for answer in _told(task, code)]
            found += answers
            print(f"{part}: {len(answers)} in {time.perf_counter() - started:.0f} s", flush=True)
    return found


def table(found: list[Answer]) -> Iterator[str]:
    """Yield lines: how often each kind ended how, and how many faults there were."""
    kinds: dict[tuple[str, str], list[Answer]] = {}
    for answer in found:
        kinds.setdefault(answer[:2], []).append(answer)
    for (part, kind), answers in kinds.items():
        ends = Counter(answer.ended for answer in answers)
        words = ", ".join(f"{count} {ended}" for ended, count in sorted(ends.items()))
        faults = sum(bool(answer.fault) for answer in answers)
        yield f"{part:<13}{kind[:30]:<31}{len(answers):>6}{faults:>5} faults   {words}"


def main() -> int:
    """Attack, and say what came of it."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--part", action="append", choices=list(PARTS), help="only this part")
    parser.add_argument("--count", type=int, help="attacks of each part")
    parser.add_argument("--share", type=float, default=1.0, help="of the full counts")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--keep", default="results/attack", help="folder for the files of faults")
    options = parser.parse_args()
    names, keep = options.part or list(PARTS), Path(options.keep).absolute()
    counts = {n: options.count or max(1, round(options.share * PARTS[n][0])) for n in names}
    found = attack(counts, options.seed, options.jobs, keep)
    print("\n".join(table(found)))
    faults = [answer for answer in found if answer.fault]
    for part, kind, label, _, fault in faults:
        print(f"{part} {kind} {label[:100]!r}: {fault[:400]!r}")
    good = sum(answer.ended in map(str, GOOD) for answer in found)
    print(f"{len(found)} attacks ({good} ended with status 0, 2 or 3), {len(faults)} faults")
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
