"""Ways to a first solution: relaxed conditions, loads brought on, several starts, named guesses."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from itertools import islice, pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from references import CANTILEVER_DEFLECTION, ELASTICA, HALF_MOEBIUS, VARIATIONAL, agrees

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.attempt.structure import Structure
from ribbonopt.errors import ModelError
from ribbonopt.guess import Guess, ShapeGuess
from ribbonopt.guess.shapes import Chord, Helical
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed, formulate
from ribbonopt.scene import (
    AnyVector,
    Boundary,
    Collocation,
    End,
    Kirchhoff,
    LabVector,
    LoadGuess,
    Loads,
    Loop,
    Sadowsky,
    Scene,
    Turn,
    Turns,
    Variational,
    load_scene,
)
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import NewtonSolver, Status
from ribbonopt.starts import automatic, homotopy
from ribbonopt.starts.automatic import Automatic
from ribbonopt.starts.equilibria import _variants as variants
from ribbonopt.starts.equilibria import equilibria
from ribbonopt.starts.first_shape import compresses, shapes_for
from ribbonopt.starts.grading import is_coarse
from ribbonopt.starts.homotopy import HomotopyPath
from ribbonopt.starts.loops import closed_posed, fundamental_scene, loop_of
from ribbonopt.starts.tracking import Tracking, smooth_of

Array = np.ndarray
Solved = Callable[..., Solution]
CLAMP = End("clamped", (0, 0, 0), directors="identity")
MESH = Collocation(degree=6, intervals=12)
SMOOTH = Variational(delta=0.3)
AUTOMATIC = ("least energy", "twisted circle")  # with which the automatic start begins
ROD = Variational(delta=1.0)  # linear: even a straight ribbon without stress can be bent from it
STRAIGHT = ShapeGuess(Chord((np.zeros(3), np.eye(3)), (np.array([0, 0, 1.0]), np.eye(3)), 1.0))


def scene(start: End, end: End, **more: Any) -> Scene:
    more = {"law": SMOOTH, "transcription": MESH} | more
    return Scene("start", boundary=Boundary(start, end), **more)


def steps(found: Solution) -> list[str]:
    return [step["step"] for step in found.steps]


# Newton with residuals that the conditions shall have.


@cache
def cantilever() -> tuple[NewtonSolver, Array, Array, list[str]]:
    """A solved cantilever: Newton's method, its unknowns, parameters, names of conditions."""
    this = scene(CLAMP, End("free", force=(1, 0, 0)), guess=LoadGuess((1, 0, 0), (0, 1, 0)))
    prepared = prepare(this)
    newton = NewtonSolver(prepared.nlp)
    w, p = prepared.start()
    found = newton.solve(w, p)
    assert found.status is Status.CONVERGED
    return newton, found.w, p, list(prepared.problem.conditions)


@pytest.mark.parametrize("seed", range(3))
def test_relaxed_conditions_have_the_residuals_that_are_asked(seed: int) -> None:
    newton, w, p, names = cantilever()
    asked = np.random.default_rng(seed).uniform(-0.1, 0.1, len(names))
    found = newton.solve(w, p, asked)
    assert found.status is Status.CONVERGED
    residuals = newton.system.residuals(found.w, p)
    np.testing.assert_allclose(residuals.conditions, asked, atol=1e-11)
    # Everything else holds as before.
    others = residuals.vector()
    assert np.sum(np.abs(others) > 1e-10) <= len(names)
    zero = newton.solve(found.w, p, np.zeros(len(names)))
    np.testing.assert_allclose(zero.w, w, atol=1e-9)


def test_a_relaxed_force_is_the_force_at_the_tip() -> None:
    # The force asked for is 1; half of it is asked to remain: the cantilever of half the load.
    newton, w, p, names = cantilever()
    asked = np.where(np.array(names) == "boundary.end.force.x", -0.5, 0.0)
    found = newton.solve(w, p, asked)
    half = solve(scene(CLAMP, End("free", force=(0.5, 0, 0))))
    constants = newton.nlp.layout.unpack(found.w)[2]
    np.testing.assert_allclose(constants, [*half.n0, *half.m0], atol=1e-10)


