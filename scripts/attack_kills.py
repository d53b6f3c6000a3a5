"""Kill commands at random times, and see that nothing is lost, and nothing left.

    python scripts/attack_kills.py --kills 100 --seed 1

`solve` into the folder of an older result, `continue` and `batch` that go on after each kill.
Whatever the moment: results are whole, old or new; what was accepted stays; the command that comes
after removes what is left; what is resumed to its end is what was never interrupted. Times are
random, and which of them hit is up to the machine: right is right at any.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ENDINGS = (signal.SIGTERM, signal.SIGINT, signal.SIGKILL, signal.SIGHUP)
LIMIT = 120.0  # seconds that a command may take on a busy machine
SCENE = """\
name: half
law: {type: regularized, epsilon: 0.1}
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}
  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}
guess: {force: [0, 43, 42], moment: [0, 2, -9]}
tolerance: 1e-7
continuation: {parameter: law.epsilon, from: 0.1, to: 0.02, scale: log, largest: 0.05}
"""
STUDY = """\
name: study
scene: scene.yaml
save: all
sweep: {grid: {law.epsilon: {from: 0.1, to: 0.01, count: 40, scale: log}}}
"""


@dataclass
class Report:
    """What was done, and what was wrong."""

    endings: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)

    def check(self, right: bool, fault: str) -> None:
        """Note a fault where something is not right."""
        if not right:
            self.faults.append(fault)


def attack(folder: Path, kills: int, seed: int, kinds: tuple[str, ...] = ()) -> Report:
    """Kill so many commands in an empty folder."""
    report, chance = Report(), random.Random(seed)
    (folder / "scene.yaml").write_text(SCENE, encoding="utf-8")
    (folder / "study.yaml").write_text(STUDY, encoding="utf-8")
    makers: dict[str, Callable[..., Iterator[None]]] = {
        "solve": _solves,
        "continue": _branches,
        "batch": _batches,
    }
    attacks = [makers[kind](folder, chance, report) for kind in kinds or makers]
    for number in range(kills):
        next(attacks[number % len(attacks)])
    for one in attacks:
        one.close()  # runs on to the end, without kills
    return report


def _solves(folder: Path, chance: random.Random, report: Report) -> Iterator[None]:
    place = folder / "solves" / "result"
    commands = [["solve", "scene.yaml", "--plot", "--set", f"law.epsilon={e}"] for e in (0.1, 0.05)]
    whole = []
    for command in commands:
        seconds = _run(folder, [*command, "--out", str(place)])
        whole.append(_numbers(place))
    number = 0
    try:
        while True:
            command = [*commands[number % 2], "--out", str(place)]
            number += 1
            _killed(folder, command, chance, seconds, report, place.with_name(".result.new"))
            report.check(place.is_dir() or _is_aside(place), "solve: no result, old or new")
            if place.is_dir():
                report.check(_numbers(place) in whole, "solve: a result that is neither")
            yield
    finally:
        _run(folder, command)
        report.check(_numbers(place) == whole[(number - 1) % 2], "solve: not the new result")
        report.check(not _hidden(place.parent), f"solve: left {_hidden(place.parent)}")


def _branches(folder: Path, chance: random.Random, report: Report) -> Iterator[None]:
    command, whole = ["continue", "scene.yaml", "--plot"], folder / "branches" / "whole"
    seconds = _run(folder, [*command, "--out", str(whole)])
    reference, place = (whole / "branch.jsonl").read_bytes(), folder / "branches" / "branch"
    command += ["--out", str(place), "--resume"]

    def kept() -> bytes:
        file = place / "branch.jsonl"
        return file.read_bytes() if file.exists() else b""

    def is_good(before: bytes, fault: str) -> None:
        whole_lines = before[: before.rfind(b"\n") + 1]
        report.check(reference.startswith(kept()), f"continue: not the same branch{fault}")
        report.check(kept().startswith(whole_lines), f"continue: lost accepted points{fault}")

    yield from _resumed(folder, command, chance, seconds, report, place, kept, is_good)


def _batches(folder: Path, chance: random.Random, report: Report) -> Iterator[None]:
    command, whole = ["batch", "study.yaml", "--jobs", "2"], folder / "batches" / "whole"
    seconds = _run(folder, [*command, "--out", str(whole)])
    reference, place = _rows(_bytes(whole)), folder / "batches" / "batch"
    command += ["--out", str(place), "--resume"]

    def is_good(before: bytes, fault: str) -> None:
        rows, earlier = _rows(_bytes(place)), _rows(before)
        report.check(earlier.items() <= rows.items(), f"batch: lost rows{fault}")
        same = all(reference[number] == row for number, row in rows.items())
        report.check(same, f"batch: other rows{fault}")
        there = place / "solutions"
        left = _hidden(there) if there.is_dir() and not _hidden(place) else []
        report.check(not left, f"batch: left {left} in solutions{fault}")

    yield from _resumed(
        folder, command, chance, seconds, report, place, lambda: _bytes(place), is_good
    )


def _resumed(
    folder: Path,
    command: list[str],
    chance: random.Random,
    seconds: float,
    report: Report,
    place: Path,
    kept: Callable[[], bytes],
    is_good: Callable[[bytes, str], None],
) -> Iterator[None]:
    """Kill a command that goes on each time; begin anew when it has come to its end."""
    verb = command[0]
    try:
        while True:
            before = kept()
            ended = _killed(folder, command, chance, seconds, report, place)
            is_good(max(before, kept(), key=len), f" after {ended}")
            if ended == 0:
                _forget(place)
            yield
    finally:
        before = kept()
        _run(folder, command)
        is_good(before, " in the end")
        whole = place.with_name("whole")
        names = [sorted(path.name for path in where.iterdir()) for where in (place, whole)]
        report.check(names[0] == names[1], f"{verb}: {names[0]} in the end, not {names[1]}")
        report.check(not _hidden(place.parent), f"{verb}: left {_hidden(place.parent)}")


def _killed(
    folder: Path,
    command: list[str],
    chance: random.Random,
    seconds: float,
    report: Report,
    appears: Path,
) -> int:
    """Run a command and kill it: at any time, or soon after it has begun to write."""
    told, aimed = chance.choice(ENDINGS), chance.random() < 0.5
    after = chance.uniform(0, 0.5 * seconds) if aimed else chance.uniform(0, 1.1 * seconds)
    before = _left(appears)
    process = subprocess.Popen(
        [sys.executable, "-m", "ribbonopt", *command],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    while aimed and process.poll() is None and not appears.exists():
        time.sleep(0.002)
    try:
        process.wait(after)
    except subprocess.TimeoutExpired:
        for child in _children(process.pid) if chance.random() < 0.5 else ():
            _send(child, told)  # as clusters do, who tell all
        _send(process.pid, told)
    try:
        _, said = process.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        report.faults.append(f"{command[0]}: did not end after {told.name}")
        return -1
    status = process.returncode
    report.endings[f"{command[0]} {told.name}: {status}"] += 1
    what = f"{command[0]} {told.name} after {after:.3f} s, seen {aimed}: status {status}"
    # Before Python has read the command line, the system does what it does by default.
    right = (0, -told, 128 + told)
    report.check(status in right, f"{what}: {said}")
    early = status == -signal.SIGINT
    report.check("Traceback" not in said or early, f"{what}: {said}")
    if status == 128 + told:
        told_so = "ribbonopt: " in said or not said  # it had not begun
        report.check(told_so, f"{what}: says {said!r}")
        left = [name for name in _left(appears) if name not in before]
        report.check(not left, f"{what}: left {left}")
    return status


def _left(place: Path) -> list[str]:
    return [name for one in (place, place.parent) if one.is_dir() for name in _hidden(one)]


def _run(folder: Path, command: list[str]) -> float:
    """Run a command to its end; return the seconds that it took."""
    start = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-m", "ribbonopt", *command],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=LIMIT,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(f"{command}: status {done.returncode}: {done.stderr}")
    return time.monotonic() - start


def _send(process: int, told: int) -> None:
    with suppress(ProcessLookupError):
        os.kill(process, told)


def _children(process: int) -> list[int]:
    found: list[int] = []
    for file in Path(f"/proc/{process}/task").glob("*/children"):  # each thread has its own
        with suppress(OSError):  # it has ended
            found += map(int, file.read_text().split())
    return found


def _hidden(folder: Path) -> list[str]:
    return sorted(name for name in os.listdir(folder) if name.startswith("."))


def _is_aside(place: Path) -> bool:
    return any(name.startswith(f".{place.name}.") for name in _hidden(place.parent))


def _numbers(place: Path) -> list[bytes]:
    """Return what of a result is the same in each run."""
    summary = json.loads((place / "summary.json").read_text(encoding="utf-8"))
    scene = (place / "scene.yaml").read_bytes()
    return [scene, json.dumps([summary["energy"], summary["status"]]).encode()]


def _bytes(place: Path) -> bytes:
    file = place / "rows.jsonl"
    return file.read_bytes() if file.exists() else b""


def _rows(data: bytes) -> dict[int, dict[str, Any]]:
    """Return whole rows by number, without their times."""
    rows = [json.loads(line) for line in data[: data.rfind(b"\n") + 1].splitlines()]
    return {row["number"]: {k: v for k, v in row.items() if k != "seconds"} for row in rows}


def _forget(place: Path) -> None:
    import shutil

    shutil.rmtree(place)


def main() -> int:
    """Attack, and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", default=[])
    options = parser.parse_args()
    for number in ENDINGS:
        if number != signal.SIGKILL and signal.getsignal(number) == signal.SIG_IGN:
            signal.signal(number, signal.SIG_DFL)  # else what is attacked would ignore it too
    with tempfile.TemporaryDirectory() as folder:
        report = attack(Path(folder), options.kills, options.seed, tuple(options.only))
    for ending, count in sorted(report.endings.items()):
        print(f"{ending}: {count}")
    print(f"{sum(report.endings.values())} kills, {len(report.faults)} faults")
    print("\n".join(report.faults))
    return 1 if report.faults else 0


if __name__ == "__main__":
    sys.exit(main())
