"""What it would save to leave positions out where no condition reads r and n is zero: a prototype.

Part of `bench_skips.py`. A ribbon clamped at its start under a moment at its end (end_moment.yaml):
n = 0, m is constant, so that the quaternion q and the moment are a problem of their own (4 + 3
unknowns, not 7 + 6), and r is the integral of d3 behind it. Both are solved by the same scheme on
the same mesh from the same start; positions of both must agree.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import casadi as ca
import numpy as np

from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.mechanics.orientation import UnitQuaternion
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem.contract import BoundaryValueProblem, Phase
from ribbonopt.scene import load_scene
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.transcription import CollocationMethod, Mesh
from ribbonopt.transcription.buffered import Mapped

SCENE = Path(__file__).resolve().parent.parent / "configs" / "end_moment.yaml"


def without_positions(prepared: Prepared) -> BoundaryValueProblem:
    """Return the problem of q and m alone; the moment at the end is that of the scene."""
    ribbon, frame = prepared.ribbon, UnitQuaternion()
    q, m = ca.SX.sym("q", 4), ca.SX.sym("m", 3)
    d = frame.directors(q)
    along = ca.vertcat(*(ca.dot(m, one) for one in d))
    u = ribbon.law.strain(Stress(ca.SX.zeros(3), along, ca.SX(0, 1)))
    start, end = ca.SX.sym("start", 4), ca.SX.sym("end", 4)
    asked = [ribbon.theta[f"boundary.end.moment.{axis}"] for axis in "xyz"]
    conditions = {f"q{i}": start[i] - float(i == 0) for i in range(4)}
    conditions |= {f"m{axis}": m[i] - asked[i] for i, axis in enumerate("xyz")}
    phase = Phase(
        dynamics=frame.rates(q, u),
        length=ribbon.interval[1] - ribbon.interval[0],
        outputs={"d3": d[2]},
    )
    return BoundaryValueProblem(
        position=ribbon.position,
        state=q,
        algebraic=ca.SX(0, 1),
        constants=m,
        parameters=ribbon.parameters,
        start=ribbon.interval[0],
        phases=(phase,),
        points=(start, end),
        conditions=conditions,
        state_names=frame.names,
        constant_names=("mx", "my", "mz"),
        parameter_names=tuple(ribbon.theta),
    )


def positions_case() -> dict[str, Callable[[], object]]:
    """Return a whole warm answer, and Newton's method with positions, without, and with quadrature.

    Raises
    ------
    RuntimeError
        If the two disagree about where the ribbon ends.
    """
    prepared = prepare(load_scene(SCENE))
    found = prepared.solve()
    w, p = prepared.start()
    solver = NewtonSolver(prepared.nlp)
    problem = without_positions(prepared)
    settings = prepared.scene.transcription
    count = settings.intervals
    method = CollocationMethod.named(settings.scheme, settings.degree)
    nlp = method.transcribe(problem, (count,))
    layout = nlp.layout
    lean = NewtonSolver(nlp)
    nodes, stages, c = prepared.nlp.layout.unpack(w)
    start = layout.pack(nodes[:, 3:7], stages[..., 3:7], c[3:6])
    numbers = layout.parameters(prepared.posed().values, Mesh.uniform(count).widths)
    inputs = [problem.state, *(ca.SX.sym(name) for name in ("c", "theta", "place"))]
    tangents = Mapped(ca.Function("d3", inputs, [problem.phases[0].outputs["d3"]]))
    nowhere = np.zeros(count * layout.stages)
    weights = method.tableau.weights / count

    def without() -> np.ndarray:
        answer = lean.solve(start, numbers)
        _, q, _ = layout.unpack(answer.w)
        (d3,) = tangents(q, nowhere[:1], nowhere[:1], nowhere)
        d3 = d3.reshape(count, -1, 3)
        return np.asarray(np.einsum("k,nkj->nj", weights, d3).cumsum(axis=0))

    gap = np.abs(without()[-1] - found.outputs(np.array([1.0]))["r"][0]).max()
    if not gap < 1e-11:
        raise RuntimeError(f"the end of the ribbon is {gap:.1e} away")
    return {
        "answer": prepared.solve,
        "with": lambda: solver.solve(w, p),
        "without": lambda: lean.solve(start, numbers),
        "without, then r": without,
    }
