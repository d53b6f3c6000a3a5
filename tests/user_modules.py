"""Modules that a user writes beside ribbonopt, as text: one thing each, in a file of its own.

Tests write them into a folder and import them from there; CONTRIBUTING.md shows them.
"""

import importlib
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

Import = Callable[[str], ModuleType]

ROD = '''
"""A linear rod that bends about all three axes, with natural strains k."""

from dataclasses import dataclass

import casadi as ca

from ribbonopt.mechanics.laws.law import ConstitutiveLaw


@dataclass(frozen=True)
class Rod:
    B1: float = 3.0
    B2: float = 1.0
    B3: float = 0.8
    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    type: str = "rod"

    def constitutive(self, numbers, position):
        return RodLaw(*(ca.vertcat(*(numbers[f"{x}{i}"] for i in (1, 2, 3))) for x in "Bk"))


@dataclass(frozen=True, eq=False)
class RodLaw(ConstitutiveLaw):
    B: ca.SX
    k: ca.SX
    components = (0, 1, 2)
    developable = False
    linear_at_zero = True
    natural = True

    def strain(self, stress):
        return stress.m / self.B + self.k

    def moment(self, u):
        return self.B * (u - self.k)

    def energy(self, u):
        return ca.dot(self.B, (u - self.k) ** 2) / 2

    def complementary_energy(self, stress):
        return ca.dot(stress.m, stress.m / self.B / 2 + self.k)
'''

TAPERED = '''
"""A linear rod whose width falls along it: w(s) = 1 - taper s."""

from dataclasses import dataclass

from ribbonopt.mechanics.laws.kirchhoff import KirchhoffLaw


@dataclass(frozen=True)
class Tapered:
    taper: float = 0.7
    type: str = "tapered"

    def constitutive(self, numbers, position):
        width = 1 - numbers["taper"] * position
        return KirchhoffLaw(width, width)
'''

WEIGHT = '''
"""Own weight of a ribbon whose width falls along it, towards -x."""

from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.mechanics.loads.load import DeadLoad


@dataclass(frozen=True)
class Weight(DeadLoad):
    size: float
    taper: float
    name = "loads.weight"

    def numbers(self):
        return {"loads.weight.size": self.size, "loads.weight.taper": self.taper}

    def force(self, section, theta):
        width = 1 - theta("loads.weight.taper") * section.s
        return ca.vertcat(-theta("loads.weight.size") * width, 0, 0)

    def total(self, s, theta):
        area = s - theta("loads.weight.taper") * s**2 / 2
        return ca.vertcat(-theta("loads.weight.size") * area, 0, 0)

    def symmetries(self, motions):
        changed = np.cross([1.0, 0, 0], motions[3:], axis=0)  # of its direction, by turns
        _, singular, right = np.linalg.svd(changed)
        return right[(singular > 1e-9).sum() :].T
'''

RELAXING = '''
"""A law with a state of its own along the ribbon, eta' = m2 - eta, that adds to the curvature."""

from dataclasses import dataclass

import casadi as ca

from ribbonopt.mechanics.laws.law import ConstitutiveLaw


@dataclass(frozen=True)
class Relaxing:
    gain: float = 0.1
    type: str = "relaxing"

    def constitutive(self, numbers, position):
        return RelaxingLaw(numbers["gain"])


@dataclass(frozen=True, eq=False)
class RelaxingLaw(ConstitutiveLaw):
    gain: ca.SX
    states = ("eta",)
    variational = False
    developable = False
    closed_moment = False

    def strain(self, stress):
        return ca.vertcat(0, stress.m[1] + self.gain * stress.own, stress.m[2] / 2)

    def rates(self, stress, u):
        return stress.m[1] - stress.own

    def end_conditions(self, end, stress):
        return {"eta = 0": stress.own} if end == "start" else {}

    def own_guess(self, stress):
        return stress.m[1]

    def moment(self, u):
        return ca.vertcat(u[1], 2 * u[2])  # for guesses only

    def energy(self, u):
        return None

    def complementary_energy(self, stress):
        return None
'''

PRESSURE = '''
"""Pressure on a ribbon: a force per length along d1, which follows it."""

from dataclasses import dataclass

import numpy as np

from ribbonopt.mechanics.loads.load import Load


@dataclass(frozen=True)
class Pressure(Load):
    p: float
    name = "loads.pressure"

    def numbers(self):
        return {"loads.pressure.p": self.p}

    def force(self, section, theta):
        return theta("loads.pressure.p") * section.d1

    def symmetries(self, motions):
        return np.eye(motions.shape[1])  # it follows every motion

    def level(self, r):
        return np.zeros(len(r))  # H itself is constant
'''

ROLLER = '''
"""A roller: it carries a load across its rail and nothing else."""

from ribbonopt.scene.supports import LoadVector, Position, Support

ROLLER = Support(
    "roller",
    "the lab component x of the position is held; no force along y and z, no moment",
    (Position("x"), LoadVector("force", "yz"), LoadVector("moment")),
)
'''

CENTRE_LINE = '''
"""The centre line as text."""

import numpy as np


class CentreLine:
    name, files = "centre line", ("centre.txt",)

    def write(self, solution, folder):
        s = np.linspace(*solution.scene.interval, 11)
        np.savetxt(folder / "centre.txt", solution.sample(s, "r"))
'''

LEFT_RADAU = '''
"""Radau collocation that begins at its first node: the mirror image of Radau IIA."""

from ribbonopt.transcription.tableaus import Tableau, radau


def left_radau(degree: int) -> Tableau:
    right = radau(degree)
    matrix = (right.weights - right.matrix)[::-1, ::-1]
    nodes, weights = 1 - right.nodes[::-1], right.weights[::-1]
    name = f"left radau {degree}"
    return Tableau(name, nodes, weights, matrix, right.order, False, left_radau)
'''

MODULES = {
    "rod": ROD,
    "tapered": TAPERED,
    "weight": WEIGHT,
    "relaxing": RELAXING,
    "pressure": PRESSURE,
    "roller": ROLLER,
    "centre_line": CENTRE_LINE,
    "left_radau": LEFT_RADAU,
}


def importer(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Import:
    """Return what writes one of these modules into a folder and imports it from there."""
    monkeypatch.syspath_prepend(folder)

    def module(name: str) -> ModuleType:
        own = f"my_{name}"
        (folder / f"{own}.py").write_text(MODULES[name], encoding="utf-8")
        importlib.invalidate_caches()
        monkeypatch.delitem(sys.modules, own, raising=False)
        return importlib.import_module(own)

    return module
