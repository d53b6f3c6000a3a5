"""Where each unknown and each equation stands in the vectors of the NLP: the only index arithmetic.

Unknowns w, element by element, then the last node and the constants:

    w = [x_0 | X_01 Z_01 | ... | X_0K Z_0K || x_1 | ... || ... || x_N | c]

Equations, element by element, then the conditions:

    [defects of the stages | algebraic | path, stage by stage | next node]_e ... | conditions

Parameters p; the known fields k are sampled at all points, then at the places of every element:

    [theta | k at the points | k at the places, element by element | relative widths]
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .known import Known, sampled

Index = NDArray[np.intp]
LONGEST = np.longdouble  # sums of MANY widths: double ones are off by 1e-13
MANY = 1000


@dataclass(frozen=True, eq=False)
class Layout:
    """Sizes of an NLP: states, algebraic variables, constants, stages (0: shooting), elements.

    `known` is the number of known fields, `places` are the positions in an element, from 0 to 1,
    where its equations read them.
    """

    nx: int
    nz: int
    nc: int
    ng: int
    nh: int
    stages: int
    elements: tuple[int, ...]  # in each phase
    conditions: int
    known: int = 0
    places: tuple[float, ...] = ()

    @cached_property
    def nv(self) -> int:
        """Unknowns of one stage."""
        return self.nx + self.nz

    @cached_property
    def element_count(self) -> int:
        """Elements of all phases."""
        return sum(self.elements)

    @cached_property
    def element_unknowns(self) -> int:
        """Unknowns of one element: its first node and its stages."""
        return self.nx + self.stages * self.nv

    @cached_property
    def stage_equations(self) -> int:
        """Equations of one stage: defects, algebraic, path."""
        return self.nx + self.ng + self.nh

    @cached_property
    def element_equations(self) -> int:
        """Equations of one element: its stages and its end."""
        return self.stages * self.stage_equations + self.nx

    @cached_property
    def unknowns(self) -> int:
        """Length of w."""
        return self.element_count * self.element_unknowns + self.nx + self.nc

    @cached_property
    def equations(self) -> int:
        """Number of constraints, inequalities included."""
        return self.element_count * self.element_equations + self.conditions

    @cached_property
    def constants_at(self) -> int:
        """Index in w of the first constant."""
        return self.unknowns - self.nc

    @cached_property
    def conditions_at(self) -> int:
        """Index of the first condition."""
        return self.equations - self.conditions

    @cached_property
    def point_elements(self) -> tuple[int, ...]:
        """Index of the node at the start, at each phase boundary and at the end."""
        return tuple(int(i) for i in np.concatenate([[0], np.cumsum(self.elements)]))

    @cached_property
    def points(self) -> Index:
        """The same as an array (P + 1,)."""
        return np.array(self.point_elements)

    @cached_property
    def condition_columns(self) -> NDArray[np.int64]:
        """Place in w of every variable of the conditions: the states at all points, c."""
        nodes = self.points[:, None] * self.element_unknowns + np.arange(self.nx)
        return np.concatenate([nodes.ravel(), self.constants_at + np.arange(self.nc)])

    @cached_property
    def phase_slices(self) -> tuple[slice, ...]:
        """Elements of each phase."""
        p = self.point_elements
        return tuple(slice(a, b) for a, b in pairwise(p))

    @cached_property
    def parameter_sizes(self) -> tuple[int, int, int]:
        """How much of p comes after theta: k at the points, k at the places, relative widths."""
        points = self.known * (len(self.elements) + 1)
        return points, self.known * len(self.places) * self.element_count, self.element_count

    def parameters(self, theta: Array, widths: Array, known: Known | None = None) -> Array:
        """Vector p of theta (nt,), relative widths (N,), and known fields if the problem has any.

        TranscriptionError where fields are missing, not asked for, or of another shape.
        """
        if not self.known and known is None:
            return np.concatenate([theta, widths])
        starts, last = self.starts(widths), len(self.elements) - 1
        sigma = starts[:, None] + widths[:, None] * np.array(self.places)
        ends = [(min(i, last), float(i > last)) for i in range(last + 2)]
        points = [sampled(known, i, np.array([end]), self.known) for i, end in ends]
        places = [
            sampled(known, i, sigma[s].ravel(), self.known) for i, s in enumerate(self.phase_slices)
        ]
        return np.concatenate([theta, *(part.ravel() for part in (*points, *places)), widths])

    @cached_property
    def _after(self) -> tuple[int, int]:
        """How much of p comes after theta, and after what is known at the points."""
        points, places, widths = self.parameter_sizes
        return points + places + widths, places + widths

    def theta(self, p: Array) -> Array:
        """Parameters of the problem in p."""
        return p[: len(p) - self._after[0]]

    def at_points(self, p: Array) -> Array:
        """Numbers of the conditions in p: theta, and the known fields at all points."""
        return p[: len(p) - self._after[1]]

    def with_known(self, sigma: Array, p: Array) -> Array:
        """Relative positions (N, ...), with the known fields of the places of p after them.

        (N, K, 1 + nk) for positions (N, K) of the places, (N, 1 + K nk) for those (N,) of elements.
        """
        if not self.known:
            return sigma
        k = p[len(p) - self._after[1] : len(p) - self.element_count]
        return np.concatenate([sigma[..., None], k.reshape(*sigma.shape, -1)], axis=-1)

    def widths(self, p: Array) -> Array:
        """Relative widths (N,) of the elements in p."""
        return p[len(p) - self.element_count :]

    def starts(self, p: Array) -> Array:
        """Relative position (N,) of every element's first node in its phase."""
        starts = [self.phase_nodes(p, i)[:-1] for i in range(len(self.elements))]
        return starts[0] if len(starts) == 1 else np.concatenate(starts)

    def phase_nodes(self, p: Array, phase: int) -> Array:
        """Relative positions (n + 1,) of the nodes of a phase."""
        widths = self.widths(p)[self.phase_slices[phase]]
        nodes = np.zeros(len(widths) + 1)
        widths.cumsum(dtype=LONGEST if len(widths) >= MANY else None, out=nodes[1:])
        nodes[-1] = 1.0
        return nodes

    def locate(self, p: Array, phase: int, sigma: Array) -> tuple[Index, Array, Array]:
        """Element, position in it from 0 to 1, and width, of relative positions in a phase."""
        nodes = self.phase_nodes(p, phase)
        local = nodes[1:-1].searchsorted(sigma, side="right")
        start = nodes[local]
        h = nodes[1:][local] - start
        t = np.minimum(np.maximum((sigma - start) / h, 0.0), 1.0)
        return local + self.phase_slices[phase].start, t, h

    def pack(self, nodes: Array, stages: Array, constants: Array) -> Array:
        """Vector w of nodes (N+1, nx), stages (N, K, nv) and constants (nc,)."""
        count = self.element_count
        w = np.empty(self.unknowns)
        end = count * self.element_unknowns
        blocks = w[:end].reshape(count, self.element_unknowns)
        blocks[:, : self.nx] = nodes[:-1]
        blocks[:, self.nx :] = stages.reshape(count, -1)
        w[end : end + self.nx] = nodes[-1]
        w[self.constants_at :] = constants
        return w

    def unpack(self, w: Array) -> tuple[Array, Array, Array]:
        """Nodes (N+1, nx), stages (N, K, nv) and constants (nc,) of w."""
        count = self.element_count
        end = count * self.element_unknowns
        blocks = w[:end].reshape(count, self.element_unknowns)
        last = w[end : end + self.nx]
        nodes = np.concatenate([blocks[:, : self.nx], last[None]])
        stages = blocks[:, self.nx :].reshape(count, self.stages, self.nv)
        return nodes, stages, w[self.constants_at :]

    def start_costate(self, multipliers: Array) -> Array:
        """Costates (nx,) at the start from the multipliers (ng,) of the equations.

        The equations of the first element that hold its first node with the factor minus one are
        the defects of its stages and of its end: the condition that the Lagrangian is stationary
        in that node makes their sum the costate.
        """
        first = multipliers[: self.element_equations]
        stages = first[: self.stages * self.stage_equations].reshape(self.stages, -1)
        costate: Array = stages[:, : self.nx].sum(axis=0) + first[-self.nx :]
        return costate

    def is_inequality(self) -> NDArray[np.bool_]:
        """Which constraints are path inequalities (<= 0); all others are equations."""
        mask = np.zeros(self.equations, dtype=bool)
        if self.nh:
            elements = mask[: self.conditions_at].reshape(self.element_count, -1)
            stages = elements[:, : self.stages * self.stage_equations]
            stages.reshape(self.element_count, self.stages, -1)[:, :, self.nx + self.ng :] = True
        return mask
