"""Least energy of a smooth law: the first solve, which needs to know nothing of loads.

IPOPT on a coarse mesh, from a shape that need not even be a ribbon; force and moment follow from
the costates. A few elements of two stages are enough for most ribbons, at a third of the price;
where nothing is found on them, or nothing that leads on, it is done again on more. What is
prescribed of loads at the ends is left out here, unless a dead force has a potential; so are loads
along the ribbon that have none.
"""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.problem import Posed
from ribbonopt.scene import Collocation, Ipopt, Law

MESH = Collocation(scheme="gauss", degree=3, intervals=16)
SOLVER = Ipopt(tolerance=1e-6, max_iterations=120)
QUICK_MESH = Collocation(scheme="gauss", degree=2, intervals=12)
QUICK_SOLVER = Ipopt(tolerance=1e-6, max_iterations=60)


def least_energy_of(posed: Posed, law: Law, *, quick: bool = False) -> Posed:
    """Return a scene under a law with a smooth energy, as this solve wants it, `quick` or not."""
    mesh, solver = (QUICK_MESH, QUICK_SOLVER) if quick else (MESH, SOLVER)
    # In its plane a ribbon that nothing holds between its ends is the smaller problem.
    inside = posed.scene.states == "planar" and not (posed.stations or posed.scene.boundary.loop)
    states = "planar" if inside else "reduced"
    settings = {"formulation": "energy", "states": states, "solver": solver}
    found = posed.under(law=law, transcription=mesh, **settings)
    loads = tuple(load for load in found.loads if not load.without_potential)
    if not found.stations:
        return replace(found, loads=loads)
    from ribbonopt.mechanics.stations import conservative  # few scenes have any

    return replace(found, loads=loads, stations=conservative(found.stations))