# Equilibria followed.


def followed(this: Scene, guess: Guess, delta: float) -> HomotopyPath:
    posed = Posed.of(this)
    structure = Structure.of(smooth_of(posed, ROD))
    return homotopy.follow(structure, posed, ROD, guess, delta)


@pytest.mark.parametrize(
    ("end", "formula", "expected"),
    [
        # A moment has no potential: the least energy has not brought it on.
        (End("free", moment=(0, 3.2, 2.4)), "m", (0, 3.2, 2.4)),
        (End("free", moment=AnyVector(d1=0, d2=3, d3=2)), "[m1, m2, m3]", (0, 3, 2)),
        (End("free", force=(7, 2, -3)), "n", (7, 2, -3)),
    ],
)
def test_loads_are_brought_onto_a_straight_ribbon(end: End, formula: str, expected: Any) -> None:
    path = followed(scene(CLAMP, end), STRAIGHT, 0.02)
    assert path.complete
    last = path.points[-1]
    assert last.scene.law == Variational(delta=0.02)
    np.testing.assert_allclose(last.sample(1.0, formula), expected, atol=1e-7)
    other = "n" if formula != "n" else "m"
    np.testing.assert_allclose(last.sample(1.0, other), 0, atol=1e-7)


def test_each_point_of_the_way_down_is_an_equilibrium_of_its_law() -> None:
    this = scene(CLAMP, End("free", moment=(0, 3.2, 2.4)))
    path = followed(this, STRAIGHT, 0.01)
    deltas = [point.scene.law.delta for point in path.points]
    assert deltas[0] == 1.0
    assert deltas[-1] == 0.01
    assert all(a > b for a, b in pairwise(deltas))
    for point in path.points:
        # H = W_Leg = (q + M)^2 / 8 of the moment at the start, whose directors are the axes.
        delta = point.scene.law.delta
        expected = (np.hypot(3.2, delta * 2.4) + 4.0) ** 2 / 8
        np.testing.assert_allclose(point.sample(0.0, "H"), expected, rtol=1e-6)
        np.testing.assert_allclose(point.sample(1.0, "m"), [0, 3.2, 2.4], atol=1e-7)


