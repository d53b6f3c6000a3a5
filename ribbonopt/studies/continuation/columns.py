"""Columns of every branch, in words: what `branch.jsonl` and `branch.csv` hold of each point."""

from __future__ import annotations

from collections.abc import Mapping

COLUMNS: Mapping[str, str] = {
    "number": "place among all points, from 0; figures call points by it",
    "stage": "stage of the continuation, from 0",
    "branch": "0: where the stage begins; 1, 2, ...: branches that cross, each way of each",
    "origin": "number of the point where its branch leaves another",
    "parameter": "path of the number that the stage moves",
    "PATH": "one column for each number that a stage moves, under its own path (law.epsilon, "
    "parameters.angle): its value at the point, in stages that do not move it too",
    "kind": "point, fold, branch point, buckling point or kink; on loci point, cusp, isola centre, "
    "crossing, double point or turn",
    "of": "kind of the special points that a locus is of; empty on branches",
    "negative": "negative directions of the second variation, 0: stable; empty: not known",
    "error": "bound of the relative error of the answer; of the place of a special point, relative "
    "to the parameter there; on loci of the first parameter, at the second (where that turns, of "
    "their distance from the curve); empty: not known",
    "softest": "smallest eigenvalue of the second variation, where `stability: eigenvalue` asks",
    "frequency1": "lowest natural frequency, where `modes` asks, and so on: in Hz, or "
    "sqrt(Dw/(rho L^4)); negative: a rate of growth",
    "squared1": "its omega^2, and so on, in (rad/s)^2 or Dw/(rho L^4); negative: unstable",
    "energy": "energy of the whole ribbon",
    "potential": "energy less the work of dead loads; empty: some load has no potential",
    "H0": "H = W_Leg + n3 at the start, constant without dead loads",
    "n0x, n0y, n0z": "force at the start, lab frame",
    "m0x, m0y, m0z": "moment at the start, lab frame",
    "u1, u2, u3": "strains at the start, along the directors",
    "NAME": "one column for each name under `record`",
    "switches": "arclengths where phases meet",
    "intervals": "elements of the mesh",
    "iterations": "of the last solve",
    "note": "what is to be told of the point; figures mark it",
}

HINT = (
    "Conditions of `stop` and X:Y of --plot take any of these that is a number; `angle` stands for "
    "parameters.angle, and `value` for the number that the stage moves."
)
