"""Where the CPU of a warm answer goes: interpreter, numpy, CasADi, LAPACK, kernel, IPOPT.

    python scripts/profile_answer.py [--before CHECKOUT] [--case half 1e-9] [--seconds 5]
        [--rounds 3] [--symbols 12] [--out results/profile]

Linux's `perf` samples a process that solves a case of `bench_compiled.py` again and again, all of
it built before; every sample belongs to the library whose code was running. That is exact up to
the number of samples, and slows nothing: no call is counted, no line traced. `libc` is malloc, free
and copies, for whomever; what runs in Linux itself is `system`. Contenders are sampled by turns.
Milliseconds are the share times the CPU of an answer in the same seconds. Writes `profile.json`.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

from bench_compiled import BEFORE, ROOT, WITH, WITHOUT, Checkout
from compiled_cases import CASES

from ribbonopt.studies.machine import machine

# group: what the names of its libraries hold; the first that fits
GROUPS = {
    "kernel": r"_compiled\.",
    "IPOPT": r"ipopt|mumps|coin|metis|casadi-tp|gfortran|quadmath",  # its BLAS is CasADi's
    "LAPACK": r"openblas|lapack|blas|mkl",
    "CasADi": r"casadi",
    "numpy": r"multiarray|umath|numpy|pocketfft",
    "libc": r"^libc[.-]|^ld-",
    "libm": r"^libm[.-]",
    "interpreter": r"python|cpython",
    "system": r"^\[",
}
OTHER = "other"


def main() -> None:
    """Sample, print, write JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="an older checkout of this package")
    parser.add_argument("--case", default="half 1e-9", choices=CASES)
    parser.add_argument(
        "--seconds", type=float, default=5, help="of a round of the slowest contender"
    )
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--symbols", type=int, default=0, help="so many functions of each too")
    parser.add_argument("--out", type=Path, default=Path("results") / "profile")
    options = parser.parse_args()
    if not shutil.which("perf"):
        raise SystemExit("perf is not installed (Debian: linux-perf); nothing is profiled")
    options.out.mkdir(parents=True, exist_ok=True)
    checkouts = {WITH: Checkout(WITH, ROOT, True), WITHOUT: Checkout(WITHOUT, ROOT, False)}
    if options.before:
        checkouts[BEFORE] = Checkout(BEFORE, options.before, True)
    samples: dict[str, Counter[tuple[str, str]]] = {label: Counter() for label in checkouts}
    spent: dict[str, list[float]] = {label: [] for label in checkouts}
    for checkout in checkouts.values():
        checkout.ask(options.case, 1, 0)  # builds
    once = max(checkout.ask(options.case, 1, 0)["cpu_s"] for checkout in checkouts.values())
    count = max(1, round(options.seconds / once))  # of the same answers for all
    for turn in range(1, options.rounds + 1):
        for label, checkout in checkouts.items():
            found, sampled = sample(checkout, options.case, count, turn)
            spent[label].append(found)
            samples[label] += sampled
    for checkout in checkouts.values():
        checkout.close()
    result: dict[str, Any] = {
        "machine": machine(),
        "load": os.getloadavg(),
        "case": options.case,
        "contenders": {
            label: shares(samples[label], sorted(spent[label])[len(spent[label]) // 2])
            for label in checkouts
        },
    }
    report(result, samples, options.symbols)
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "profile.json").write_text(text, encoding="utf-8")
    print(f"written: {options.out / 'profile.json'}")


def sample(
    checkout: Checkout, case: str, count: int, turn: int
) -> tuple[float, Counter[tuple[str, str]]]:
    """Return CPU seconds of one of so many answers, and samples by library and function."""
    with TemporaryDirectory() as folder:
        data = Path(folder) / "data"
        command = ["perf", "record", "-q", "-e", "cpu-clock", "-F", "4000", "-o", str(data)]
        perf = subprocess.Popen(
            [*command, "-p", str(checkout.process)], stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        try:
            found = checkout.ask(case, count, turn)
        finally:
            perf.send_signal(2)
            _, words = perf.communicate(timeout=60)
        if not data.is_file():
            raise SystemExit(f"perf: {words.decode()}")
        command = ["perf", "script", "-i", str(data), "-F", "ip,sym,dso"]
        lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    counted: Counter[tuple[str, str]] = Counter()
    for line in lines.splitlines():
        match = re.match(r"\s*[0-9a-f]+ (.*) \((.*)\)$", line)
        if match:
            counted[Path(match[2]).name, match[1]] += 1
    return found["cpu_s"], counted


def group_of(library: str) -> str:
    """Return the group that a library belongs to."""
    return next((name for name, part in GROUPS.items() if re.search(part, library)), OTHER)


def shares(samples: Counter[tuple[str, str]], seconds: float) -> dict[str, Any]:
    """Return the shares of the groups, and the milliseconds of an answer that they are."""
    total = sum(samples.values())
    groups = dict.fromkeys((*GROUPS, OTHER), 0.0)
    for (library, _), count in samples.items():
        groups[group_of(library)] += count / total
    return {
        "samples": total,
        "ms": 1e3 * seconds,
        "share": groups,
        "ms_of": {name: 1e3 * seconds * share for name, share in groups.items()},
        "other": sorted({library for library, _ in samples if group_of(library) == OTHER}),
    }


def report(
    result: dict[str, Any], samples: dict[str, Counter[tuple[str, str]]], symbols: int
) -> None:
    """Print the table, and the functions that take most."""
    contenders = result["contenders"]
    print(f"{result['case']}: share of CPU, and ms of an answer; load {result['load'][0]:.1f}")
    print(" " * 12 + "".join(f"{label:>22}" for label in contenders))
    for name in (*GROUPS, OTHER):
        row = [(one["share"][name], one["ms_of"][name]) for one in contenders.values()]
        print(f"{name:<12}" + "".join(f"{share:13.1%} {ms:8.3f}" for share, ms in row))
    print(f"{'in all':<12}" + "".join(f"{one['ms']:22.3f}" for one in contenders.values()))
    print(f"{'samples':<12}" + "".join(f"{one['samples']:22d}" for one in contenders.values()))
    for label, counted in samples.items() if symbols else ():
        print(f"{label}:")
        total = sum(counted.values())
        for (library, function), count in counted.most_common(symbols):
            print(f"  {count / total:6.1%}  {library}: {function}")


if __name__ == "__main__":
    sys.exit(main())