def test_a_path_that_cannot_be_followed_to_its_end_is_given_up(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # Every step is possible but the last, which lets the conditions hold.
    tried: list[float] = []

    def step(self: Any, law: Any, relaxed: Array | None) -> bool:
        tried.append(0.0 if relaxed is None else float(np.abs(relaxed).max()))
        assert len(tried) < 1000, "goes on without end"
        return tried[-1] > 0

    monkeypatch.setattr(Tracking, "step", step)
    this = scene(CLAMP, End("free", moment=(0, 3.2, 2.4)))
    path = followed(this, STRAIGHT, 0.1)
    assert not path.complete
    assert path.points == ()


def test_a_first_step_that_fails_is_the_end_of_a_path(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Tracking, "step", lambda *_: False)
    path = followed(scene(CLAMP, End("free", moment=(0, 3.2, 2.4))), STRAIGHT, 0.1)
    assert (path.complete, path.points) == (False, ())


@pytest.mark.parametrize("limit", [0.2, 0.05])
def test_delta_goes_down_as_far_as_it_can(monkeypatch: pytest.MonkeyPatch, limit: float) -> None:
    genuine = Tracking.step

    def step(self: Any, law: Any, relaxed: Array | None) -> bool:
        return law.delta >= limit and genuine(self, law, relaxed)

    monkeypatch.setattr(Tracking, "step", step)
    path = followed(scene(CLAMP, End("free", force=(1, 0, 0))), STRAIGHT, 0.01)
    assert not path.complete
    assert limit <= path.points[-1].scene.law.delta < 1.2 * limit


@pytest.mark.parametrize("losses", [1, 2])
def test_where_a_path_is_lost_the_energy_is_minimised_further_down(
    monkeypatch: pytest.MonkeyPatch, losses: int
) -> None:
    """Above the place the branch was there all along: the minimum would lead onto it again."""
    whole, least = automatic.follow, Automatic._least
    lost: list[float] = []
    minimised: list[float] = []

    def follow(*parts: Any) -> HomotopyPath:
        found = whole(*parts)
        if len(lost) == losses:
            return found
        points = [point for point in found.points if point.scene.law.delta > 0.1 / 3 ** len(lost)]
        lost.append(points[-1].scene.law.delta)
        return replace(found, points=tuple(points), complete=False)

    def minimum(self: Automatic, posed: Posed, law: Any, *rest: Any) -> Solution:
        minimised.append(law.delta)
        return least(self, posed, law, *rest)

    monkeypatch.setattr(automatic, "follow", follow)
    monkeypatch.setattr(Automatic, "_least", minimum)
    end = End("clamped", (0, 0.05, 0.8), directors="identity")
    posed = Posed.of(scene(CLAMP, end, law=Variational(delta=0.005)))
    found = next(iter(Automatic(posed).guesses(posed, Ledger())))
    assert isinstance(found, Solution) and found.scene.law == posed.scene.law
    assert len(minimised) == 1 + losses
    assert all(there > further for there, further in zip(lost, minimised[1:], strict=True))


def test_uneven_rods_are_followed_along_the_secant() -> None:
    """From where the path branches off to a ratio twenty times smaller: a few iterations a step.

    From the point before, instead of the secant, it takes three times as many, and more steps.
    """
    end = End("clamped", (0.1, 0.05, 0.8), directors=Turns((Turn(y=0.5), Turn(z=0.8))))
    posed, ledger = Posed.of(scene(CLAMP, end, law=Kirchhoff(B2=1.0, B3=0.003))), Ledger()
    (found,) = islice(Automatic(posed).guesses(posed, ledger), 1)
    assert isinstance(found, Solution)
    last = [step for step in ledger.steps if "newton" in step["step"]][-1]
    assert last["step"].endswith("B3 / B2 = 0.003")
    assert last["iterations"] < 130


def test_a_smooth_law_is_started_under_itself() -> None:
    """Blunter laws are on the way to it: what led nowhere from their end does so from before."""
    end = End("clamped", (0, 0.05, 0.8), directors="identity")
    posed = Posed.of(scene(CLAMP, end, law=Variational(delta=0.02)))
    for guess in islice(Automatic(posed).guesses(posed, Ledger()), 2):
        assert isinstance(guess, Solution) and guess.scene.law == posed.scene.law


@pytest.mark.parametrize(
    ("force", "pushed"),
    [
        ((0, 0, -1.0), True),
        ((0, 0, 1.0), False),
        ((3.0, -2.0, 0), False),
        ((3.0, -2.0, -1e-16), False),  # across, to rounding
        ((3.0, -2.0, -1e-6), True),
        ((0, 0, 0), False),
    ],
)
def test_a_strip_is_compressed_by_what_pushes_its_ends_together(force: Any, pushed: bool) -> None:
    posed = Posed.of(scene(CLAMP, End("free", force=force)))
    chord = Chord((np.zeros(3), np.eye(3)), (np.array([0, 0, 1.0]), np.eye(3)), 1.0)
    assert compresses(posed, chord) == pushed


# Loops that scenes make without saying so.


def test_loops_are_seen_in_the_ends(configs: Path) -> None:
    assert loop_of(load_scene(configs / "moebius_half.yaml")) == Loop(1, "half")
    assert loop_of(load_scene(configs / "moebius_regularized.yaml")) == Loop(1)
    assert loop_of(load_scene(configs / "band_three.yaml")) == Loop(3, "fundamental")
    here = End("clamped", (0, 0, 0), directors="identity")
    assert loop_of(scene(CLAMP, here)) == Loop(0)
    assert loop_of(scene(CLAMP, replace(here, position=(0, 0, 1e-3)))) is None


@pytest.mark.parametrize("support", ["sliding", "flip"])
def test_a_point_of_a_line_is_no_place_of_an_end(support: Any) -> None:
    # The line that an end moves on may be given by the point where the ribbon starts.
    end = End(support, (0, 0, 0), along=(0, 0, 1))
    end = replace(end, directors="identity") if support == "sliding" else replace(end, axis="d3")
    assert loop_of(scene(CLAMP, end)) is None


def test_an_end_that_a_dead_load_moves_closes_no_loop() -> None:
    # (6.2) leaves one component of the gap to symmetry, with n1(0) = 0; this end slides.
    end = End(position=LabVector(x=0, y=0), directors="identity", force=AnyVector(z=-45))
    assert loop_of(scene(CLAMP, end)) is None


def test_the_least_energy_closes_what_symmetry_would_close(configs: Path) -> None:
    open_ = load_scene(configs / "moebius_regularized.yaml")
    smooth = Posed.of(replace(open_, law=SMOOTH, formulation="energy"))
    _, problem = formulate(closed_posed(smooth))
    assert {f"boundary.end.position.{axis}" for axis in "xyz"} <= set(problem.conditions)
    half = Posed.of(load_scene(configs / "moebius_half.yaml"))
    assert closed_posed(half) is half


def test_bands_of_several_half_twists_are_solved_by_their_piece_first(configs: Path) -> None:
    whole = load_scene(configs / "moebius_whole.yaml", ["boundary.loop.half_twists=-3"])
    piece = fundamental_scene(whole)
    assert piece is not None
    assert piece.boundary.loop == Loop(-3, "fundamental")
    assert piece.interval == pytest.approx((0, 1 / 6))
    assert fundamental_scene(piece) is None
    assert fundamental_scene(load_scene(configs / "moebius_whole.yaml")) is None


# Several starts.


@pytest.fixture(scope="module")
def helices() -> Solution:
    """All that eight starts find between the ends of the exact helix."""
    configs = Path(__file__).parents[3] / "configs"
    return solve(load_scene(configs / "helix_clamped.yaml", ["guess=auto", "starts=8"]))


def test_the_lowest_of_several_equilibria_is_the_exact_helix(helices: Solution) -> None:
    assert helices.verified
    assert helices.energy == pytest.approx(12.5, abs=1e-9)
    np.testing.assert_allclose(helices.n0, [0, 12.5, 6.25], atol=1e-8)
    np.testing.assert_allclose(helices.m0, [0, 3.75, 5], atol=1e-8)


def test_equilibria_are_distinct_and_by_increasing_energy(helices: Solution) -> None:
    found = [helices, *helices.others]
    assert len(found) >= 2
    energies = [f.energy for f in found]
    assert all(a < b - 1e-2 for a, b in pairwise(energies))
    assert sum(f.times for f in found) <= 8
    for other in found:
        assert other.verified
        # Each is an equilibrium of this scene: both ends where the helix has them.
        for name in ("r", "d2", "d3"):
            ends = [f.sample([0.0, 1.0], name) for f in (other, helices)]
            np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)
        H, scale = other.sample(other.nodes, "H"), np.linalg.norm(other.n0)
        np.testing.assert_allclose(H, H[0], atol=2e-2 * scale)


