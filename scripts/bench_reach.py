"""How far solves from nothing reach: helices and mixtures, bands of many half twists, wound clamps.

    python scripts/bench_reach.py [--out results/bench_reach] [--helices 60] [--most 9]

Helices of Sadowsky's law (half of them mixtures, |u2| < |u3|; up to two turns in all) are clamped
at both ends: found from nothing if verified with no more energy than the helix, from its strains as
guess if it is the helix itself. Bands are those of -most ... most half twists without 0, by three
laws: found if verified, which counts the half twists. Wound clamps: torque of a straight ribbon,
and turns counted at 0.9 of its length. Everything is seeded; times are CPU times of whole solves,
failures included. Writes `bench_reach.json`.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from scipy.linalg import expm

from ribbonopt.errors import RibbonoptError
from ribbonopt.output.summary import versions
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import (
    AnyVector,
    Boundary,
    Directors,
    End,
    Kirchhoff,
    LabVector,
    Law,
    Loop,
    Regularized,
    RotationVector,
    Sadowsky,
    Scene,
    StrainGuess,
    Variational,
)
from ribbonopt.studies.machine import machine

LAWS: dict[str, Law] = {
    "sadowsky": Sadowsky(),
    "regularized 1e-3": Regularized(epsilon=1e-3),
    "variational 1e-2": Variational(delta=1e-2),
}
STIFFNESS = {"kirchhoff": 2.0, "sadowsky": 4.0}
TOLERANCE, SPARE = 1e-8, 2e-8
PULL = 200.0
ORIGIN = End(position=(0.0, 0.0, 0.0), directors="identity")
Row = dict[str, Any]


def main() -> None:
    """Run all parts, print the table, write JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench_reach")
    parser.add_argument("--helices", type=int, default=60)
    parser.add_argument("--most", type=int, default=9, help="half twists")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows = [*helices(options.helices), *bands(options.most), *wound()]
    report(rows)
    result = {"machine": machine(), "versions": versions(), "rows": rows}
    (options.out / "bench_reach.json").write_text(json.dumps(result, indent=2) + "\n")
    print(f"written: {options.out / 'bench_reach.json'}")


def helices(count: int) -> list[Row]:
    """Clamp random helices, from nothing and from their strains."""
    rng, rows = np.random.default_rng(7), []
    for i in range(count):
        angle, side = rng.uniform(0.1 * np.pi, 4 * np.pi), rng.uniform(0, 2 * np.pi)
        u2, u3 = float(angle * np.cos(side)), float(angle * np.sin(side))
        if (abs(u2) < abs(u3)) != (i % 2 == 0):
            u2, u3 = u3, u2
        mixture = abs(u2) < abs(u3)
        energy = 2 * u3**2 if mixture else (u2**2 + u3**2) ** 2 / (2 * u2**2)
        kind = "mixtures" if mixture else "helices of one sheet"
        place, frame = end_of(u2, u3)
        directors = Directors(*(tuple(column) for column in frame.T.tolist()))
        boundary = Boundary(ORIGIN, End(position=tuple(place.tolist()), directors=directors))
        for guess in ("auto", StrainGuess((u2, u3))):
            scene = Scene("helix", Sadowsky(), boundary, guess=guess, tolerance=TOLERANCE)
            known = guess != "auto"
            part = f"{kind}, {'their strains known' if known else 'from nothing'}"
            row, _ = solved(part, scene)
            over = row["energy"] / energy - 1
            good = abs(over) <= SPARE if known else over <= SPARE
            row |= {"u": (u2, u3), "over": over, "found": row["verified"] and bool(good)}
            rows.append(row)
    return rows


def end_of(u2: float, u3: float) -> tuple[np.ndarray, np.ndarray]:
    """Position and frame at s = 1 of constant strains from the lab axes."""
    twist = np.zeros((4, 4))
    twist[:3, :3] = [[0, -u3, u2], [u3, 0, 0], [-u2, 0, 0]]
    twist[2, 3] = 1
    placed = expm(twist)
    return placed[:3, 3], placed[:3, :3]


def bands(most: int) -> list[Row]:
    """Whole bands of all numbers of half twists up to `most`."""
    rows = []
    for name, law in LAWS.items():
        for half_twists in (k for k in range(-most, most + 1) if k):
            boundary = Boundary(loop=Loop(half_twists))
            row, _ = solved(f"bands, {name}", Scene("band", law, boundary, tolerance=TOLERANCE))
            rows.append(row | {"half_twists": half_twists, "found": row["verified"]})
    return rows


def wound() -> list[Row]:
    """Turn ends often: pulled straight, and clamped nearer than the length."""
    rows = []
    laws: dict[str, Law] = {"kirchhoff": Kirchhoff(B2=1, B3=2), "sadowsky": Sadowsky()}
    for name, law in laws.items():
        for turns in (0.5, 1, 1.5, -1.5, 2, 2.3, 2.5, 3):
            turn = RotationVector((0.0, 0.0, 2 * np.pi * turns))
            end = End(position=LabVector(x=0, y=0), directors=turn, force=AnyVector(z=PULL))
            scene = Scene("pulled", law, Boundary(ORIGIN, end), tolerance=TOLERANCE)
            row, found = solved(f"pulled straight, {name}", scene)
            torque = STIFFNESS[name] * 2 * np.pi * turns
            off = np.inf if found is None else abs(found.m0[2] / torque - 1)
            rows.append(row | {"turns": turns, "found": row["verified"] and bool(off < SPARE)})
        for turns in (0.75, 1, 1.5, -1.5):
            turn = RotationVector((0.0, 0.0, 2 * np.pi * turns))
            end = End(position=(0.0, 0.0, 0.9), directors=turn)
            scene = Scene("held", law, Boundary(ORIGIN, end), tolerance=TOLERANCE)
            row, found = solved(f"held at 0.9, {name}", scene)
            kept = found is not None and not found.given_up
            rows.append(row | {"turns": turns, "found": row["verified"] and kept})
    return rows


def solved(part: str, scene: Scene) -> tuple[Row, Any]:
    """Solve a scene; return its row and the solution, if any."""
    started = time.process_time()
    try:
        found = solve(scene)
    except RibbonoptError as error:
        seconds, message = time.process_time() - started, str(error)
        row = {"energy": float("inf"), "verified": False, "status": "none", "message": message}
        return {"part": part, **row, "seconds": seconds}, None
    return {
        "part": part,
        "energy": found.energy,
        "verified": found.verified,
        "status": found.status.name.lower(),
        "message": found.message,
        "phases": list(found.sheets),
        "seconds": time.process_time() - started,
    }, found


def report(rows: list[Row]) -> None:
    """Print a line for each part, and its failures."""
    print(f"{'':<42}  found          CPU: median      95 %")
    for part in dict.fromkeys(row["part"] for row in rows):
        own = [row for row in rows if row["part"] == part]
        good = [row for row in own if row["found"]]
        median, most = np.quantile([row["seconds"] for row in own], [0.5, 0.95])
        share = 100 * len(good) / len(own)
        times = f"{median:8.2f} s {most:8.2f} s"
        print(f"{part:<42} {len(good):3d} of {len(own):2d} ({share:3.0f} %) {times}")
        for row in own:
            if not row["found"]:
                where = row.get("u") or row.get("half_twists") or row.get("turns")
                print(f"    {where}: {row['status']}, energy {row['energy']:.6g}")


if __name__ == "__main__":
    main()
