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
