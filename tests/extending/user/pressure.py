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
