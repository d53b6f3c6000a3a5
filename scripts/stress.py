"""All shipped scenes under stress, and every verified answer integrated again by another program.

    python scripts/stress.py [--quick] [--only KIND] [--out results/stress] [--jobs 2] [SCENE ...]

A process for each scene: one that hangs or crashes takes nothing with it. Beside the judgement of
`ribbonopt stress` every verified answer goes through `tests/independent/confirm.py`, which shares
nothing with the package, where that knows the law. Writes a JSON for each scene, all of them as
`stress.json` and `stress.md`, and `stress.png`; exits with 3 if anything is wrong.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("configs", "configs/paper", "configs/shear")
NO_SCENES = ("thresholds",)  # studies among them
HANGS = 3600.0  # seconds of a scene, by the clock
#: gap of an integration, over the relative bar of the answer, and the least that says something:
#: places between the nodes count there, of which no bar is told
GAP, LEAST = 10.0, 1e-8


def main() -> int:
    """Run all scenes, print the table, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "scenes", nargs="*", type=Path, metavar="SCENE", help="default: all shipped"
    )
    parser.add_argument("--out", type=Path, default=Path("results") / "stress")
    parser.add_argument("--only", action="append", metavar="KIND", help="may be repeated")
    parser.add_argument("--quick", action="store_true", help="a few values of each kind")
    parser.add_argument("--jobs", type=int, default=2, help="scenes at once")
    parser.add_argument("--seconds", type=float, default=20.0, help="of the processor, for a trial")
    parser.add_argument("--resume", action="store_true", help="keep the scenes that are done")
    parser.add_argument("--one", type=Path, metavar="FILE", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        one(options)
        return 0
    options.out.mkdir(parents=True, exist_ok=True)
    scenes = options.scenes or shipped()
    with ThreadPoolExecutor(options.jobs) as pool:
        found = list(pool.map(lambda path: apart(path, options), scenes))
    report(found, options.out)
    return (
        3 if any(row["verdict"] in ("wrong", "crashed") for s in found for row in s["rows"]) else 0
    )


def shipped() -> list[Path]:
    """Return all scenes that come with the package."""
    paths = [path for folder in FOLDERS for path in sorted((ROOT / folder).glob("*.yaml"))]
    return [path for path in paths if path.stem not in NO_SCENES]


def named(path: Path) -> str:
    """Return the name of a scene's file: scenes of several folders may have the same name."""
    folder = path.resolve().parent.name
    return path.stem if folder == "configs" else f"{folder}-{path.stem}"


def apart(path: Path, options: argparse.Namespace) -> dict[str, Any]:
    """Put one scene under stress in a process of its own, and return what it wrote."""
    kept = options.out / f"{named(path)}.json"
    if not (options.resume and kept.exists()):
        kept.unlink(missing_ok=True)
        command = [sys.executable, __file__, str(path), "--one", str(kept)]
        command += ["--seconds", str(options.seconds)] + ["--quick"] * options.quick
        command += [word for kind in options.only or () for word in ("--only", kind)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=HANGS)
            end, said = f"exit status {done.returncode}", done.stdout
        except subprocess.TimeoutExpired as error:
            end, said = f"no end after {HANGS:g} s", (error.stdout or b"").decode()
        if not kept.exists():
            last = said.strip().splitlines()[-1:] or ["nothing begun"]
            kind, _, value = last[0].partition(": ")
            row = {"kind": kind, "value": value, "label": value, "verdict": "crashed"}
            lost = dict.fromkeys(("digits_lost", "error", "over_bars", "condition", "intervals"))
            row |= lost | {"cpu": 0.0, "status": "lost", "message": end}
            text = {"name": named(path), "truth": "", "rows": [row], "not_applicable": {}}
            kept.write_text(json.dumps(text, indent=2) + "\n")
    found: dict[str, Any] = json.loads(kept.read_text())
    rows = found["rows"]
    bad = [row for row in rows if row["verdict"] in ("wrong", "crashed")]
    print(f"{named(path):<24} {len(rows):4} trials, {len(bad)} wrong or crashed", flush=True)
    return found | {"scene": named(path)}


def one(options: argparse.Namespace) -> None:
    """Put one scene under stress here, and write what came of it."""
    from ribbonopt.plain import json_text
    from ribbonopt.scene import load_scene
    from ribbonopt.studies.stress.stress import stress

    sys.path.insert(0, str(ROOT / "tests"))
    study = stress(
        load_scene(options.scenes[0]),
        options.only,
        options.quick,
        options.seconds,
        tell=lambda text: print(text, flush=True),
        examine=examined,
    )
    options.one.write_text(json_text(study.plain()))


def examined(solution: Any) -> str | None:
    """Why a solution is no equilibrium, by integrating it anew; None where that is not known."""
    from independent.confirm import examine

    from ribbonopt.accuracy.estimate import relative_error
    from ribbonopt.output.summary import bars_of

    if any(bar is None or bar != bar for bar in bars_of(solution).values()):
        return None
    allowed = max(LEAST, GAP * relative_error(solution)[0])
    try:
        found = examine(solution)
    except ValueError:  # what it does not know
        return None
    if found.worst <= allowed:
        return ""
    return f"integrated anew it is off by {found.worst:.1e} at {found.where}, {allowed:.0e} allowed"


def report(found: list[dict[str, Any]], out: Path) -> None:
    """Write all scenes as one JSON, a table and a figure, and print what is to be looked at."""
    from ribbonopt.studies.stress.verdict import Verdict
    from ribbonopt.views.stress import save_figure

    rows = [{"scene": one["scene"], **row} for one in found for row in one["rows"]]
    words = [verdict.value for verdict in Verdict]
    study = {"name": "all shipped scenes", "scenes": len(found), "rows": rows}
    (out / "stress.json").write_text(json.dumps(study, indent=1) + "\n")
    lines = [f"| kind | trials | {' | '.join(words)} |", "|---|" + "---:|" * (1 + len(words))]
    for kind in (*dict.fromkeys(row["kind"] for row in rows), "all"):
        some = [row for row in rows if kind in ("all", row["kind"])]
        counts = [sum(row["verdict"] == word for row in some) for word in words]
        lines.append(f"| {kind} | {len(some)} | {' | '.join(map(str, counts))} |")
    (out / "stress.md").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    for row in rows:
        if row["verdict"] in ("wrong", "crashed", "unconfirmed"):
            print(
                f"{row['verdict']}: {row['scene']}, {row['kind']}, {row['value']}: {row['message']}"
            )
    save_figure(study, out / "stress.png")


if __name__ == "__main__":
    sys.exit(main())