def test_all_equilibria_are_in_the_summary_and_in_the_report(helices: Solution) -> None:
    summary = summarize(helices)
    assert [e["energy"] for e in summary["equilibria"]] == [
        f.energy for f in (helices, *helices.others)
    ]
    assert f"{1 + len(helices.others)} equilibria" in report(summary)


CLAMPED = scene(
    CLAMP,
    End("clamped", (0, 0, 0.75), directors="identity"),
    law=Variational(delta=0.1),
    starts=4,
)


def test_mirror_images_count_once() -> None:
    # Bowed to either side, twisted to either side: two pairs of mirror images.
    found = solve(CLAMPED)
    assert agrees(found.energy, ELASTICA[0.25].energy)
    assert found.times == 2
    assert [other.times for other in found.others] == [2]


class Stub:
    """An automatic start that knows the way: each shape leads to one guess, by number."""

    def guesses(self, posed: Posed, ledger: Ledger, shape: Any) -> Iterator[Any]:
        yield shape


def listed(first: Solution, *others: Solution, law: Any = None) -> Solution:
    """Return what several starts make of given solutions."""
    queue = iter(others)
    this = Posed.of(replace(CLAMPED, starts=1 + len(others)))
    return equilibria(this, first, Stub(), lambda _: next(queue))  # type: ignore[arg-type]


