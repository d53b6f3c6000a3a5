"""Before anything is solved: whether the conditions fit the unknowns, by number and by rank."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ModelError
from ribbonopt.mechanics import MODELS, RodFields, RodModel

from .contract import BoundaryValueProblem
from .ribbon import Ribbon

Linearized = tuple[Array, Array]
PARALLEL = 1e-10


def examine(ribbon: Ribbon, problem: BoundaryValueProblem, theta: Array) -> None:
    """Refuse a problem whose conditions are too many, too few, repeated or dependent.

    Raises
    ------
    ModelError
        With counts, names and remedy.
    """
    names, samples = _linearized(ribbon, problem, theta)
    _refuse_repeated(names, samples)
    excess = len(names) - sum(unknown_names(MODELS["reduced"]).values())
    if excess:
        raise ModelError(_count_message(names, excess), "boundary")
    jacobian = samples[0][1]
    scaled = jacobian / np.linalg.norm(jacobian, axis=1, keepdims=True)
    left, singular, _ = np.linalg.svd(scaled)
    if singular[-1] < PARALLEL * singular[0]:
        involved = [n for n, v in zip(names, left[:, -1], strict=True) if abs(v) > 1e-6]
        raise ModelError(
            "boundary: these conditions are not independent of one another: "
            + ", ".join(involved)
            + "; remove one of them and prescribe something else instead",
            _key(involved[-1]),
        )


def unknown_names(model: RodModel) -> dict[str, int]:
    """Unknown numbers that the conditions must determine, by what they stand for."""
    return {"position": 3, "directors": len(model.orientation.names), "force": 3, "moment": 3}


def _count_message(names: list[str], excess: int) -> str:
    counts = unknown_names(MODELS["reduced"])
    unknowns = ", ".join(f"{name} {count}" for name, count in counts.items())
    own = [name for name in names if name.startswith("start: ")]
    listed = "\n  ".join(name for name in names if name not in own)
    remedy = (
        f"{excess} too many: remove {excess} of them"
        if excess > 0
        else f"{-excess} missing: prescribe {-excess} more at the ends (position, directors, force "
        "or moment; a free end has force and moment zero), or add equations under boundary.also"
    )
    return (
        f"boundary: {len(names)} conditions for {len(names) - excess} unknowns ({unknowns}); "
        f"{remedy}\nconditions of the scene ({len(names) - len(own)}):\n  {listed}\n"
        f"and {len(own)} that make the start's directors orthonormal"
    )


def _key(name: str) -> str:
    """Path in the scene of a condition; its name may say more in parentheses."""
    return name.partition(" ")[0]


def _refuse_repeated(names: list[str], samples: list[Linearized]) -> None:
    lengths = [np.linalg.norm(jacobian, axis=1) for _, jacobian in samples]
    for i, name in enumerate(names):
        if min(length[i] for length in lengths) == 0:
            raise ModelError(
                f"{name}: does not depend on any unknown, so it prescribes nothing; remove it",
                _key(name),
            )
    units = [j / length[:, None] for (_, j), length in zip(samples, lengths, strict=True)]
    for j in range(len(names)):
        for i in range(j):
            cosines = [float(u[i] @ u[j]) for u in units]
            if min(abs(c) for c in cosines) < 1 - PARALLEL or cosines[0] * cosines[1] < 0:
                continue
            # Parallel everywhere: the same condition if the residuals agree too.
            sign = np.sign(cosines[0])
            gaps = [
                r[i] / length[i] - sign * r[j] / length[j]
                for (r, _), length in zip(samples, lengths, strict=True)
            ]
            if max(abs(g) for g in gaps) < 1e-8:
                raise ModelError(
                    f"{names[i]} and {names[j]} are the same condition twice; remove one",
                    _key(names[j]),
                )
            raise ModelError(
                f"{names[i]} and {names[j]} prescribe different values for the same thing; "
                "remove one",
                _key(names[j]),
            )


def _linearized(
    ribbon: Ribbon, problem: BoundaryValueProblem, theta: Array
) -> tuple[list[str], list[Linearized]]:
    """Names, residuals (nb,) and Jacobians (nb, unknowns of both ends and constants) at two rods.

    On the reduced states whatever the scene's own: they know that the force is one constant, so
    that a force prescribed at both ends is seen as prescribed twice.
    """
    reduced = replace(ribbon, model=MODELS["reduced"])
    count = len(reduced.model.states)
    start, end = ca.SX.sym("start", count), ca.SX.sym("end", count)
    c = ca.SX.sym("c", len(reduced.model.constants))
    named = reduced.residuals(start, end, c)
    conditions = ca.vertcat(*named.values())
    jacobian = ca.densify(ca.jacobian(conditions, ca.vertcat(start, end, c)))
    inputs = [ca.vertcat(start, end), c, problem.parameters]
    function = ca.Function("conditions", inputs, [conditions, jacobian])
    result = []
    for seed in (0.3, 0.8):
        residuals, matrix = function(*_generic_rod(reduced, seed), theta)
        result.append((np.array(residuals).ravel(), np.array(matrix)))
    return list(named), result


def _generic_rod(ribbon: Ribbon, seed: float) -> tuple[Array, Array]:
    """States of both ends and constants of a rod without any symmetry.

    A Weyl sequence instead of `numpy.random`, whose import costs more than all of this module.
    """
    values = 2 * np.modf(seed + np.arange(1, 37) * 0.6180339887498949)[0] - 1
    frames = np.linalg.qr(values[:18].reshape(2, 3, 3))[0]
    frames *= np.linalg.det(frames)[:, None, None]
    r, n, m = values[18:].reshape(3, 2, 3)
    x, c = ribbon.model.pack(RodFields(r, frames, n, m), np.zeros(3))
    return x.ravel(), c
