"""The Moebius ribbon by COLNEW, compiled, with Jacobians, from the same start.

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
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from peer_states import Ribbon, compile_with, write_guess, write_source

HERE = Path(__file__).resolve().parent
Setting = tuple[int, int, float]  # stages, intervals of the first mesh, tolerance
EPSILONS = tuple(np.logspace(-1, -4, 21).tolist())  # of the branch


class Colnew:
    """The compiled program; `why` says why there is none."""

    def __init__(self, source: Path | None = None) -> None:
        """Compile it in a temporary folder; the loop around it is, where a ribbon is asked for."""
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
        self._object = self._folder / "colnew.o"
        command = ["gfortran", "-O2", "-std=legacy", "-w", "-c", str(given), "-o"]
        subprocess.run([*command, str(self._object)], check=True)

    def run(
        self,
        ribbon: Ribbon,
        setting: Setting,
        times: int,
        epsilons: Sequence[float] | None = None,
        guess: np.ndarray | None = None,
        patience: float | None = None,
    ) -> dict[str, Any]:
        """Solve so many times, for epsilons one after the other where these are given.

        From a guess (21, states), if one is given, instead of that of all peers.

        Returns the CPU seconds of one, n(0), m(0), intervals of the last mesh, and whether COLNEW
        says that it converged. TimeoutExpired after so many seconds of `patience`.
        """
        epsilons = [ribbon.epsilon] if epsilons is None else epsilons
        folder = self._program(ribbon)
        write_guess(folder / "guess", ribbon, epsilons[0], x=guess)
        fixed = 0.5 if ribbon.whole else 0
        command = [folder / "colnew", folder / "guess", ribbon.length, fixed]
        command += [*setting, times, *epsilons]
        done = subprocess.run(
            list(map(str, command)), capture_output=True, text=True, check=True, timeout=patience
        )
        rows = [list(map(float, line.split())) for line in done.stdout.splitlines()]
        return {
            "cpu_s": float(np.median([row[0] for row in rows])),
            "verified": all(row[1] == 1 for row in rows),
            "numbers": rows[-1][3:],
            "intervals": int(rows[-1][2]),
        }

    def _program(self, ribbon: Ribbon) -> Path:
        """Compile the loop for a ribbon, once."""
        folder = self._folder / f"{ribbon.whole}{ribbon.states}"
        if not folder.is_dir():
            folder.mkdir()
            numbers = (f"-DPEER_STATES={ribbon.states}", f"-DPEER_AT_START={ribbon.at_start}")
            sources = [HERE / "peer_colnew.c", write_source(folder, ribbon), self._object]
            compile_with("gcc", sources, folder / "colnew", *numbers, "-lgfortran")
        return folder


def main() -> None:
    """Solve by all settings and print what they cost."""
    from peer_settings import BRANCH, SETTINGS

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--source", type=Path, help="Netlib's colnew.f")
    parser.add_argument("--times", type=int, default=20)
    options = parser.parse_args()
    peer = Colnew(options.source)
    if peer.why:
        raise SystemExit(f"COLNEW is not run: {peer.why}")
    runs = {
        f"{ribbon}, {setting}": partial(peer.run, ribbon, setting, options.times)
        for ribbon, settings in SETTINGS["COLNEW"].items()
        for setting in settings
    }
    for states, setting in BRANCH["COLNEW"].items():
        ribbon = Ribbon(False, states)
        runs[f"branch on {states} states"] = partial(peer.run, ribbon, setting, 3, EPSILONS)
    for name, run in runs.items():
        found = run()
        print(f"{name}: {1e3 * found['cpu_s']:.3f} ms, {found['intervals']} intervals")
        print(f"    converged {found['verified']}, n(0), m(0) = {found['numbers']}")


if __name__ == "__main__":
    main()
