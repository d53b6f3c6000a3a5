"""The laws of the package on arrays: strains at moments, moments and energies at strains."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.mechanics.laws.blended import RegularizedLaw
from ribbonopt.mechanics.laws.law import RibbonLaw
from ribbonopt.mechanics.laws.sadowsky import SadowskyLaw, SingleSheetLaw

Array = NDArray[np.float64]

SADOWSKY: RibbonLaw = SadowskyLaw()


def sheet(chi: int) -> RibbonLaw:
    """Return one sheet of eqs. (2.4)-(2.5), chi = sign(u2)."""
    return SingleSheetLaw(ca.SX(chi))


def regularized(epsilon: float) -> RibbonLaw:
    """Return the law (6.1)."""
    return RegularizedLaw(ca.SX(epsilon))


def on_arrays(relation: Callable[[ca.SX, ca.SX], Any], a: Any, b: Any) -> tuple[Array, ...]:
    """Evaluate what a law says of two components, elementwise; one array for each of its values."""
    a, b = np.broadcast_arrays(np.asarray(a, dtype=float), np.asarray(b, dtype=float))
    x, y = ca.SX.sym("a"), ca.SX.sym("b")
    values = relation(x, y)
    row = ca.vertcat(*values) if isinstance(values, tuple) else values
    found = ca.Function("law", [x, y], [row])(a.reshape(1, -1), b.reshape(1, -1))
    return tuple(np.asarray(line).reshape(a.shape) for line in found.full())
