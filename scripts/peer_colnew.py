"""The Moebius ribbon by COLNEW, compiled, on 13 states with Jacobians, from the same start.

    python scripts/peer_colnew.py --source colnew.f [--times 20]

COLNEW is a Fortran file of Netlib (`ode/colnew.f`, Ascher and Bader), which is not part of this
project; `--source`, or the variable COLNEW_SOURCE, says where it is. gcc and gfortran are needed.
What it is to solve is in `peer_states.py`, the loop around it in `peer_colnew.c`. The whole ribbon
has s = 1/2, where its law has a kink, as a fixed point of the mesh.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import peer_states
from peer_states import compile_with, length, write_guess, write_source

HERE = Path(__file__).resolve().parent
# name: whole, epsilons, stages, intervals of the first mesh, tolerance
CASES: dict[str, tuple[bool, list[float], int, int, float]] = {
    "half 1e-6": (False, [0.0], 4, 4, 1e-4),
    "half 1e-9": (False, [0.0], 5, 2, 1e-6),
    "half 1e-12": (False, [0.0], 7, 4, 1e-4),
    "whole 1e-9": (True, [0.01], 5, 8, 1e-8),
    "branch": (False, np.logspace(-1, -4, 21).tolist(), 7, 8, 1e-8),
}


class Colnew:
    """The compiled program; `why` says why there is none."""

    def __init__(self, source: Path | None = None) -> None:
        """Compile it in a temporary folder, once for the half and once for the whole ribbon."""
        given = source or Path(os.environ.get("COLNEW_SOURCE", "colnew.f"))
        self.why = ""
        if not given.is_file():
            self.why = f"no {given}: say by COLNEW_SOURCE where Netlib's colnew.f is"
        elif not (shutil.which("gfortran") and shutil.which("gcc")):
            self.why = "gcc and gfortran are needed"
        if self.why:
            return
        self._kept = TemporaryDirectory()
        self._folder = Path(self._kept.name)
        legacy = self._folder / "colnew.o"
        command = ["gfortran", "-O2", "-std=legacy", "-w", "-c", str(given), "-o", str(legacy)]
        subprocess.run(command, check=True)
        for whole in (False, True):
            folder = self._folder / str(whole)
            folder.mkdir()
            sources = [HERE / "peer_colnew.c", write_source(folder, whole), legacy]
            compile_with("gcc", sources, folder / "colnew", "-lgfortran")

    def solve(self, name: str, times: int, turn: int = 0) -> dict[str, Any]:
        """Solve a case so many times: CPU seconds of one, n(0), m(0), intervals at the end."""
        return self.run(*CASES[name], times)

    def run(
        self,
        whole: bool,
        epsilons: list[float],
        stages: int,
        intervals: int,
        tolerance: float,
        times: int,
    ) -> dict[str, Any]:
        """Solve for epsilons one after the other, so many times."""
        folder = self._folder / str(whole)
        write_guess(folder / "guess", whole, epsilons[0])
        command = [folder / "colnew", folder / "guess", length(whole), 0.5 if whole else 0]
        command += [stages, intervals, tolerance, times, *epsilons]
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True)
        rows = [list(map(float, line.split())) for line in done.stdout.splitlines()]
        return {
            "cpu_s": float(np.mean([row[0] for row in rows])),
            "verified": all(row[1] == 1 for row in rows),
            "numbers": rows[-1][3:],
            "intervals": int(rows[-1][2]),
        }


def main() -> None:
    """Solve all cases and print what they cost."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--source", type=Path, help="Netlib's colnew.f")
    parser.add_argument("--times", type=int, default=20)
    options = parser.parse_args()
    peer = Colnew(options.source)
    if peer.why:
        raise SystemExit(f"COLNEW is not run: {peer.why}")
    for name in CASES:
        found = peer.solve(name, options.times)
        print(f"{name}: {1e3 * found['cpu_s']:.3f} ms, {found['intervals']} intervals")
        print(f"    converged {found['verified']}, n(0), m(0) = {found['numbers']}")


assert peer_states.STATES == 13  # as in peer_colnew.c

if __name__ == "__main__":
    main()
