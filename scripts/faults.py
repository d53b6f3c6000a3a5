"""Faults put into the package one by one, to see whether the tests notice.

    python scripts/faults.py                        all of `faults.yaml`
    python scripts/faults.py --only checks/arcs     some: part of a file's name, or a number
    python scripts/faults.py --home-only --jobs 2   tests of the home alone, two at a time

Each fault is put into a scratch copy of the repository, never into the checkout. The tests of its
home run first (by room, or what the fault names), and only what they let pass is put before the
whole quick suite. A home must pass without a fault, or it is no judge. Exit status 1 if any fault
survives. The compiled kernel is off: faults are in Python.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from queue import SimpleQueue

import yaml

ROOT = Path(__file__).resolve().parents[1]
LIST = Path(__file__).with_suffix(".yaml")
#: tests of a room: what is quick and means it
HOMES = {
    "scene": ("tests/unit/scene",),
    "mechanics": ("tests/unit/mechanics",),
    "problem": ("tests/unit/problem",),
    "transcription": ("tests/unit/transcription",),
    "solvers": ("tests/unit/solvers",),
    "solution": ("tests/unit/solution",),
    "guess": ("tests/unit/guess",),
    "accuracy": ("tests/unit/accuracy",),
    "checks": ("tests/unit/checks",),
    "attempt": ("tests/unit/pipeline",),
    "output": ("tests/unit/output",),
    "starts": ("tests/unit/starts",),
    "pipeline": ("tests/unit/pipeline",),
    "studies": ("tests/unit/studies",),
    "views": ("tests/unit/views",),
    "cli": ("tests/cli/test_cli.py",),
}
#: the house rules read the text of files, and judge no behaviour
WIDE = ("tests", "--ignore=tests/architecture")
UNTOUCHED = shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache", ".hypothesis")
FAILED = re.compile(r"^(?:FAILED|ERROR) (\S.*?)(?: - .*)?$", re.MULTILINE)


@dataclass(frozen=True)
class Fault:
    """A text of a file of the package, which occurs once, and what is put in its place."""

    number: int
    file: str
    before: str
    after: str
    why: str
    home: tuple[str, ...]

    @property
    def path(self) -> Path:
        """The file, in a copy of the repository."""
        return Path("ribbonopt") / self.file


@dataclass(frozen=True)
class Verdict:
    """What became of a fault: killed by its home, by the wide suite, or survived."""

    fault: Fault
    outcome: str
    by: str
    seconds: float


def faults(path: Path = LIST) -> list[Fault]:
    """Return the faults of a list, numbered from 1."""
    found = []
    for number, entry in enumerate(yaml.safe_load(path.read_text(encoding="utf-8")), start=1):
        home = tuple(entry.pop("home", "").split()) or HOMES[entry["file"].split("/")[0]]
        found.append(Fault(number=number, home=home, **entry))
    return found


def put_in(fault: Fault, text: str) -> str:
    """Return the text of a file with a fault in it; ValueError where that is not one place."""
    count = text.count(fault.before)
    if count != 1:
        raise ValueError(f"fault {fault.number}, {fault.file}: {fault.before!r} occurs {count}x")
    return text.replace(fault.before, fault.after)


def tested(copy: Path, tests: tuple[str, ...], limit: float, *options: str) -> tuple[int, str]:
    """Run tests in a copy of the repository; return pytest's exit status, and the first failure."""
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *options]
    environment = {**os.environ, "PYTHONPATH": str(copy), "OPENBLAS_NUM_THREADS": "1"}
    environment["RIBBONOPT_KERNEL"] = "off"  # it would do in the place of lines that have faults
    try:
        done = subprocess.run(
            [*command, *tests],
            cwd=copy,
            env=environment,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=limit,
        )
    except subprocess.TimeoutExpired:
        return 1, f"no end within {limit:g} s"
    failed = FAILED.search(done.stdout)
    return done.returncode, failed.group(1) if failed else done.stdout.strip()[-300:]