@cache
def elastica(bow: float, distance: float = 0.75) -> Solution:
    end = End("clamped", (0, 0, distance), directors="identity")
    found = solve(replace(CLAMPED, boundary=Boundary(CLAMP, end), starts=1, guess=loads(bow)))
    assert found.verified
    return found


def loads(bow: float) -> LoadGuess:
    return LoadGuess((0, 0, -45.0), (0, 6.5 * bow, 0))


def test_solutions_are_told_apart_up_to_mirrors() -> None:
    up, down, flat = elastica(1), elastica(-1), elastica(1, 0.9)
    np.testing.assert_allclose(up.m0, -down.m0, atol=1e-8)
    both = listed(up, down, up)
    assert (both.times, both.others) == (3, ())
    several = listed(up, flat, down, flat)
    assert several.energy == flat.energy
    assert (several.times, [f.times for f in several.others]) == (2, [2])


def test_what_is_not_verified_is_not_counted() -> None:
    up, flat = elastica(1), elastica(1, 0.9)
    failed = replace(flat, status=Status.STALLED)
    assert listed(up, failed).others == ()
    assert listed(failed, failed) is failed
    assert listed(failed, up).energy == up.energy


def test_the_work_of_dead_forces_counts() -> None:
    # Potential: strain energy less force times the displacement of the tip.
    found = solve(scene(CLAMP, End("free", force=(1, 0, 0)), guess=loads(0.2)))
    tip = found.sample(1.0, "r")
    assert potential(found) == pytest.approx(found.energy - tip[0], abs=1e-12)
    start = solve(scene(End("free", force=(-1, 0, 0)), CLAMP))
    assert potential(start) == pytest.approx(potential(found), abs=1e-9)


def test_the_work_of_a_weight_counts() -> None:
    """Potential: strain energy less the force per length times the position, along the ribbon."""
    f = np.array([2.0, 0.5, -1.0])
    found = solve(scene(CLAMP, End("free"), loads=Loads(force=tuple(f))))
    s = np.linspace(0, 1, 2001)
    along = found.sample(s, "r") @ f
    work = (along[1:] + along[:-1]) / 2 @ np.diff(s)
    assert abs(work) > 0.1
    assert potential(found) == pytest.approx(found.energy - work, abs=1e-6)


@pytest.mark.parametrize("length", [0.3, 1.0, 4.0])
@pytest.mark.parametrize(("intervals", "coarse"), [(4, True), (8, False)])
def test_an_interval_is_coarse_by_the_angle_it_turns(
    length: float, intervals: int, coarse: bool
) -> None:
    """Six radians of a circle, however long: a radian is too much for an interval."""
    mesh = Collocation(degree=3, intervals=intervals)
    end = End("free", force=(0, 0, 0), moment=(0, 6.0 / length, 0))
    guess = LoadGuess((0, 0, 0), (0, 6 / length, 0))
    law, interval = Kirchhoff(B2=1.0, B3=1.0), (0.0, length)
    found = solve(scene(CLAMP, end, law=law, interval=interval, transcription=mesh, guess=guess))
    assert found.verified
    assert is_coarse(found) == coarse


def test_equal_seeds_perturb_alike_and_others_do_not() -> None:
    f = np.linspace(0, 1, 5)

    def shapes(seed: int) -> list[Array]:
        return [s.positions(f) for s in islice(variants(Posed.of(replace(CLAMPED, seed=seed))), 6)]

    first, again, other = shapes(0), shapes(0), shapes(1)
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(a, b)
    assert all(np.abs(a - b).max() > 1e-3 for a, b in zip(first[3:], other[3:], strict=True))


def test_equal_seeds_find_the_same() -> None:
    first, again = (solve(replace(CLAMPED, starts=5, seed=3)) for _ in range(2))
    assert first.times == again.times
    assert first.energy == again.energy
    assert [f.energy for f in first.others] == [f.energy for f in again.others]


