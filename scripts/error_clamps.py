"""One answer of `ribbonopt` beside the truth of `tests/independent`: true errors and bars.

Every quantity is a triple: true error, estimated error (None: not known), error of the truth.
All are absolute, vectors by their largest component, units Dw = L = 1.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.accuracy.recorded import recorded_errors
from ribbonopt.mechanics.rotations import matrix_of
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import (
    Boundary,
    Collocation,
    Directors,
    End,
    Law,
    Regularized,
    Sadowsky,
    Scene,
    Variational,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

sys.path.append(str(Path(__file__).resolve().parent.parent / "tests"))
import independent

Array = NDArray[np.float64]
Row = dict[str, Any]

LAWS: dict[str, Law] = {
    "sadowsky": Sadowsky(),
    "regularized": Regularized(epsilon=1e-3),
    "variational": Variational(delta=1e-2),
}
POINTS = 241
ELSEWHERE = 1e-3  # places and frames moved by more: another equilibrium
#: what is recorded, by what it is in the output of the truth
RECORDS: dict[str, tuple[str, int | None]] = {
    "dot(r, ex) at 0.5": ("r", 0),
    "dot(d1, ez) at 0.85": ("d1", 2),
    "m3 at 0.3": ("m3", None),
    "n1 at 0.6": ("n1", None),
    "u3 at 0.45": ("u3", None),
}


def clamps(rng: np.random.Generator) -> Scene:
    """Clamp a ribbon at both ends, the far one anywhere and turned at random."""
    turn = matrix_of(rng.normal(size=4)).T.tolist()
    distance, direction = rng.uniform(0.3, 0.95), rng.normal(size=3)
    place = (distance * direction / np.linalg.norm(direction)).tolist()
    return Scene(
        name="clamps",
        law=Variational(delta=0.01),
        boundary=Boundary(
            start=End(position=(0.0, 0.0, 0.0), directors="identity"),
            end=End(position=tuple(place), directors=Directors(*map(tuple, turn))),
        ),
        guess="auto",
        transcription=Collocation(scheme="gauss", degree=6, intervals=40),
    )


def cases(law: str, tolerance: float, seed: int, count: int) -> Iterator[tuple[int, Scene]]:
    """Yield number and scene of the random clamps: the same for every law and tolerance."""
    rng = np.random.default_rng(seed)
    for i in range(count):
        yield i, replace(clamps(rng), law=LAWS[law], tolerance=tolerance, record=dict(_recorded()))


def measured(prepared: Prepared, scene: Scene) -> Row:
    """Solve a scene from nothing and judge the answer."""
    started = time.process_time()
    found = prepared.solve(scene)
    row: Row = {"seconds": time.process_time() - started, "status": found.status.name}
    row |= {"message": found.message, "elements": len(found.nodes) - 1, "sheets": found.sheets}
    if not found.status.converged or found.status is Status.WRONG_SOLUTION:
        return row | {"verdict": "unsolved"}
    started = time.process_time()
    truth = truth_of(found)
    row |= {"verdict": truth.verdict, "reason": truth.reason, "moved": truth.moved}
    if truth.verdict == "found":
        if truth.moved > ELSEWHERE:
            row["verdict"] = "elsewhere"
        row["quantities"] = compared(found, truth)
    return row | {"truth_seconds": time.process_time() - started}


def truth_of(found: Solution) -> independent.Truth:
    """Return the equilibrium of the same law next to an answer between clamps."""
    law, end = found.scene.law, found.scene.boundary.end
    number = getattr(law, "epsilon", getattr(law, "delta", 0.0))
    assert isinstance(end.directors, Directors)
    frame = np.array([end.directors.d1, end.directors.d2, end.directors.d3])

    def start(s: Array) -> tuple[Array, Array]:
        out = found.outputs(s)
        return out["r"], np.stack([out["d1"], out["d2"], out["d3"]], axis=1)

    phases = found.sheets if isinstance(law, Sadowsky) else ()
    return independent.polish(
        independent.Law(law.type, number),
        *(found.n0, found.m0, start, (np.array(end.position), frame)),
        kinds=phases,
        switches=found.switch_points.tolist() if phases else (),
    )


def compared(found: Solution, truth: independent.Truth) -> dict[str, tuple[float, Any, float]]:
    """Return true error, bar and the truth's own error of every quantity."""
    try:
        bars = estimate_error(found)
        bars |= {
            text: bar
            for text, bar in zip(
                found.scene.record.values(), recorded_errors(found).values(), strict=True
            )
        }
    except np.linalg.LinAlgError:
        bars = {}
    path, coarse = truth.path, truth.coarse
    assert path is not None and coarse is not None
    s, away = places(found, path)
    ours, theirs, rough = found.outputs(s), path.at(s), coarse.at(s)
    values = {
        "n0": (found.n0, path.n, coarse.n),
        "m0": (found.m0, path.m0, coarse.m0),
        "u0": (found.u0, theirs["u"][0], rough["u"][0]),
        "H0": (found.start["H"], theirs["H"][0], rough["H"][0]),
        "energy": (found.energy, path.energy, coarse.energy),
        "states": tuple(
            np.stack([o[k] for k in ("r", "d1", "d2", "d3")]) for o in (ours, theirs, rough)
        ),
        "u": (ours["u"][away], theirs["u"][away], rough["u"][away]),
    }
    for text, (name, part) in RECORDS.items():
        formula, _, at = text.partition(" at ")
        point = np.array([float(at)])
        exact, other = (p.at(point)[name] for p in (path, coarse))
        pick = (0,) if part is None else (0, part)
        values[text] = (found.sample(float(at), formula), exact[pick], other[pick])
    return {
        name: (gap(a, b), number(bars.get(name)), gap(b, c)) for name, (a, b, c) in values.items()
    }


def places(found: Solution, path: independent.Path) -> tuple[Array, NDArray[np.bool_]]:
    """Arclengths to compare at, the first 0, and which of them are not beside a jump of u."""
    even = np.linspace(0, 1, POINTS)
    m2 = path.at(even)["m2"]
    at = np.flatnonzero(m2[1:] * m2[:-1] < 0)
    zeros = even[at] + (even[at + 1] - even[at]) * m2[at] / (m2[at] - m2[at + 1])
    near = np.concatenate([path.switches, found.switch_points, zeros])
    offsets = np.geomspace(1e-7, 1e-2, 26)
    sides = np.concatenate([offsets, -offsets])
    between = (found.nodes[1:] + found.nodes[:-1]) / 2
    s = np.concatenate([even, between, (near[:, None] + sides).ravel()])
    s = np.unique(np.clip(s, 0, 1))
    away = np.ones(len(s), bool)
    if path.law.name == "sadowsky":
        for a in path.switches:
            b = found.switch_points[np.abs(found.switch_points - a).argmin()]
            away &= np.abs(s - a) > 2 * np.abs(a - b) + 1e-12
    return s, away


def gap(a: Any, b: Any) -> float:
    """Largest difference of two arrays."""
    return float(np.abs(np.asarray(a) - np.asarray(b)).max())


def number(bar: float | None) -> float | None:
    """Return a bar, None where it is not known."""
    return None if bar is None or not np.isfinite(bar) else float(bar)


def _recorded() -> Iterator[tuple[str, str]]:
    for i, text in enumerate(RECORDS):
        yield f"q{i}", text
