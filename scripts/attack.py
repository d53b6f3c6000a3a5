"""Attack ribbonopt: hostile scenes, studies, saved files, names and environments; kills.

    python scripts/attack.py                        # all of it, some twenty minutes on two cores
    python scripts/attack.py --part scenes --count 2000 --seed 7
    python scripts/attack.py --share 0.01           # a hundredth of everything

Whatever it is given, ribbonopt must end, in time, with exit status 0, 2 or 3 and one message, leave
nothing behind and lose nothing. Counts are printed by kind; each fault with the files and the words
to have it again (in `--keep`). Exit status 1 if there is any. The same seed gives the same attack.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from attacks.cases import Case, attempted
from attacks.parts import PARTS, warm

Answer = tuple[str, str, str, str, int | None, float, str]


def _answers(task: tuple[str, int, int, int, int, str, str]) -> list[Answer]:
    """Run every `jobs`-th case of a part, from one; return what each came to."""
    part, seed, count, first, jobs, scratch, keep = task
    warm()
    found: list[Answer] = []
    for index, case in enumerate(PARTS[part].cases(seed, count)):
        if index % jobs != first:
            continue
        outcome = attempted(case, Path(scratch) / f"{part}-{index}")
        if outcome.fault:
            _kept(case, outcome.fault, Path(keep) / f"{part}-{index}")
        run = outcome.run
        found.append(
            (part, case.kind, case.label, outcome.fault, run.status, run.seconds, f"{part}-{index}")
        )
    return found


def _kept(case: Case, fault: str, folder: Path) -> None:
    """Keep what is needed to have a fault again."""
    shutil.rmtree(folder, ignore_errors=True)
    for name, content in case.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    words = {"arguments": list(case.arguments), "label": case.label, "fault": fault}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fault.json").write_text(json.dumps(words, indent=2))


def attack(parts: dict[str, int], seed: int, jobs: int, keep: Path) -> list[Answer]:
    """Return what all cases came to; `parts` says how many of each."""
    found: list[Answer] = []
    with tempfile.TemporaryDirectory(prefix="attack") as scratch:
        for part, count in parts.items():
            started = time.perf_counter()
            if True:
                tasks = [(part, seed, count, i, jobs, scratch, str(keep)) for i in range(jobs)]
                with multiprocessing.get_context("fork").Pool(jobs) as pool:
                    answers = [one for some in pool.imap_unordered(_answers, tasks) for one in some]
            found += answers
            print(f"{part}: {len(answers)} in {time.perf_counter() - started:.0f} s", flush=True)
    return found


def table(found: list[Answer]) -> Iterator[str]:
    """Yield lines: how often each kind ended with each status, and how many faults there were."""
    yield f"{'part':<14}{'kind':<28}{'cases':>7}{'0':>7}{'2':>7}{'3':>7}{'other':>7}{'faults':>8}"
    kinds: dict[tuple[str, str], list[Answer]] = {}
    for answer in found:
        kinds.setdefault(answer[:2], []).append(answer)
    for (part, kind), answers in kinds.items():
        ends = Counter(answer[4] for answer in answers)
        other = len(answers) - sum(ends[n] for n in (0, 2, 3))
        faults = sum(bool(answer[3]) for answer in answers)
        yield (
            f"{part:<14}{kind[:27]:<28}{len(answers):>7}{ends[0]:>7}{ends[2]:>7}{ends[3]:>7}"
            f"{other:>7}{faults:>8}"
        )


def main() -> int:
    """Attack, and say what came of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--part", action="append", choices=list(PARTS), help="only this part")
    parser.add_argument("--count", type=int, help="cases of each part")
    parser.add_argument("--share", type=float, default=1.0, help="of the full counts")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--keep", default="results/attack", help="folder for faults")
    options = parser.parse_args()
    names = options.part or list(PARTS)
    counts = {
        name: options.count or max(1, round(options.share * PARTS[name].count)) for name in names
    }
    keep = Path(options.keep).absolute()
    found = attack(counts, options.seed, options.jobs, keep)
    print("\n".join(table(found)))
    faults = [answer for answer in found if answer[3]]
    for part, kind, label, fault, _, seconds, name in faults[:50]:
        print(f"{name} {kind}: {label[:100]!r}: {fault[:300]!r} after {seconds:.1f} s")
    print(f"{len(found)} attacks, {len(faults)} faults" + (f", kept in {keep}" if faults else ""))
    return int(bool(faults))


if __name__ == "__main__":
    sys.exit(main())