# Guesses.


BAD = "guess={strains: [50, 30]}"


def test_a_guess_that_leads_nowhere_is_followed_by_the_automatic_start(configs: Path) -> None:
    newton = "solver={type: newton}"
    found = solve(load_scene(configs / "moebius_half.yaml", [BAD, newton]))
    assert found.verified
    np.testing.assert_allclose(np.abs(found.n0), HALF_MOEBIUS["n0"], atol=1e-7)
    np.testing.assert_allclose(np.abs(found.m0), np.abs(HALF_MOEBIUS["m0"]), atol=1e-7)
    told = steps(found)
    assert told[0] == "guess: constant strains"
    assert told[1].startswith("newton") and told[1].endswith(")")  # what became of it
    automatic = next(i for i, step in enumerate(told) if step.startswith(AUTOMATIC))
    assert automatic > 1
    text = report(summarize(found))
    assert 0 < text.index("guess: constant strains") < text.index("twisted circle")


def test_the_automatic_start_can_be_left_out(configs: Path) -> None:
    prepared = prepare(load_scene(configs / "moebius_half.yaml", ["solver={type: newton}"]))
    shape = Helical(np.zeros(3), np.eye(3), np.array([0.0, 50.0, 30.0]), 0.5)
    alone = prepared.solve(guess=ShapeGuess(shape), fallback=False)
    assert not alone.verified
    assert not any(step.startswith(AUTOMATIC) for step in steps(alone))
    assert prepared.solve(guess=ShapeGuess(shape)).verified


ANGLE = 1.5
ARC = End(
    "clamped",
    ((1 - np.cos(ANGLE)) / ANGLE, 0.0, np.sin(ANGLE) / ANGLE),
    d2=(0, 1, 0),
    d3=(np.sin(ANGLE), 0, np.cos(ANGLE)),
)


def named(guess: str) -> list[str]:
    return [f"guess={guess}"]


@pytest.mark.parametrize(
    ("name", "overrides", "energy", "words"),
    [
        (
            "moebius_whole",
            ["boundary.loop.half_twists=0", *named("circle")],
            2 * np.pi**2,
            "circle",
        ),
        ("helix_clamped", named("{helix: {turns: 0.7, rise: 0.45}}"), 12.5, "helix"),
        ("helix_clamped", named("{strains: [3.5, 1.5]}"), 12.5, "constant strains"),
        (
            "moebius_half",
            named("{moebius: {half_twists: 1, piece: half}}"),
            HALF_MOEBIUS["H"] / 2,
            "twisted circle",
        ),
        (
            "moebius_half",
            named("{force: [0, 40, 40], moment: [0, 2, -9]}"),
            HALF_MOEBIUS["H"] / 2,
            "force and moment integrated from the start",
        ),
    ],
)
def test_named_guesses_lead_to_scenes_they_suit(
    solved: Solved, name: str, overrides: list[str], energy: float, words: str
) -> None:
    found = solved(name, *overrides)
    assert found.energy == pytest.approx(energy, abs=1e-8)
    assert steps(found)[0] == f"guess: {words}"
    assert not any(step.startswith(AUTOMATIC) for step in steps(found))


@pytest.mark.parametrize("guess", ["{arc: 80*deg}"])
def test_arcs_lead_to_arcs(guess: str, tmp_path: Path) -> None:
    # A circular arc held at both ends: no force, moment and strain the curvature.
    text = f"""
name: arc
law: {{type: sadowsky}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end:
    support: clamped
    position: [(1 - cos(a))/a, 0, sin(a)/a]
    directors: {{turns: [{{y: a}}]}}
parameters: {{a: {ANGLE}}}
guess: {guess}
"""
    (tmp_path / "arc.yaml").write_text(text, encoding="utf-8")
    found = solve(load_scene(tmp_path / "arc.yaml"))
    assert found.verified
    assert steps(found)[0] == "guess: circular arc"
    assert not any(step.startswith(AUTOMATIC) for step in steps(found))
    np.testing.assert_allclose(found.n0, 0, atol=1e-9)
    np.testing.assert_allclose(found.m0, [0, ANGLE, 0], atol=1e-9)
    assert found.energy == pytest.approx(ANGLE**2 / 2, abs=1e-10)


