"""The Moebius ribbon on 13 states, as compiled peers take it: equations in CasADi, written as C.

x = (r, q, n, m0): position, unit quaternion, force and moment at the start, which do not change;
m = m0 + n x r. The law is that of eq. (6.1), Sadowsky's where epsilon is 0. Units Dw = L = 1. The
half ribbon has the conditions of `configs/moebius_half.yaml`, the whole one those of
`configs/moebius_regularized.yaml`; all are conditions at one end, as COLNEW wants them.
"""

from __future__ import annotations

import subprocess
from functools import lru_cache
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

STATES, NODES = 13, 21
FORCE, MOMENT = (0.0, 40.0, 40.0), (0.0, 2.0, -9.0)
FLAGS = ("-O2", "-w", "-fno-math-errno")


@lru_cache
def equations(whole: bool) -> dict[str, ca.Function]:
    """Return rates(x, epsilon), and start(x), end(x), which vanish; each with its Jacobian in x."""
    x, epsilon = ca.SX.sym("x", STATES), ca.SX.sym("epsilon")
    r, n, m0 = x[:3], x[7:10], x[10:]
    a, b, g, d = (x[k] for k in range(3, 7))
    d1 = ca.vertcat(a * a + b * b - g * g - d * d, 2 * (b * g + a * d), 2 * (b * d - a * g))
    d2 = ca.vertcat(2 * (b * g - a * d), a * a - b * b + g * g - d * d, 2 * (g * d + a * b))
    d3 = ca.vertcat(2 * (b * d + a * g), 2 * (g * d - a * b), a * a - b * b - g * g + d * d)
    m = m0 + ca.cross(n, r)
    m2, m3 = ca.dot(m, d2), ca.dot(m, d3)
    M, mu = ca.sqrt(m2**2 + m3**2), ca.fabs(m2)
    # A division by M (1 + epsilon) less than in (6.1): nothing is 0 / 0 at m2 = 0, epsilon = 0.
    sign = ca.if_else(m2 < 0, -1, 1)
    share = ca.if_else(epsilon > 0, 2 * mu / (2 * mu + epsilon * (M + mu)), 1)
    u2, u3 = share * sign * (M + mu) ** 2 / (4 * M), m3 * (M + mu) / (4 * M)
    dq = ca.vertcat(-g * u2 - d * u3, g * u3 - d * u2, a * u2 - b * u3, a * u3 + b * u2) / 2
    rates = ca.vertcat(d3, dq, ca.SX.zeros(6))
    start = ca.vertcat(r, a - 1, b, g, d, n[0])
    if whole:
        end = ca.vertcat(r[1:], a, b, g)  # turned by pi about d3
    else:
        start, end = ca.vertcat(start, m0[0]), ca.vertcat(r[1:], d1[0], d3[0])
    found = {}
    for name, unknowns, value in (
        ("rates", [x, epsilon], rates),
        ("start", [x], start),
        ("end", [x], end),
    ):
        found[name] = ca.Function(name, unknowns, [value])
        slopes = ca.densify(ca.jacobian(value, x))
        found[f"{name}_x"] = ca.Function(f"{name}_x", unknowns, [slopes])
    found["rates_epsilon"] = ca.Function(
        "rates_epsilon", [x, epsilon], [ca.densify(ca.jacobian(rates, epsilon))]
    )
    return found


def length(whole: bool) -> float:
    """Length of the piece that is solved for."""
    return 1.0 if whole else 0.5


@lru_cache
def guess(whole: bool, epsilon: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Return s (21,) and x (21, 13): the loads integrated from the start, as all peers start."""
    s = np.linspace(0, length(whole), NODES)
    rates = equations(whole)["rates"]
    first = np.array([0, 0, 0, 1, 0, 0, 0, *FORCE, *MOMENT], dtype=float)

    def slope(s: float, x: np.ndarray) -> Any:
        return np.array(rates(x, epsilon)).ravel()

    return s, solve_ivp(slope, (0, s[-1]), first, t_eval=s, rtol=1e-6).y.T


def write_source(folder: Path, whole: bool) -> Path:
    """Write all functions as C: `name(const double**, double**, long long*, double*, int)`."""
    generator = ca.CodeGenerator("states.c")
    for function in equations(whole).values():
        generator.add(function)
    return Path(generator.generate(f"{folder}/"))


def write_guess(path: Path, whole: bool, epsilon: float = 0.0, scale: float = 1.0) -> None:
    """Write rows of the arc length, times a scale, and the states."""
    s, x = guess(whole, epsilon)
    np.savetxt(path, np.column_stack([scale * s, x]), fmt="%.17g")


def compile_with(compiler: str, sources: list[Path], program: Path, *more: str) -> None:
    """Compile and link a program; the compiler's words are in the error."""
    command = [compiler, *FLAGS, *map(str, sources), "-o", str(program), *more, "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr[-1000:]}")
