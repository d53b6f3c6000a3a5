"""The Moebius ribbon as peers take it, on 18 states or on 13: equations in CasADi, also as C.

18 states: x = (r, d1, d2, d3, n, m) of eq. (4.5). 13 states: x = (r, q, n, m0), position, unit
quaternion, force and moment at the start, of which the last six do not change; m = m0 + n x r.
Either way the last six at the start are n(0), m(0). The law is that of eq. (6.1), Sadowsky's where
epsilon is 0. Units Dw = L = 1. The half ribbon has the conditions of `configs/moebius_half.yaml`,
the whole one those of `configs/moebius_regularized.yaml`; all are conditions at one end, as COLNEW
wants them.
"""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np
from scipy.integrate import solve_ivp

NODES = 21
FORCE, MOMENT = (0.0, 40.0, 40.0), (0.0, 2.0, -9.0)
FLAGS = ("-O2", "-w", "-fno-math-errno")
# n(0), m(0): of the half ribbon 28 digits by a Taylor series; of the whole one, epsilon = 0.01, 21
# digits of the half-interval solution of the same law (tests/references.py).
HALF = [0, 43.4964080173984993703, 42.0522517129717208281]
HALF += [0, 2.00545099623122820984, -8.86920396209993570631]
WHOLE = [0, 43.0906492266307374351, 42.9691476231505101214]
WHOLE += [0, 2.14648365639864840470, -8.64714758544218312320]