@pytest.mark.parametrize("formulation", ["inverted", "differentiated", "energy"])
def test_a_shape_is_a_guess_whatever_the_unknowns(solved: Solved, formulation: str) -> None:
    overrides = [f"formulation={formulation}", "law={type: variational, delta: 0.1}"]
    overrides += named("{moebius: {half_twists: 1, piece: half}}")
    found = solved("moebius_half", *overrides)
    assert not any(step.startswith(AUTOMATIC) for step in steps(found))
    assert agrees(2 * found.energy, VARIATIONAL[0.1][1])


def test_guesses_of_one_structure_can_be_asked_for_one_by_one() -> None:
    posed, ledger = Posed.of(CLAMPED), Ledger()
    guesses = list(islice(Automatic(posed).guesses(posed, ledger), 2))
    assert isinstance(guesses[0], Solution)
    assert guesses[0].scene.law == Variational(delta=0.1)  # that of the scene, not below it
    assert all(step["seconds"] >= 0 for step in ledger.steps)
    assert len(list(shapes_for(posed))) >= len(guesses)


# Dead forces where the energy is minimised.


@pytest.mark.parametrize(
    ("law", "at"), [(Sadowsky(), "end"), (Variational(delta=0.1), "start")], ids=["end", "start"]
)
def test_least_energy_under_a_dead_force_is_the_cantilever(law: Any, at: str) -> None:
    sign = 1.0 if at == "end" else -1.0
    free = End("free", force=(sign, 0, 0))
    ends = (CLAMP, free) if at == "end" else (free, CLAMP)
    found = solve(scene(*ends, law=law, formulation="energy"))
    assert found.verified, found.message
    r = found.sample([0.0, 1.0], "r")
    assert agrees(abs(float(r[1, 0] - r[0, 0])), CANTILEVER_DEFLECTION)
    # Loads are costates; at the clamp the moment is the force times its arm.
    np.testing.assert_allclose(found.n0, [sign, 0, 0], atol=1e-9)
    clamp, tip = found.sample([0.0, 1.0] if at == "end" else [1.0, 0.0], "m")
    np.testing.assert_allclose(tip, 0, atol=1e-9)
    np.testing.assert_allclose(np.abs(clamp), [0, abs(r[1, 2] - r[0, 2]), 0], atol=1e-9)
    assert summarize(found)["loads_from"] == "costates"


@pytest.mark.parametrize(
    "end",
    [
        End("free", force=(1, 2, -3)),
        End("sliding", (0, 0.2, 1), directors="identity", along=(0, 1, 1), force=AnyVector(z=-5)),
    ],
)
def test_least_energy_and_equilibrium_agree_under_dead_forces(end: End) -> None:
    law = Variational(delta=0.3)
    fine = Collocation(degree=6, intervals=24)
    ends = (CLAMP, end)
    a = solve(scene(*ends, law=law, transcription=fine))
    b = solve(scene(*ends, law=law, formulation="energy", transcription=fine))
    scale = float(np.abs([*a.n0, *a.m0]).max())
    np.testing.assert_allclose(b.n0, a.n0, atol=1e-6 * scale)
    np.testing.assert_allclose(b.m0, a.m0, atol=1e-6 * scale)
    np.testing.assert_allclose(b.sample(1.0, "r"), a.sample(1.0, "r"), atol=1e-6)


@pytest.mark.parametrize(
    "end",
    [
        End("free", moment=(0, 1, 0)),
        End("free", force=AnyVector(d1=0, d2=1, d3=0)),
        End("pinned", (0, 0, 0.8), moment=(0, 1, 0)),
        End("held", distance=0.6, moment=(0, 0.1, 0)),
    ],
)
def test_loads_without_a_potential_are_refused_where_energy_is_minimised(end: End) -> None:
    with pytest.raises(ModelError, match="has no potential"):
        solve(scene(CLAMP, end, formulation="energy"))
