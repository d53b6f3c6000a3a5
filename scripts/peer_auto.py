"""The Moebius ribbon by AUTO-07p with Jacobians, and the branch of its half in epsilon.

    python scripts/peer_auto.py [--times 5]

AUTO (Debian's package `auto-07p`, with gcc and gfortran) is run where it is installed, under
/usr/lib/auto-07p or where AUTO_DIR says. What it is to solve is in `peer_states.py`, its equations
file `peer_auto.c`. AUTO continues, so that it comes from the loads that all peers start from, whose
integrated shape misses the end, to the solution by a parameter that closes the gap; then, if asked,
along log10(epsilon) from -1 to -4. What is timed is the CPU of its processes, which is what it
costs its users.
"""

from __future__ import annotations

import argparse
import math
import os
import resource
import shutil
import subprocess
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from peer_states import Ribbon, compile_with, write_guess, write_source

HERE = Path(__file__).resolve().parent
Setting = tuple[int, int, float, int]  # intervals, stages, tolerance, steps to the closed end
LAST = -4.0  # log10(epsilon) at the end of the branch
CONSTANTS = """\
NDIM={states}, NBC={states}, NINT=0, IPS=4, ILP=0, ISP=0, ISW=1, IPLT=0, IID=0, NPAR=3, JAC=1
NTST={intervals}, NCOL={stages}, IAD={adapted}, NPR=0, MXBF=0
EPSL={tolerance}, EPSU={tolerance}, ITMX=8, ITNW=9, NWTN=9, DSMIN=1e-6, DSMAX=2, IADS=0
THU={{{weights}}}
"""
# Steps of the parameter alone (no state has weight), so that it ends where it should.
FIRST = "dat='guess', IRS=0, ICP=[1], DS={step:.17g}, NMX={points}\n"
SECOND = "s='closed', IRS={label}, ICP=[2], DS={step:.17g}, NMX={points}\n"
STEPS = 20  # of the branch
LONGER = 1 + 1e-7  # what AUTO makes of a step where the states have no weight


