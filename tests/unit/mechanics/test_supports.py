"""Supports: the conditions they make, and known equilibria of ribbons that they hold."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, get_args

import casadi as ca
import numpy as np
import pytest
from references import CANTILEVER_DEFLECTION, ELASTICA, agrees
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from scipy.special import ellipe, ellipk

from ribbonopt.errors import ConvergenceError
from ribbonopt.mechanics.ends.boundary import conditions_of
from ribbonopt.mechanics.ends.placement import LoadAlong, OnLine
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.imposed import residuals, verdicts
from ribbonopt.scene import (
    AnyVector,
    Boundary,
    Collocation,
    Directors,
    End,
    LabVector,
    Law,
    LoadGuess,
    Loads,
    Regularized,
    Sadowsky,
    Scene,
    SupportName,
    Turn,
    Turns,
    Variational,
)
from ribbonopt.solution.solution import Solution

Array = np.ndarray
NAMES: tuple[SupportName, ...] = get_args(SupportName)
AT_START = tuple(s for s in NAMES if s != "held")
each_support = pytest.mark.parametrize("support", NAMES)
each_seed = pytest.mark.parametrize("seed", range(2))
each_model = pytest.mark.parametrize("states", ["reduced", "full"])


def triple(vector: Array) -> tuple[float, float, float]:
    x, y, z = np.asarray(vector, dtype=float).tolist()
    return (x, y, z)


def directors(frame: Array) -> Directors:
    return Directors(*(triple(column) for column in frame.T))


@dataclass(frozen=True)
class State:
    """Both ends of a rod without loads between them; `m` is the moment at end number `at`."""

    r: Array
    frames: Array
    n: Array
    m: Array
    at: int

    def moved(self, vector: Array) -> "State":
        r = self.r.copy()
        r[self.at] += vector
        return replace(self, r=r)

    def turned(self, vector: Array) -> "State":
        frames = self.frames.copy()
        frames[self.at] = Rotation.from_rotvec(vector).as_matrix() @ frames[self.at]
        return replace(self, frames=frames)

    def loaded(self, force: Array, moment: Array) -> "State":
        return replace(self, n=self.n + force, m=self.m + moment)


@dataclass(frozen=True)
class Case:
    """A support at one end, the other clamped, and ends that meet all of it.

    Columns of `basis`: the direction that matters (line, hinge or chord), and two across it.
    """

    end: End
    state: State
    basis: Array

    @property
    def scene(self) -> Scene:
        at, other = self.state.at, 1 - self.state.at
        clamp = End("clamped", triple(self.state.r[other]), directors(self.state.frames[other]))
        ends = (self.end, clamp) if at == 0 else (clamp, self.end)
        return Scene("support", Variational(delta=0.1), Boundary(*ends))


def case(support: SupportName, at: int, seed: int) -> Case:
    """Return a support at random; all that it does not ask of the state is random."""
    rng = np.random.default_rng(seed)
    r, (n, m) = rng.uniform(-1, 1, (2, 3)), rng.uniform(-5, 5, (2, 3))
    frames = Rotation.random(2, random_state=seed).as_matrix()
    basis = Rotation.random(random_state=seed + 100).as_matrix()
    along, place = triple(2.5 * basis[:, 0]), triple(r[at])
    column = seed % 3
    axis: Any = f"d{column + 1}"
    if support in ("hinged", "flip"):
        frames[at] = np.roll(basis, column, axis=1)
    off_line = n - (n @ basis[:, 0]) * basis[:, 0]
    if support == "clamped":
        end = End("clamped", place, directors(frames[at]))
    elif support == "pinned":
        m = rng.uniform(-1, 1, 3)
        end = End("pinned", place, moment=triple(m))
    elif support == "hinged":
        end = End("hinged", place, axis=axis, along=along)
        end = replace(end, moment=AnyVector(**{axis: float(m @ basis[:, 0])}))
    elif support == "sliding":
        end = End("sliding", place, directors(frames[at]), along=along)
        force = LabVector(x=1.5) if seed else None  # a dead load of which one part acts
        n = off_line + (1.5 * basis[0, 0] * basis[:, 0] if seed else 0)
        end = replace(end, force=None if force is None else AnyVector(x=1.5))
        r[at] += 0.7 * basis[:, 0]
    elif support == "free":
        end = End("free", force=triple(n))
        m = np.zeros(3)
    elif support == "held":
        chord = r[1] - r[0]
        basis = np.linalg.qr(np.stack([chord, *basis.T[:2]], axis=1))[0]
        end = End("held", distance=float(np.linalg.norm(chord)))
        n, m = -3.0 * chord, np.zeros(3)
    else:
        end = End("flip", place, axis=axis, along=along)
        n, m = off_line, m - (m @ basis[:, 0]) * basis[:, 0]
        r[at] -= 0.4 * basis[:, 0]
    return Case(end, State(r, frames, n, m, at), basis)


def cases() -> list[tuple[SupportName, int]]:
    return [*((s, 0) for s in AT_START), *((s, 1) for s in NAMES)]


each_case = pytest.mark.parametrize(("support", "at"), cases())


@cache
def functions(support: SupportName, at: int, seed: int, states: str) -> tuple[Any, list[str], int]:
    """Residuals and verdicts of a case at a state, names, and how many speak of no loads."""
    scene = replace(case(support, at, seed).scene, states=states)
    posed = Posed.of(scene)
    ribbon = Ribbon.of(posed)
    size, constants = len(ribbon.model.states), len(ribbon.model.constants)
    start, end, c = (ca.SX.sym(name, k) for name, k in (("a", size), ("b", size), ("c", constants)))
    named = residuals(ribbon, start, end, c)
    kinematic = residuals(ribbon, start, end, c, kinematic_only=True)
    names = [name for name in named if not name.startswith("start: ")]
    values = ca.vertcat(*(named[name] for name in names))
    judged = ca.vertcat(*verdicts(ribbon, start, end, c).values())
    theta = ca.vertcat(*ribbon.theta.values())
    function = ca.Function("residuals", [start, end, c, theta], [values, judged])
    numbers = posed.values
    reference = posed.start[0]

    def at_state(state: State) -> tuple[Array, Array]:
        moments = np.array([state.m + np.cross(state.n, r - state.r[state.at]) for r in state.r])
        fields = RodFields(state.r, state.frames, np.tile(state.n, (2, 1)), moments)
        x, constant = ribbon.model.pack(fields, reference)
        found = function(x[0], x[1], constant, numbers)
        return np.array(found[0]).ravel(), np.array(found[1]).ravel()

    return at_state, names, sum(name in kinematic for name in names)


@each_model
@each_seed
@each_case
def test_ends_that_meet_a_support_have_no_residual(
    support: SupportName, at: int, seed: int, states: str
) -> None:
    residuals, names, _ = functions(support, at, seed, states)
    values, verdicts = residuals(case(support, at, seed).state)
    assert len(names) == 12
    assert np.abs(values).max() < 1e-13
    assert np.abs(verdicts).max() < 1e-13


@each_case
def test_a_support_makes_six_conditions_of_its_own_end(support: SupportName, at: int) -> None:
    name = ("start", "end")[at]
    _, names, _ = functions(support, at, 0, "reduced")
    assert sum(n.startswith(f"boundary.{name}.") for n in names) == 6


@each_model
@each_seed
@each_case
def test_loads_that_vanish_are_those_that_work_on_what_is_free(
    support: SupportName, at: int, seed: int, states: str
) -> None:
    # Motions that the support leaves free times the reactions that it can bear: no work, and
    # together as many as there are components. Then minima of the energy are equilibria.
    residuals, names, kinematic = functions(support, at, seed, states)
    state = case(support, at, seed).state
    own = [i for i, n in enumerate(names) if n.startswith(f"boundary.{('start', 'end')[at]}.")]
    h = 1e-5

    def slope(change: Callable[[float], State]) -> Array:
        return (residuals(change(h))[0] - residuals(change(-h))[0])[own] / (2 * h)

    zero, e = np.zeros(3), np.eye(3)
    motions = [slope(lambda t, v=v: state.moved(t * v)) for v in e]
    motions += [slope(lambda t, v=v: state.turned(t * v)) for v in e]
    loads = [slope(lambda t, v=v: state.loaded(t * v, zero)) for v in e]
    loads += [slope(lambda t, v=v: state.loaded(zero, t * v)) for v in e]
    of_loads = np.array(["force" in names[i] or "moment" in names[i] for i in own])
    K, F = np.stack(motions, axis=1)[~of_loads], np.stack(loads, axis=1)[of_loads]
    assert len(K) + 6 == kinematic  # six of the clamp at the other end
    assert np.linalg.matrix_rank(K, tol=1e-6) == len(K)
    assert np.linalg.matrix_rank(F, tol=1e-6) == len(F)
    free, reactions = np.linalg.svd(K)[2][len(K) :], np.linalg.svd(F)[2][len(F) :]
    assert len(free) + len(reactions) == 6
    assert np.abs(free @ reactions.T).max(initial=0) < 1e-8


#: how far residuals are from zero, root of the sum of squares, when an end is moved by 0.1, turned
#: by 0.3, its force or its moment changed by 0.2: along the line, hinge or chord, and across it
OFF = {
    "clamped": {"move": (0.1, 0.1), "turn": (0.3, 0.3), "force": (0, 0), "moment": (0, 0)},
    "pinned": {"move": (0.1, 0.1), "turn": (0, 0), "force": (0, 0), "moment": (0.2, 0.2)},
    "hinged": {"move": (0.1, 0.1), "turn": (0, None), "force": (0, 0), "moment": (0.2, 0)},
    "sliding": {"move": (0, 0.1), "turn": (0.3, 0.3), "force": (0.2, 0), "moment": (0, 0)},
    "free": {"move": (0, 0), "turn": (0, 0), "force": (0.2, 0.2), "moment": (0.2, 0.2)},
    "held": {"move": (0.1, None), "turn": (0, 0), "force": (0, None), "moment": (0.2, 0.2)},
    "flip": {"move": (0, 0.1), "turn": (0, None), "force": (0.2, 0), "moment": (0.2, 0)},
}


@each_case
@pytest.mark.parametrize("change", ["move", "turn", "force", "moment"])
@pytest.mark.parametrize("across", [False, True])
def test_a_support_opposes_what_it_holds_and_nothing_else(
    support: SupportName, at: int, change: str, across: bool
) -> None:
    residuals, *_ = functions(support, at, 1, "reduced")
    this = case(support, at, 1)
    along, side = this.basis[:, 0], this.basis[:, 1]
    v = side if across else along
    changed = {
        "move": lambda: this.state.moved(0.1 * v),
        "turn": lambda: this.state.turned(0.3 * v),
        "force": lambda: this.state.loaded(0.2 * v, np.zeros(3)),
        "moment": lambda: this.state.loaded(np.zeros(3), 0.2 * v),
    }[change]()
    off = float(np.linalg.norm(residuals(changed)[0]))
    expected = OFF[support][change][across]
    if expected is None:  # several residuals: of size one, but not known by hand
        assert off > 0.02
    elif change == "turn":  # alignment is the angle to first order: 2 sin, 2 tan or sin of it
        assert off == pytest.approx(expected, rel=0.02)
    else:
        assert off == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("support", ["hinged", "flip"])
def test_a_hinge_turned_by_half_a_turn_is_a_root_but_no_answer(support: SupportName) -> None:
    residuals, *_ = functions(support, 1, 0, "reduced")
    this = case(support, 1, 0)
    turned = this.state.turned(np.pi * this.basis[:, 1])
    m = -2 * float(turned.m @ this.basis[:, 0]) * this.basis[:, 0]  # the given moment turns too
    values, verdicts = residuals(turned.loaded(np.zeros(3), m))
    assert np.abs(values).max() < 1e-13
    assert np.abs(verdicts).max() == pytest.approx(2)


def test_a_string_off_the_chord_is_seen_by_the_force_across() -> None:
    residuals, names, _ = functions("held", 1, 0, "reduced")
    this = case("held", 1, 0)
    chord = this.state.r[1] - this.state.r[0]
    values, _ = residuals(this.state.loaded(0.2 * this.basis[:, 1], np.zeros(3)))
    couple = np.cross(0.2 * this.basis[:, 1], chord) @ this.state.frames[0][:, :2]
    off = [i for i, name in enumerate(names) if "off the chord" in name]
    np.testing.assert_allclose(values[off], couple, atol=1e-13)


def test_dead_loads_on_a_slider_act_by_their_part_along_the_line() -> None:
    end = End("sliding", (0, 0, 0), directors="identity", along=(0, 3, 4), force=(9, 1, "f"))
    scene = Scene("s", Sadowsky(), Boundary(CLAMP, end), parameters={"f": 2.0})
    (line,) = (c for c in conditions_of(scene) if isinstance(c, OnLine))
    (load,) = (c for c in conditions_of(scene) if isinstance(c, LoadAlong))
    assert load.value == pytest.approx(0.6 * 1 + 0.8 * 2)
    dead = load.dead({name: ca.SX(value) for name, value in load.theta().items()})
    np.testing.assert_allclose(np.array(ca.evalf(dead)).ravel(), [0, 1.32, 1.76], atol=1e-15)
    across = np.reshape(list(line.theta().values()), (3, 3))[1:]
    np.testing.assert_allclose(across @ across.T, np.eye(2), atol=1e-15)
    np.testing.assert_allclose(across @ [0, 3, 4], 0, atol=1e-15)


CLAMP = End("clamped", (0, 0, 0), directors="identity")
HINGE = End("hinged", (0, 0, 0), axis="d2", along=(0, 1, 0))
MESH = Collocation(degree=6, intervals=20)
AXIAL = float(ELASTICA[0.25].force)


@cache
def equilibrium(start: End, end: End, law: Law | None = None, **more: Any) -> Solution:
    law = law or Sadowsky()
    found = solve(Scene("supports", law, Boundary(start, end), transcription=MESH, **more))
    assert found.verified, found.message
    return found


def tip(found: Solution) -> Array:
    return found.sample(found.scene.interval[1], "r")


def pinned_modulus(distance: float) -> float:
    """Modulus k of the pinned elastica of length 1: distance of its ends 2 E / K - 1."""
    return brentq(lambda k: 2 * ellipe(k * k) / ellipk(k * k) - 1 - distance, 1e-9, 1 - 1e-9)


def test_the_elastica_of_these_tests_is_that_of_the_paper() -> None:
    k = pinned_modulus(0.74101961)
    assert 4 * ellipk(k * k) ** 2 / np.pi**2 == pytest.approx(1.1517196, abs=1e-7)
    assert 2 * np.degrees(np.arcsin(k)) == pytest.approx(60, abs=1e-5)
    assert agrees(16 * ellipk(pinned_modulus(0.75) ** 2) ** 2, ELASTICA[0.25].force)


LOAD = AnyVector(z=-AXIAL)
SLIDERS = {
    "line through the start": End("sliding", (0, 0, 0), "identity", along=(0, 0, -2), force=LOAD),
    "line through another point": End(
        "sliding", (0, 0, 1), "identity", along=(0, 0, 1), force=LOAD
    ),
    "components": End(position=LabVector(x=0, y=0), directors="identity", force=LOAD),
}


@pytest.mark.parametrize("slider", SLIDERS)
@pytest.mark.parametrize("guess", ["auto", LoadGuess((0, 0, -AXIAL), (0, 6, 0))])
def test_a_dead_load_on_a_slider_shortens_the_elastica(slider: str, guess: Any) -> None:
    found = equilibrium(CLAMP, SLIDERS[slider], guess=guess)
    np.testing.assert_allclose(tip(found), [0, 0, 0.75], atol=1e-9)
    np.testing.assert_allclose(found.n0, [0, 0, -AXIAL], atol=1e-9)
    assert agrees(found.energy, ELASTICA[0.25].energy)
    assert agrees(float(abs(found.sample(0.5, "dot(r, ex)"))), ELASTICA[0.25].deflection)


def pulled_elastica(angle: float, pull: float) -> tuple[float, float, float]:
    """Force across, distance and energy of a planar elastica clamped on a line, by scipy.

    Its tangent is along the line at the start, at an angle to it at the end, where it is pulled.
    """

    def rates(s: Array, y: Array, p: Array) -> Array:
        theta, curvature, *_ = y
        n1 = p[0] * np.cos(theta) - pull * np.sin(theta)  # along d1; m2' = -n1
        return np.array([curvature, -n1, np.sin(theta), np.cos(theta), curvature**2 / 2])

    def ends(a: Array, b: Array, p: Array) -> Array:
        return np.array([a[0], a[2], a[3], a[4], b[0] - angle, b[2]])

    s = np.linspace(0, 1, 21)
    found = solve_bvp(
        rates, ends, s, np.stack([angle * s, 0 * s, 0 * s, s, 0 * s]), p=[0.0], tol=1e-9
    )
    assert found.success
    return float(found.p[0]), float(found.y[3, -1]), float(found.y[4, -1])


@pytest.mark.parametrize("place", [0.0, 1.0])
def test_a_slider_is_pulled_along_its_line(place: float) -> None:
    across, distance, energy = pulled_elastica(0.5, 10.0)
    turned = Turns((Turn(y=0.5),))
    end = End("sliding", (0, 0, place), turned, along=(0, 0, 1), force=AnyVector(z=10))
    found = equilibrium(CLAMP, end)
    np.testing.assert_allclose(found.n0, [across, 0, 10], atol=1e-6)
    np.testing.assert_allclose(tip(found), [0, 0, distance], atol=1e-8)
    assert found.energy == pytest.approx(energy, rel=1e-7)


@pytest.mark.parametrize("place", [0.0, 1.0])
def test_a_straight_ribbon_that_is_pulled_is_told_and_not_bent_to_a_loop(place: float) -> None:
    # It cannot bend in its own plane: n2 and m1 are not determined, whatever pulls it.
    end = End("sliding", (0, 0, place), "identity", along=(0, 0, 1), force=AnyVector(z=10))
    with pytest.raises(ConvergenceError, match="straight"):
        equilibrium(CLAMP, end)


def ends_at(distance: float) -> dict[str, tuple[End, End]]:
    place = (0.0, 0.0, distance)
    moving = End(position=LabVector(x=0, y=0), d2=(0, 1, 0), moment=AnyVector(d2=0))
    force = AnyVector(z=-4 * ellipk(pinned_modulus(distance) ** 2) ** 2)
    return {
        "hinged, pinned": (HINGE, End("pinned", place)),
        "pinned, hinged": (End("pinned", (0, 0, 0)), replace(HINGE, position=place)),
        "hinged, hinged": (HINGE, replace(HINGE, position=place, along=(0, 0.5, 0))),
        "hinged, loaded": (HINGE, replace(moving, force=force)),
    }


@pytest.mark.parametrize("ends", ends_at(0.74101961))
def test_hinges_hold_the_pinned_elastica(ends: str) -> None:
    law = Variational(delta=0.1) if "loaded" in ends else Sadowsky()  # planar: the same
    found = equilibrium(*ends_at(0.74101961)[ends], law)
    np.testing.assert_allclose(tip(found), [0, 0, 0.74101961], atol=1e-8)
    np.testing.assert_allclose(found.n0, [0, 0, -(np.pi**2) * 1.1517196], atol=1e-5)
    d3 = found.sample([0.0, 1.0], "d3")
    np.testing.assert_allclose(np.abs(d3[:, 0]), np.sin(np.pi / 3), atol=1e-6)
    # m = n x r: the curvature is P times the deflection, 2 k sqrt(P) at most.
    largest = abs(float(found.sample(0.5, "u2")))
    assert largest == pytest.approx(np.sqrt(np.pi**2 * 1.1517196), rel=1e-6)


@pytest.mark.parametrize("distance", [0.2, 0.74101961])
def test_a_string_holds_the_pinned_elastica(distance: float) -> None:
    k = pinned_modulus(distance)
    found = equilibrium(CLAMP, End("held", distance=distance))
    chord = tip(found)
    assert np.linalg.norm(chord) == pytest.approx(distance, abs=1e-10)
    # The string pulls the end towards the start: the force on it is against the chord.
    expected = -4 * ellipk(k * k) ** 2 * chord / distance
    np.testing.assert_allclose(found.n0, expected, atol=1e-7)
    np.testing.assert_allclose(found.m0, 0, atol=1e-9)
    # The tangent at the clamp makes the end angle 2 arcsin k with the chord.
    assert chord[2] / distance == pytest.approx(1 - 2 * k * k, abs=1e-8)


def test_a_string_pulls_at_its_own_end_however_heavy_the_ribbon_is() -> None:
    """The weight is taken by the clamp: there the force is along no string."""
    found = equilibrium(CLAMP, End("held", distance=0.8), loads=Loads(force=(3.0, 1.0, 0.0)))
    chord, at_end = tip(found), found.sample(1.0, "n")
    np.testing.assert_allclose(np.cross(at_end, chord), 0, atol=1e-8)
    np.testing.assert_allclose(found.n0 - at_end, (3.0, 1.0, 0.0), atol=1e-10)
    assert np.linalg.norm(np.cross(found.n0, chord)) > 0.5


@pytest.mark.parametrize("start", [False, True])
def test_a_dead_force_on_a_free_end_bends_the_cantilever(start: bool) -> None:
    sign = -1.0 if start else 1.0  # n acts from the side of larger s
    free = End("free", force=(sign, 0, 0))
    ends = (free, CLAMP) if start else (CLAMP, free)
    found = equilibrium(*ends)
    r = found.sample([0.0, 1.0], "r")
    assert agrees(abs(float(r[1, 0] - r[0, 0])), CANTILEVER_DEFLECTION)
    np.testing.assert_allclose(found.n0, [sign, 0, 0], atol=1e-12)


U2, U3 = 4.0, 2.0
ETA = U3 / U2
HELIX_N = AnyVector(d1=0, d2=U2 * U3 * (1 + ETA**2) ** 2, d3=(U3 * (1 + ETA**2)) ** 2)
HELIX_M = AnyVector(d1=0, d2=U2 * (1 - ETA**4), d3=2 * U3 * (1 + ETA**2))


def test_loads_along_the_directors_of_a_free_end_keep_the_helix() -> None:
    found = equilibrium(CLAMP, End("free", force=HELIX_N, moment=HELIX_M))
    u = found.sample(np.linspace(0, 1, 21), "u")
    np.testing.assert_allclose(u, np.tile([0, U2, U3], (21, 1)), atol=1e-9)
    assert found.energy == pytest.approx(12.5, abs=1e-10)
    frame = np.stack([found.sample(1.0, d) for d in ("d1", "d2", "d3")], axis=1)
    expected = Rotation.from_rotvec([0, U2, U3]).as_matrix()
    np.testing.assert_allclose(frame, expected, atol=1e-10)


def sphere(points: Array) -> tuple[Array, float, float]:
    """Centre and radius of the sphere nearest to points, and the largest distance from it."""
    matrix = np.column_stack([2 * points, np.ones(len(points))])
    found = np.linalg.lstsq(matrix, np.sum(points**2, axis=1), rcond=None)[0]
    centre, radius = found[:3], float(np.sqrt(found[3] + found[:3] @ found[:3]))
    off = np.linalg.norm(points - centre, axis=1) - radius
    return centre, radius, float(np.abs(off).max())


@pytest.mark.parametrize(
    ("moment", "start"), [((0, 3.2, 2.4), False), ((0.5, 2, -6), False), ((0, 2, 1), True)]
)
def test_a_moment_on_a_free_end_bends_the_ribbon_on_a_sphere(moment: Any, start: bool) -> None:
    free = End("free", moment=moment)
    ends = (free, CLAMP) if start else (CLAMP, free)
    found = equilibrium(*ends)
    np.testing.assert_allclose(found.n0, 0, atol=1e-12)
    np.testing.assert_allclose(found.sample([0.0, 1.0], "m"), [moment, moment], atol=1e-11)
    s = np.linspace(0, 1, 200)
    H = found.sample(s, "H")
    _, radius, off = sphere(found.sample(s, "r"))
    assert off < 1e-9
    assert radius == pytest.approx(np.linalg.norm(moment) / (2 * H[0]), rel=1e-8)
    # H from the law of the paper: W_Leg = (|m2| + M)^2 / 8.
    m = found.sample(s, "m")
    m2, M = np.sum(m * found.sample(s, "d2"), axis=1), np.linalg.norm(m, axis=1)
    m1 = np.sum(m * found.sample(s, "d1"), axis=1)
    np.testing.assert_allclose(H, (np.abs(m2) + np.sqrt(M**2 - m1**2)) ** 2 / 8, rtol=1e-9)


@pytest.mark.parametrize("sign", [1, -1])
def test_flips_about_axes_a_sixth_of_a_turn_apart_make_the_band_of_three(sign: int) -> None:
    # The third of SCIENCE's other program, law (6.1), epsilon = 0.01; signs are symmetries.
    angle = np.pi / 3
    line = triple(sign * np.array([-np.cos(angle), 0, np.sin(angle)]))
    start = End("flip", (0, 0, 0), axis="d1", along=(1, 0, 0))
    end = End("flip", (0, 0, 0), axis="d2", along=line)
    found = equilibrium(start, end, Regularized(epsilon=0.01), interval=(0.0, 1 / 6))
    n, m = (np.abs(found.sample(0.0, f"[{v}1, {v}2, {v}3]")) for v in "nm")
    np.testing.assert_allclose(n, [0, 157.21, 101.74], atol=5e-3)
    np.testing.assert_allclose(m, [0, 11.55, 29.64], atol=5e-3)
