"""What loci and maps cost, in CPU time: a point of a locus beside a branch point and its location.

    python scripts/bench_maps.py [--repeat 3] [--map] [--out results/maps]

A branch is followed over its special point twice, by turns: with that point located, and without;
the difference is the location, which together with a point of the branch is what a point of a locus
is measured by (at most three times as much is asked). With `--map` the map of `configs/maps` is
made in a process of its own (at most 60 s are asked). Medians of CPU time; the loads of the machine
are told. Writes `bench_maps.json` and `bench_maps.png`.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

from ribbonopt.scene import Scene, load_scene
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import POINT

MAPS = Path(__file__).resolve().parent.parent / "configs" / "maps"
ASKED, MAP_ASKED = 3.0, 60.0


class Case(NamedTuple):
    """A scene of `configs/maps`, the range of a branch over its special point, the locus' goal."""

    scene: str
    branch: tuple[float, float]
    to: str
    scale: str = "linear"


CASES = {
    "fold, planar arch": Case("arch_fold", (20.0, 40.0), "[0.02, 0.5]", "log"),
    "branch point, planar arch": Case("arch_mirror", (25.0, 36.7), "[0.02, 0.5]", "log"),
    "branch point, sheared arch": Case("sheared_thresholds", (0.15, 0.3), "[0.1, 0.5]"),
}


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--map", action="store_true", help="make the map of the arch as well")
    parser.add_argument("--out", type=Path, default=Path("results") / "maps")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    load = [os.getloadavg()[0]]
    loci = {name: measured(name, case, options.repeat) for name, case in CASES.items()}
    result: dict[str, Any] = {"repeat": options.repeat, "asked": ASKED, "loci": loci}
    if options.map:
        result["map"] = whole_map()
    load.append(os.getloadavg()[0])
    result |= {"cpus": os.cpu_count(), "load_average": load}
    print(f"load average {load[0]:.2f} before, {load[1]:.2f} behind, on {os.cpu_count()} cores")
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "bench_maps.json").write_text(text, encoding="utf-8")
    draw(loci, options.out / "bench_maps.png")
    print(f"written: {options.out}: bench_maps.json, bench_maps.png")


def measured(name: str, case: Case, repeat: int) -> dict[str, Any]:
    """Measure a locus and its branch, by turns; the first, in which all is built, is left out."""
    path = str(MAPS / f"{case.scene}.yaml")
    low, high = case.branch
    parameter = load_scene(path).continuation
    first = parameter[0] if isinstance(parameter, tuple) else parameter
    assert first is not None
    moved = first.paths[0]
    plain = f"continuation={{parameter: {moved}, from: {low}, to: {high}, stability: false"
    located, without = (load_scene(path, [f"{plain}, special: {x}}}"]) for x in ("true", "false"))
    locus = load_scene(
        path,
        [
            f"continuation.to={case.to}",
            f"continuation.scale={case.scale}",
            "continuation.stability=false",
        ],
    )
    turns = []
    for _ in range(repeat + 1):
        a, b, c = followed(located), followed(without), followed(locus, of_locus=True)
        specials = a["points"] - a["ordinary"]
        location = max(a["cpu_s"] - b["cpu_s"], 0.0) / max(specials, 1)
        one = b["cpu_s"] / b["points"]
        turns.append((1e3 * one, 1e3 * location, 1e3 * c["cpu_s"] / c["points"], c["points"]))
    point, location, of_locus, points = (
        statistics.median(column) for column in zip(*(turns[1:] or turns), strict=True)
    )
    ratio = of_locus / (point + location)
    print(
        f"{name}: a point of the locus {of_locus:.0f} ms ({points:.0f} points), a point of the "
        f"branch {point:.0f} ms and its location {location:.0f} ms: ratio {ratio:.2f}",
        flush=True,
    )
    return {
        "point_ms": point,
        "location_ms": location,
        "locus_point_ms": of_locus,
        "locus_points": points,
        "ratio": ratio,
    }


def followed(scene: Scene, of_locus: bool = False) -> dict[str, Any]:
    """Follow a scene's stages: CPU seconds and points of what is asked, the start left out."""
    found = {"cpu_s": 0.0, "points": 0, "ordinary": 0}
    since, begun = time.process_time(), False
    for point in Continuation(scene):
        now = time.process_time()
        # The first point of a branch is solved from nothing, that of a locus located on slices.
        if begun and (not of_locus or point.row.get("of")):
            found["cpu_s"] += now - since
            found["points"] += 1
            found["ordinary"] += point.kind == POINT
        begun, since = True, time.process_time()
    return found


def whole_map() -> dict[str, Any]:
    """Make the map of the arch by the command, and return what it took."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "ribbonopt", "map", str(MAPS / "arch_map.yaml")]
        before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        ended = subprocess.run([*command, "--quiet", "--out", folder + "/map"], check=False)
        after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic() - start
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(
        f"map: {wall:.0f} s, {cpu:.0f} s of CPU (asked: {MAP_ASKED:g} s), exit {ended.returncode}"
    )
    return {"wall_s": wall, "cpu_s": cpu, "asked_s": MAP_ASKED, "exit": ended.returncode}


def draw(loci: dict[str, dict[str, Any]], path: Path) -> None:
    """Draw milliseconds: a point of each locus, and what it is measured by, three times."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 3.4), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for row, one in enumerate(loci.values()):
        told = row == 0
        axes.barh(
            row - 0.2,
            one["locus_point_ms"],
            0.36,
            color="#1f5fa8",
            label="a point of the locus" if told else None,
        )
        axes.barh(
            row + 0.2,
            one["point_ms"],
            0.36,
            color="#9a9a9a",
            label="a point of a branch" if told else None,
        )
        axes.barh(
            row + 0.2,
            one["location_ms"],
            0.36,
            left=one["point_ms"],
            color="#c0501a",
            label="and the location of its special point" if told else None,
        )
        axes.text(
            max(one["locus_point_ms"], one["point_ms"] + one["location_ms"]),
            row,
            f"  ratio {one['ratio']:.2f}",
            va="center",
            fontsize=9,
        )
    axes.set_yticks(range(len(loci)), list(loci))
    axes.set_ylim(len(loci) - 0.5, -0.5)
    axes.margins(x=0.25)
    axes.set(xlabel="CPU, milliseconds", title=f"Points of loci (asked: ratio at most {ASKED:g})")
    axes.grid(True, axis="x", alpha=0.3)
    figure.legend(loc="outside lower center", ncols=3, fontsize=9)
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