class Auto:
    """The compiled equations; `why` says why there are none."""

    def __init__(self) -> None:
        """Look for AUTO and its compilers."""
        self._home = Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p"))
        self.why = ""
        if not (self._home / "lib" / "libauto_c.a").is_file():
            self.why = f"no lib/libauto_c.a in {self._home}: install auto-07p, or say AUTO_DIR"
        elif not (shutil.which("gfortran") and shutil.which("gcc")):
            self.why = "gcc and gfortran are needed"
        self._kept = TemporaryDirectory()
        self._programs: dict[tuple[Ribbon, float], Path] = {}

    def run(
        self, ribbon: Ribbon, setting: Setting, times: int, first: float | None = None
    ) -> dict[str, Any]:
        """Solve so many times; from an epsilon, its logarithm given, follow the branch to LAST.

        Returns the CPU seconds of one, n(0), m(0), and the number of points. RuntimeError where
        AUTO does not get there.
        """
        last = None if first is None else LAST
        if first is None:
            first = math.log10(ribbon.epsilon) if ribbon.epsilon else -99.0
        intervals, stages, tolerance, closing = setting
        folder = self._program(ribbon, first)
        constants = CONSTANTS.format(
            states=ribbon.states,
            intervals=intervals,
            stages=stages,
            tolerance=tolerance,
            adapted=1 if last is not None or closing > 1 else 0,
            weights=", ".join(f"{k + 1}: 0.0" for k in range(ribbon.states)),
        )
        first_run = FIRST.format(step=1 / closing / LONGER, points=closing + 1)
        used = _seconds()
        for _ in range(times):
            label, numbers, points = self._continued(ribbon, folder, constants + first_run)
            if last is not None:
                shutil.move(folder / "fort.8", folder / "s.closed")
                step = (last - first) / STEPS / LONGER
                second = SECOND.format(label=label, step=step, points=STEPS + 1)
                _, numbers, points = self._continued(ribbon, folder, constants + second)
        return {"cpu_s": (_seconds() - used) / times, "numbers": numbers, "points": points}

    def _continued(
        self, ribbon: Ribbon, folder: Path, constants: str
    ) -> tuple[int, list[float], int]:
        """Run AUTO: label, n(0), m(0) of the last solution, and the number of points."""
        for old in folder.glob("fort.*"):
            old.unlink()
        done = subprocess.run(
            [str(folder / "auto")],
            input=constants,
            cwd=folder,
            capture_output=True,
            text=True,
            env=os.environ | {"OMP_NUM_THREADS": "1"},  # threads that wait cost CPU
        )
        try:
            rows = [line.split() for line in (folder / "fort.7").read_text().splitlines()]
        except OSError:
            raise RuntimeError(f"AUTO says: {done.stdout[-500:]} {done.stderr[-500:]}") from None
        rows = [row for row in rows if row[0] != "0"]
        if not rows or rows[-1][2] != "9":  # the type of a regular end
            raise RuntimeError(f"AUTO did not get there: {done.stdout[-1500:]}")
        first = _first_state(folder / "fort.8", ribbon.states)
        return int(rows[-1][3]), first[-6:], len(rows)

    def _program(self, ribbon: Ribbon, log_epsilon: float) -> Path:
        key = ribbon, log_epsilon
        if key not in self._programs:
            folder = Path(self._kept.name) / str(len(self._programs))
            folder.mkdir()
            epsilon = 0.0 if log_epsilon < -50 else 10**log_epsilon
            _, x = ribbon.guess(epsilon)
            missed = np.array(ribbon.equations["end"](x[-1])).ravel()
            write_guess(folder / "guess.dat", ribbon, epsilon, 1 / ribbon.length)
            library = self._home / "lib"
            compile_with(
                "gcc",
                [HERE / "peer_auto.c", write_source(folder, ribbon)],
                folder / "auto",
                f"-DPEER_MISSED={','.join(f'{v:.17g}' for v in missed)}",
                f"-DPEER_AT_END={len(missed)}",
                f"-DPEER_STATES={ribbon.states}",
                f"-DPEER_LOG_EPSILON={log_epsilon}",
                f"-DPEER_LENGTH={ribbon.length}",
                *sorted(str(path) for path in library.glob("*.o")),
                str(library / "libauto_c.a"),
                *("-lgfortran", "-lgomp"),
            )
            self._programs[key] = folder
        return self._programs[key]


def _first_state(path: Path, states: int) -> list[float]:
    """States at the start of the last solution of an AUTO file."""
    lines = path.read_text().splitlines()
    at, head = 0, 0
    while at < len(lines):
        head = at
        at += int(lines[at].split()[8]) + 1  # lines of this solution
    words = " ".join(lines[head + 1 : head + 5]).split()  # the arc length, then the states
    return [float(word) for word in words[1 : states + 1]]


def _seconds() -> float:
    """CPU of the processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Solve by all settings and print what they cost."""
    from peer_settings import BRANCH, SETTINGS

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, default=5)
    options = parser.parse_args()
    peer = Auto()
    if peer.why:
        raise SystemExit(f"AUTO is not run: {peer.why}")
    runs = {
        f"{ribbon}, {setting}": partial(peer.run, ribbon, setting, options.times)
        for ribbon, settings in SETTINGS["AUTO"].items()
        for setting in settings
    }
    for states, setting in BRANCH["AUTO"].items():
        ribbon = Ribbon(False, states)
        runs[f"branch on {states} states"] = partial(peer.run, ribbon, setting, 3, -1.0)
    for name, run in runs.items():
        found = run()
        print(f"{name}: {1e3 * found['cpu_s']:.2f} ms, {found['points']} points")
        print(f"    n(0), m(0) = {found['numbers']}")


if __name__ == "__main__":
    main()