def judged(fault: Fault, copy: Path, settings: argparse.Namespace) -> Verdict:
    """Put a fault into a copy, run the tests, and take it out again."""
    started, place = time.perf_counter(), copy / fault.path
    text = place.read_text(encoding="utf-8")
    place.write_text(put_in(fault, text), encoding="utf-8")
    _forget(place)
    try:
        status, by = tested(copy, fault.home, settings.limit, "-n", "0")
        outcome = "killed by its home"
        if not status and not settings.home_only:
            status, by = tested(copy, WIDE, settings.wide_limit, "-n", str(settings.workers))
            outcome = "killed by the wide suite"
    finally:
        place.write_text(text, encoding="utf-8")
        _forget(place)
    if not status:
        outcome, by = "survived", ""
    return Verdict(fault, outcome, by, time.perf_counter() - started)


def _forget(place: Path) -> None:
    """Remove what Python has compiled of a file: by time and size it may look up to date."""
    for compiled in (place.parent / "__pycache__").glob(f"{place.stem}.*.pyc"):
        compiled.unlink()


def verdicts(chosen: list[Fault], settings: argparse.Namespace) -> Iterator[Verdict]:
    """Judge faults, some at a time, each in a copy of the repository that no other uses."""
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        copies: SimpleQueue[Path] = SimpleQueue()
        for i in range(settings.jobs):
            copies.put(Path(shutil.copytree(ROOT, Path(folder) / str(i), ignore=UNTOUCHED)))

        def one(fault: Fault) -> Verdict:
            copy = copies.get()
            try:
                return judged(fault, copy, settings)
            finally:
                copies.put(copy)

        def fit(home: tuple[str, ...]) -> tuple[int, str]:
            copy = copies.get()
            try:
                return tested(copy, home, settings.limit, "-n", "0")
            finally:
                copies.put(copy)

        with ThreadPoolExecutor(settings.jobs) as pool:
            homes = [] if settings.trust else list(dict.fromkeys(one.home for one in chosen))
            for home, (status, by) in zip(homes, pool.map(fit, homes), strict=True):
                if status:
                    raise SystemExit(f"{' '.join(home)} fails without a fault: {by}")
            yield from pool.map(one, chosen)


def main() -> int:
    """Judge the faults that the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=_Plain)
    parser.add_argument("--only", action="append", help="part of a file's name, or a number")
    parser.add_argument("--jobs", type=int, default=1, help="faults judged at a time")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="of the wide suite")
    parser.add_argument("--home-only", action="store_true", help="leave the wide suite out")
    parser.add_argument("--trust", action="store_true", help="homes are known to pass")
    parser.add_argument("--limit", type=float, default=600, help="seconds for a home")
    parser.add_argument("--wide-limit", type=float, default=3600, help="seconds for all tests")
    parser.add_argument("--json", type=Path, help="where to write the verdicts")
    settings = parser.parse_args()
    chosen = [fault for fault in faults() if not settings.only or _asked(fault, settings.only)]
    found, counts = [], dict.fromkeys(("killed by its home", "killed by the wide suite"), 0)
    for verdict in verdicts(chosen, settings):
        found.append(verdict)
        counts[verdict.outcome] = counts.get(verdict.outcome, 0) + 1
        fault = verdict.fault
        print(f"{fault.number:3} {fault.file}: {fault.why}: {verdict.outcome} {verdict.by}")
        sys.stdout.flush()
        if settings.json:
            rows = json.dumps([asdict(one) for one in found], indent=1)
            settings.json.write_text(rows, encoding="utf-8")
    print(", ".join(f"{count} {outcome}" for outcome, count in counts.items()))
    return int(counts.get("survived", 0) > 0)


def _asked(fault: Fault, words: list[str]) -> bool:
    return any(word == str(fault.number) or word in fault.file for word in words)


class _Plain(argparse.RawDescriptionHelpFormatter):
    """Keeps the lines of the description."""


if __name__ == "__main__":
    sys.exit(main())
