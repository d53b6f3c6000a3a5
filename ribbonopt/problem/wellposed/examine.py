"""Before anything is solved: whether the conditions fit the unknowns, by number and by rank."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.mechanics.ends.boundary import gap_between_ends
from ribbonopt.problem.contract import BoundaryValueProblem
from ribbonopt.problem.posed import Posed
from ribbonopt.problem.ribbon import Ribbon

from .linearized import linearize
from .motions import refuse_motions
from .reach import held_along, stretch_of
from .symmetric import refuse_asymmetry

Sample = tuple[Array, Array]
PARALLEL = 1e-10


def examine(ribbon: Ribbon, problem: BoundaryValueProblem, posed: Posed) -> None:
    """Refuse a problem whose conditions are too many, too few, repeated or dependent.

    And one whose conditions leave the ribbon free to move as a whole, or along itself.

    Raises
    ------
    ModelError
        With counts, names and remedy.
    """
    refuse_asymmetry(posed)
    conditions = linearize(ribbon, posed, problem)
    names = list(conditions.names)
    samples = [conditions.at(conditions.generic(seed)) for seed in (0.3, 0.8)]
    counts = unknown_counts(conditions.ribbon)
    excess = len(names) - sum(counts.values())
    if not excess:
        # Where the energy is minimised, sliding along itself does no harm.
        refuse_motions(conditions, sliding=not problem.recovered)
    _refuse_repeated(names, samples)
    if excess:
        raise ModelError(_count_message(names, counts), "boundary")
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


def unknown_counts(ribbon: Ribbon) -> dict[str, int]:
    """Unknown numbers that the conditions must determine, by what they stand for."""
    own = len(ribbon.law.states)
    return {**ribbon.model.unknowns, **({"states of the law": own} if own else {})}


def _count_message(names: list[str], counts: Mapping[str, int]) -> str:
    excess = len(names) - sum(counts.values())
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


def _refuse_repeated(names: list[str], samples: list[Sample]) -> None:
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


def refuse_unreachable(posed: Posed) -> None:
    """Raise ConvergenceError if the prescribed ends are further apart than the ribbon is long.

    And where they are exactly as far apart, unless it is held along the line between them.
    """
    scene = posed.given
    gap, length = gap_between_ends(scene), scene.interval[1] - scene.interval[0]
    share = stretch_of(scene)
    if gap > length * (1 + share + 1e-12):
        more = f", which may stretch by {share:.0%}" if share else ""
        raise ConvergenceError(
            f"unreachable: the prescribed positions of the ends are {gap:.6g} apart "
            f"(boundary.start.position, boundary.end.position), the ribbon is {length:.6g} long "
            f"(interval){more}; bring them together or lengthen the ribbon",
            status="unreachable",
        )
    if not share and abs(gap - length) <= length * 1e-12 and not held_along(scene):
        raise ConvergenceError(
            f"unreachable: the ends are {gap:.6g} apart (boundary.start.position, "
            f"boundary.end.position), as far as the ribbon is long (interval): it would have to be "
            "straight, but its directors hold it across that line; bring the ends together, or "
            "turn d3 along it",
            status="unreachable",
        )
    if scene.supports:
        from .between import refuse_taut  # few scenes have any

        refuse_taut(scene, share)


def refuse_idle_settings(posed: Posed, ribbon: Ribbon) -> None:
    """Raise a ModelError where a scene asks for what its problem has not."""
    scene = posed.given
    if isinstance(scene.switching, str) or (ribbon.law.kinked and scene.formulation == "inverted"):
        return
    plane = " in a plane, where no strains leap" if scene.states == "planar" else ""
    raise ModelError(
        f"switching: {list(scene.switching)} is of no use here: phases are for the inverted "
        "formulation and for laws whose strains may leap or kink (sadowsky, regularized, homotopy, "
        f"wunderlich, extensible, sano), found {scene.formulation} and {scene.law.type}{plane}; "
        "leave it out",
        "switching",
    )