@dataclass(frozen=True)
class Ribbon:
    """The half or the whole ribbon, on 13 or 18 states."""

    whole: bool
    states: int = 13

    @property
    def length(self) -> float:
        """Length of the piece that is solved for."""
        return 1.0 if self.whole else 0.5

    @property
    def epsilon(self) -> float:
        """Number of the law."""
        return 0.01 if self.whole else 0.0

    @property
    def moving(self) -> int:
        """States that change along s; those behind them are constants."""
        return 7 if self.states == 13 else 18

    @property
    def at_start(self) -> int:
        """Conditions at the start; the others are at the end."""
        return int(self.equations["start"].size1_out(0))

    @property
    def truth(self) -> list[float]:
        """Known n(0), m(0)."""
        return WHOLE if self.whole else HALF

    @property
    def equations(self) -> dict[str, ca.Function]:
        """Rates(x, epsilon), and start(x), end(x), which vanish; each with its Jacobian in x."""
        return _equations(self)

    def guess(self, epsilon: float | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Return s (21,) and x (21, states): loads integrated from the start, as all begin."""
        return _guess(self, self.epsilon if epsilon is None else epsilon)

    def guess_at(self, s: np.ndarray) -> np.ndarray:
        """States of the guess (len(s), states), linear between its nodes."""
        nodes, x = self.guess()
        return np.array([np.interp(s, nodes, values) for values in x.T]).T


@lru_cache
def _equations(ribbon: Ribbon) -> dict[str, ca.Function]:
    x, epsilon = ca.SX.sym("x", ribbon.states), ca.SX.sym("epsilon")
    reduced = ribbon.states == 13
    rates, start, end = (_reduced if reduced else _full)(x, epsilon, ribbon.whole)
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


def _strains(m2: ca.SX, m3: ca.SX, epsilon: ca.SX) -> tuple[ca.SX, ca.SX]:
    """u2 and u3 of eq. (6.1), with a division by M (1 + epsilon) less: no 0 / 0 at m2 = 0.

    For epsilon = 0 the sheet m2 > 0, on which the half ribbon lies: it ends at m2 = 0, where by
    rounding peers that look there would fall on the other one.
    """
    M, mu = ca.sqrt(m2**2 + m3**2), ca.if_else(epsilon > 0, ca.fabs(m2), m2)
    sign = ca.if_else(ca.logic_and(epsilon > 0, m2 < 0), -1, 1)
    share = ca.if_else(epsilon > 0, 2 * mu / (2 * mu + epsilon * (M + mu)), 1)
    return share * sign * (M + mu) ** 2 / (4 * M), m3 * (M + mu) / (4 * M)


def _full(x: ca.SX, epsilon: ca.SX, whole: bool) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Rates and conditions of the 18 states."""
    r, d1, d2, d3, n, m = ca.vertsplit(x, 3)
    u2, u3 = _strains(ca.dot(m, d2), ca.dot(m, d3), epsilon)
    u = u2 * d2 + u3 * d3
    turned = [ca.cross(u, d) for d in (d1, d2, d3)]
    rates = ca.vertcat(d3, *turned, ca.SX.zeros(3), ca.cross(n, d3))
    start = ca.vertcat(r, x[3:12] - ca.DM(np.eye(3).ravel()), n[0])
    if whole:
        end = ca.vertcat(r[1:], d1[1:], d2[2])  # turned by pi about d3
    else:
        start, end = ca.vertcat(start, m[0]), ca.vertcat(r[1:], d1[0], d3[0])
    return rates, start, end


def _reduced(x: ca.SX, epsilon: ca.SX, whole: bool) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Rates and conditions of the 13 states."""
    r, n, m0 = x[:3], x[7:10], x[10:]
    a, b, g, d = (x[k] for k in range(3, 7))
    d1 = ca.vertcat(a * a + b * b - g * g - d * d, 2 * (b * g + a * d), 2 * (b * d - a * g))
    d2 = ca.vertcat(2 * (b * g - a * d), a * a - b * b + g * g - d * d, 2 * (g * d + a * b))
    d3 = ca.vertcat(2 * (b * d + a * g), 2 * (g * d - a * b), a * a - b * b - g * g + d * d)
    m = m0 + ca.cross(n, r)
    u2, u3 = _strains(ca.dot(m, d2), ca.dot(m, d3), epsilon)
    dq = ca.vertcat(-g * u2 - d * u3, g * u3 - d * u2, a * u2 - b * u3, a * u3 + b * u2) / 2
    rates = ca.vertcat(d3, dq, ca.SX.zeros(6))
    start = ca.vertcat(r, a - 1, b, g, d, n[0])
    if whole:
        end = ca.vertcat(r[1:], a, b, g)  # turned by pi about d3
    else:
        start, end = ca.vertcat(start, m0[0]), ca.vertcat(r[1:], d1[0], d3[0])
    return rates, start, end


@lru_cache
def _guess(ribbon: Ribbon, epsilon: float) -> tuple[np.ndarray, np.ndarray]:
    s = np.linspace(0, ribbon.length, NODES)
    rates = ribbon.equations["rates"]
    turned = [1, 0, 0, 0] if ribbon.states == 13 else np.eye(3).ravel()
    first = np.array([0, 0, 0, *turned, *FORCE, *MOMENT], dtype=float)

    def slope(s: float, x: np.ndarray) -> Any:
        return np.array(rates(x, epsilon)).ravel()

    return s, solve_ivp(slope, (0, s[-1]), first, t_eval=s, rtol=1e-6).y.T


def write_source(folder: Path, ribbon: Ribbon) -> Path:
    """Write all functions as C: `name(const double**, double**, long long*, double*, int)`."""
    generator = ca.CodeGenerator("states.c")
    for function in ribbon.equations.values():
        generator.add(function)
    return Path(generator.generate(f"{folder}/"))


def write_guess(
    path: Path, ribbon: Ribbon, epsilon: float, scale: float = 1.0, x: np.ndarray | None = None
) -> None:
    """Write rows of the arc length, times a scale, and the states: x, or those of the guess."""
    s, states = ribbon.guess(epsilon)
    x = states if x is None else x
    np.savetxt(path, np.column_stack([scale * s, x]), fmt="%.17g")


def compile_with(compiler: str, sources: list[Path], program: Path, *more: str) -> None:
    """Compile and link a program; the compiler's words are in the error."""
    command = [compiler, *FLAGS, *map(str, sources), "-o", str(program), *more, "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}: {done.stderr[-1000:]}")
