"""Chains for the tests of the kernel: problems of all kinds, at random unknowns."""

from dataclasses import dataclass, replace

import casadi as ca
import numpy as np
from analytic import bvp

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem, Phase
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.transcription import NLP, CollocationMethod, Mesh
from ribbonopt.transcription.collocation.blocks import ElementBlocks
from ribbonopt.transcription.collocation.compiled import CompiledChain
from ribbonopt.transcription.residuals import Derivatives, Residuals


@dataclass(frozen=True)
class Kind:
    """Sizes of a problem; of its states the first `apart` hold none of each other."""

    nx: int = 3
    nz: int = 0
    nc: int = 1
    nk: int = 0
    apart: int = 0
    scheme: str = "gauss"
    degree: int = 3
    elements: tuple[int, ...] = (4,)

    def __str__(self) -> str:
        parts = (f"x{self.nx}", f"z{self.nz}", f"c{self.nc}", f"k{self.nk}", f"apart{self.apart}")
        return "-".join([*parts, self.scheme, str(self.degree), *map(str, self.elements)])


KINDS = (
    *(Kind(degree=degree) for degree in range(1, 11)),
    *(Kind(scheme="radau", degree=degree, nz=1, apart=1) for degree in (1, 2, 5)),
    *(Kind(scheme="lobatto", degree=degree, apart=2) for degree in (2, 3, 6)),
    *(Kind(nx=n, nc=0, elements=(n,)) for n in (1, 2, 7)),
    *(Kind(elements=(n,), apart=1, degree=2) for n in (1, 2, 3, 17, 64, 65)),
    Kind(nx=4, nz=2, nc=2, apart=2, nk=1, elements=(1, 1)),
    Kind(nx=4, nz=2, nc=3, apart=4, elements=(3, 8, 2), scheme="radau"),
    Kind(nx=5, nz=0, nc=4, apart=5, elements=(9, 14, 3, 5)),
    Kind(nx=2, nz=3, nc=1, apart=0, nk=2, elements=(2, 2, 2), degree=4),
    Kind(nx=1, nc=1, elements=(2, 1)),
    Kind(nx=1, nz=1, nc=0, apart=1, elements=(1, 5), degree=1),
)


def problem_of(kind: Kind) -> BoundaryValueProblem:
    """Return a problem with no meaning: everything depends on everything but for `apart`."""
    rng = np.random.default_rng(7)
    x, z = ca.SX.sym("x", kind.nx), ca.SX.sym("z", kind.nz)
    c, theta, s = ca.SX.sym("c", kind.nc), ca.SX.sym("theta", 2), ca.SX.sym("s")
    k = ca.SX.sym("k", kind.nk)

    def mixed(rows: int, *of: ca.SX) -> ca.SX:
        if rows == 0:
            return ca.SX(0, 1)
        given = ca.vertcat(*of)
        first, second = (ca.DM(rng.uniform(-1, 1, (rows, given.numel()))) for _ in range(2))
        return ca.mtimes(first, ca.sin(given)) + ca.mtimes(second, given**2) / 3

    parts = []
    for i in range(len(kind.elements)):
        free = x[kind.apart :]
        rates = ca.vertcat(
            mixed(kind.apart, free, z, c, theta, s, k),
            mixed(kind.nx - kind.apart, x, z, c, theta, s, k),
        )
        algebraic = 3 * z + mixed(kind.nz, x, z, c, theta, s, k) / 2
        length = 0.4 + i / 5 + (c[0] ** 2 if kind.nc else 0)
        parts.append(Phase(rates, length, {}, algebraic=algebraic))

    def conditions(*points: ca.SX) -> dict[str, ca.SX]:
        count = kind.nx + kind.nc
        values = points[0][0] + mixed(count, *points, c, theta)
        return {f"b{i}": values[i] for i in range(count)}

    problem = bvp(x, tuple(parts), conditions, z=z, c=c, theta=theta, s=s)
    names = tuple(f"k{i}" for i in range(kind.nk))
    return replace(problem, known=k, known_names=names) if names else problem


@dataclass(frozen=True, eq=False)
class Case:
    """A chain in numpy and in the kernel, at unknowns w and parameters p."""

    kind: Kind
    nlp: NLP
    w: Array
    p: Array

    @property
    def blocks(self) -> ElementBlocks:
        """What evaluates it."""
        blocks = self.nlp.blocks
        assert isinstance(blocks, ElementBlocks)
        return blocks

    @property
    def chain(self) -> CompiledChain:
        """The same in the kernel."""
        assert self.blocks.compiled is not None
        return self.blocks.compiled

    def linearize(self) -> tuple[Residuals, Derivatives]:
        """Return residuals and derivatives by the kernel."""
        return self.chain.linearize(self.w, self.p)

    def condensed(self, derivatives: Derivatives) -> CondensedSystem:
        """Return numpy's factors."""
        return CondensedSystem(self.blocks, derivatives, self.p)

    def dense(self) -> tuple[Array, Array]:
        """Return constraints (nw,) and their Jacobian (nw, nw), by CasADi's sparse program."""
        values, jacobian = self.nlp.functions.jacobian(self.w, self.p)
        return np.array(values).ravel(), np.array(jacobian)


def case_of(kind: Kind, seed: int = 0) -> Case:
    """Return a case at random unknowns, on elements of unequal widths."""
    rng = np.random.default_rng(seed)
    method = CollocationMethod.named(kind.scheme, kind.degree)
    nlp = method.transcribe(problem_of(kind), kind.elements)
    widths = [rng.uniform(0.5, 1.5, n) for n in kind.elements]
    mesh = Mesh(tuple(w / w.sum() for w in widths))
    w, known = rng.uniform(-1, 1, nlp.unknowns), nlp.parameters - 2 - sum(kind.elements)
    p = np.concatenate([[0.3, 0.8], rng.uniform(-1, 1, known), mesh.widths])
    return Case(kind, nlp, w, p)
