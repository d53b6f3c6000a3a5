"""Least energy of a smooth law: the first solve, which needs to know nothing of loads.

IPOPT on a coarse mesh, from a shape that need not even be a ribbon; force and moment follow from
the costates. Two stages an interval are enough for a first equilibrium, at half the price of three
(200 random clamps: as many found, of the same energies). What is prescribed of loads at the ends is left out here, unless a dead force has a
potential; so are loads along the ribbon that have none.
"""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.problem import Posed
from ribbonopt.scene import Collocation, Ipopt, Law

MESH = Collocation(scheme="gauss", degree=2, intervals=16)
SOLVER = Ipopt(tolerance=1e-6, max_iterations=120)


def least_energy_of(posed: Posed, law: Law) -> Posed:
    """Return a scene under a law with a smooth energy, as this solve wants it."""
    settings = {"formulation": "energy", "states": "reduced", "solver": SOLVER}
    found = posed.under(law=law, transcription=MESH, **settings)
    loads = tuple(load for load in found.loads if not load.without_potential)
    if not found.stations:
        return replace(found, loads=loads)
    from ribbonopt.mechanics.stations import conservative  # few scenes have any

    return replace(found, loads=loads, stations=conservative(found.stations))
