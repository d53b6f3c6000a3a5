"""Conditions that leave the ribbon free to move, or a loop to slide along itself, are refused."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem import Posed, formulate
from ribbonopt.problem.wellposed.examine import examine
from ribbonopt.problem.wellposed.linearized import Linearized, linearize
from ribbonopt.problem.wellposed.motions import along_itself, rigid, unopposed
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.scene.units import in_special_units

CONFIGS = Path(__file__).parents[3] / "configs"
NAMES = sorted(path.stem for path in CONFIGS.glob("*.yaml"))
REVERSED = "{d1: [-1, 0, 0], d2: [0, -1, 0], d3: [0, 0, 1]}"


def scene_of(boundary: str, **other: str) -> Scene:
    lines = {"name": "test", "law": "{type: sadowsky}", "boundary": boundary} | other
    return loads_scene("\n".join(f"{key}: {value}" for key, value in lines.items()))


def looked_at(scene: Scene) -> None:
    posed = Posed.of(scene)
    examine(*formulate(posed), posed)


def refusal(scene: Scene) -> ModelError:
    with pytest.raises(ModelError) as error:
        looked_at(scene)
    return error.value


def linearized(scene: Scene) -> Linearized:
    posed = Posed.of(scene)
    return linearize(formulate(posed)[0], posed)


# --- what is refused ---------------------------------------------------------------------------

PINNED = "{start: {%s}, end: {position: [%s], moment: [0, 0, 0]}}"
NO_MOMENT = "position: [0, 0, 0], moment: [0, 0, 0]"
FREE = "force: [0, 0, 0], moment: [0, 0, 0]"
REFUSED = [
    (
        PINNED % (NO_MOMENT, "0, 0, 0.7"),
        r"to turn about the line through its ends\. Exchange one of boundary\.start\.moment\.z, "
        r"boundary\.end\.moment\.z for",
        "boundary.end.moment.z",
    ),
    (
        PINNED % (NO_MOMENT, "0.1, -0.3, 0.6"),
        r"to turn about the line through its ends\. Exchange one of .*support: hinged",
        "boundary.end.moment.z",
    ),
    (
        "{start: {support: pinned, position: [0, 0, 0]}, "
        "end: {support: pinned, position: [0, 0, 0.7]}}",
        "to turn about the line through its ends",
        "boundary.end.moment.z",
    ),
    (
        f"{{start: {{{FREE}}}, end: {{{FREE}}}}}",
        r"to move and to turn as a whole\. Exchange 6 of .*position: \[0, 0, 0\] and "
        r"boundary\.start\.directors: identity",
        "boundary.end.moment.z",
    ),
    (
        "{start: {force: [0, 0, 1], moment: [0, 0, 0]}, end: {force: [0, 0, 1], "
        "moment: [0, 0, 0]}}",
        r"to move in every direction and to turn about z\. Exchange 4 of",
        "boundary.end.moment.z",
    ),
    (
        "{start: {force: {d1: 0, d2: 1, d3: 2}, moment: {d1: 0, d2: 1, d3: 2}}, "
        "end: {force: {d1: 0, d2: 1, d3: 2}, moment: {d1: 0, d2: 1, d3: 2}}}",
        "to move and to turn as a whole",
        "boundary.end.moment.d3",
    ),
    (
        "{start: {support: pinned, position: [1, 2, 3]}, end: {support: free}}",
        r"to turn in every direction\. Exchange 3 of .*for example boundary\.start\.directors: "
        "identity",
        "boundary.end.moment.z",
    ),
    (
        "{start: {support: hinged, position: [0, 0, 0], axis: d2, along: [0, 1, 0]}, "
        "end: {support: free}}",
        "to turn about the y axis",
        "boundary.end.moment.y",
    ),
    (
        "{start: {support: sliding, position: [0, 0, 0], along: [0, 0.6, 0.8], "
        "directors: identity}, end: {support: free}}",
        r"to move along \(0, 0.6, 0.8\)",
        "boundary.end.force.z",
    ),
    (
        "{start: {support: pinned, position: [0, 0, 0]}, end: {force: [1, 0, 0], "
        "moment: [0, 0, 0]}}",
        "to turn about",
        "boundary.end.moment.x",
    ),
    (
        "{start: {support: flip, position: [0, 0, 0], along: [1, 0, 0], axis: d1}, "
        "end: {support: flip, position: [0, 0, 0], along: [1, 0, 0], axis: d2}}",
        "to move along x and to turn about the line through its ends",
        "boundary.end.moment.d2",
    ),
    (
        "{start: {position: {y: 0, z: 0}, directors: identity, force: {d1: 0, d2: 3}, "
        "moment: {d1: 0}}, end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}}",
        r"to move along x\. Exchange one of .* for example boundary\.start\.position: \{x: 0\}",
        "boundary.start.moment.d1",
    ),
]


@pytest.mark.parametrize(("boundary", "words", "key"), REFUSED)
def test_free_motions_are_refused(boundary: str, words: str, key: str) -> None:
    error = refusal(scene_of(boundary))
    assert re.search(f"leave the ribbon free {words}", str(error)), error
    assert error.key == key


def test_as_a_half_loop_without_its_place_the_ribbon_would_move() -> None:
    # The half Moebius ribbon, its start anywhere on the x axis, and no other condition for that.
    half = load_scene(CONFIGS / "moebius_half.yaml", ["boundary.start.position={y: 0, z: 0}"])
    assert "1 missing" in str(refusal(half))


CLAMPED_LOOP = (
    "{start: {position: [%s], directors: identity}, end: {position: [%s], directors: %s}}"
)


def test_a_clamped_loop_may_slide_along_itself() -> None:
    error = refusal(scene_of(CLAMPED_LOOP % ("0, 0, 0", "0, 0, 0", REVERSED)))
    assert "the loop may slide along itself" in str(error)
    assert "replace boundary.end.position by {y: 0, z: 0} and add force: {d1: 0}" in str(error)
    assert error.key == "boundary.end.position"


@pytest.mark.parametrize(
    "boundary",
    [
        CLAMPED_LOOP % ("0.3, 0, 2", "0.3, 0, 2", REVERSED),
        "{start: {position: [0, 0, 0], directors: identity}, also: [r(end) = r(start)], "
        f"end: {{directors: {REVERSED}}}}}",
        "{start: {position: [0, 0, 0], directors: {turns: [{x: 0.3}, {y: 1}]}}, end: "
        "{position: [0, 0, 0], directors: {turns: [{x: 0.3}, {y: 1}, {d3: pi}]}}}",
    ],
)
def test_a_clamped_loop_may_slide_however_it_is_written(boundary: str) -> None:
    error = refusal(scene_of(boundary))
    assert "slide along itself" in str(error)
    assert "boundary: {loop: {half_twists: 1}}" in str(error)


def test_where_the_energy_is_minimised_a_loop_may_slide() -> None:
    law = "{type: variational, delta: 0.1}"
    loop = CLAMPED_LOOP % ("0, 0, 0", "0, 0, 0", REVERSED)
    looked_at(scene_of(loop, law=law, formulation="energy"))
    assert "slide" in str(refusal(scene_of(loop, law=law)))


def test_a_circle_held_at_one_point_is_isolated() -> None:
    # Sliding only turns it, and the clamp undoes that: solved, quadratically.
    loop = CLAMPED_LOOP % ("0, 0, 0", "0, 0, 0", "identity")
    found = solve(scene_of(loop, guess="{strains: [6.1, 0.2]}", solver="{type: newton}"))
    assert found.verified, found.message
    np.testing.assert_allclose(found.m0, [0, 2 * np.pi, 0], atol=1e-9)


# --- the remedies that are proposed work ---------------------------------------------------------


def test_the_hinge_that_is_proposed_is_accepted() -> None:
    message = str(refusal(scene_of(REFUSED[0][0])))
    hinge = message.rpartition("boundary.start: {")[2].rstrip("}")
    looked_at(scene_of(PINNED % (hinge, "0, 0, 0.7")))


def test_the_exchange_that_is_proposed_is_accepted_and_solved() -> None:
    message = str(refusal(scene_of(REFUSED[0][0])))
    exchanged = re.search(r"for example boundary\.start\.(d\d: \{.: 0\})", message)
    assert exchanged is not None
    start = f"position: [0, 0, 0], moment: {{x: 0, y: 0}}, {exchanged[1]}"
    found = solve(scene_of(PINNED % (start, "0, 0, 0.75"), guess="{strains: [3, 0.1]}"))
    assert found.verified, found.message
    np.testing.assert_allclose(found.m0, 0, atol=1e-8)


def test_the_gauge_that_is_proposed_for_a_loop_is_accepted() -> None:
    loop = "{start: {position: [0, 0, 0], directors: identity, force: {d1: 0}}, end: {position: "
    looked_at(scene_of(f"{loop}{{y: 0, z: 0}}, directors: {REVERSED}}}}}"))
    looked_at(scene_of("{loop: {half_twists: 1}}"))


def test_the_place_that_is_proposed_for_a_free_ribbon_is_accepted() -> None:
    start = "position: [0, 0, 0], directors: identity"
    looked_at(scene_of(f"{{start: {{{start}}}, end: {{{FREE}}}}}"))


# --- good scenes are not refused ---------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", [0.3, 0.8, 0.55])
def test_shipped_scenes_hold_the_ribbon(name: str, seed: float) -> None:
    conditions = linearized(in_special_units(load_scene(CONFIGS / f"{name}.yaml")))
    z = conditions.satisfied(seed)
    assert z is not None
    assert np.abs(conditions.at(z)[0]).max() < 1e-9
    motions = rigid(conditions, z) @ conditions.ribbon.model.motions
    assert unopposed(conditions, z, motions).shape[1] == 0


@pytest.mark.parametrize("name", NAMES)
def test_shipped_scenes_are_not_refused(name: str) -> None:
    looked_at(in_special_units(load_scene(CONFIGS / f"{name}.yaml")))


numbers = st.floats(-1, 1, allow_subnormal=False)
triples = st.tuples(numbers, numbers, numbers).map(
    lambda t: f"[{t[0]:.6f}, {t[1]:.6f}, {t[2]:.6f}]"
)


@given(triples, triples, triples, triples)
def test_clamps_hold_the_ribbon(r0: str, w0: str, r1: str, w1: str) -> None:
    end = "{position: %s, directors: {rotation_vector: %s}}"
    looked_at(scene_of(f"{{start: {end % (r0, w0)}, end: {end % (r1, w1)}}}"))


@pytest.mark.slow
@given(triples, triples, triples, st.sampled_from(["%s", "{d1: 0, d2: 1, d3: %.3s}"]))
def test_a_clamp_and_loads_hold_the_ribbon(r: str, force: str, moment: str, form: str) -> None:
    start = f"{{position: {r}, directors: identity}}"
    load = form % force.strip("[") if "d1" in form else force
    looked_at(scene_of(f"{{start: {start}, end: {{force: {load}, moment: {moment}}}}}"))


SUPPORTS = {
    "clamped": "position: [0, 0, 0], directors: {rotation_vector: [0.1, 0.2, 0.3]}",
    "pinned": "position: [0.1, 0.2, 0.6]",
    "hinged": "position: [0.1, 0.2, 0.4], axis: d2, along: [0.6, 0, 0.8]",
    "sliding": "position: [0, 0.1, 0], along: [0, 0.6, 0.8], directors: identity",
    "flip": "position: [0.1, 0, 0], along: [0.6, 0.8, 0], axis: d1",
    "free": "force: [1, 0, 0]",
    "held": "distance: 0.4",
}


@pytest.mark.parametrize("support", SUPPORTS)
@pytest.mark.parametrize("turned", [False, True])
def test_a_clamp_and_any_support_hold_the_ribbon(support: str, turned: bool) -> None:
    ends = [f"{{support: {name}, {SUPPORTS[name]}}}" for name in ("clamped", support)]
    start, end = reversed(ends) if turned and support != "held" else ends
    looked_at(scene_of(f"{{start: {start}, end: {end}}}"))


@pytest.mark.parametrize("k", [-3, -1, 1, 2, 4])
@pytest.mark.parametrize("piece", ["whole", "half", "fundamental"])
def test_loops_hold_the_ribbon(k: int, piece: str) -> None:
    if abs(k) > 1 or piece != "fundamental":
        looked_at(scene_of(f"{{loop: {{half_twists: {k}, piece: {piece}}}}}"))


@pytest.mark.parametrize("states", ["reduced", "full"])
@pytest.mark.parametrize("interval", ["[0, 0.001]", "[5, 400]"])
def test_the_length_does_not_matter(states: str, interval: str) -> None:
    other = {"states": states, "interval": interval}
    size = 0.0007 if "001" in interval else 300
    far = f"[0, 0, {size}]"
    looked_at(scene_of(CLAMPED_LOOP % ("0, 0, 0", far.strip("[]"), "identity"), **other))
    pinned = scene_of(PINNED % (NO_MOMENT, far.strip("[]")), **other)
    assert "to turn about the line through its ends" in str(refusal(pinned))
    loop = scene_of(CLAMPED_LOOP % ("0, 0, 0", "0, 0, 0", REVERSED), **other)
    assert "slide" in str(refusal(loop))


# --- the motions themselves --------------------------------------------------------------------


def fields_at(conditions: Linearized, z: np.ndarray) -> RodFields:
    """Fields of both ends that the unknowns z stand for."""
    section = conditions.ribbon.section_function
    values = conditions.posed.values
    rows = [section(x, z[14:], values, 0.0) for x in (z[:7], z[7:14])]
    r, d1, d2, d3, n, m = (np.array([np.array(row[i]).ravel() for row in rows]) for i in range(6))
    return RodFields(r, np.stack([d1, d2, d3], axis=2), n, m)


@pytest.mark.parametrize("column", range(6))
def test_motions_are_those_of_the_fields(column: int) -> None:
    scene = scene_of(CLAMPED_LOOP % ("1, -2, 0.5", "0.7, -2, 0.5", "identity"), interval="[0, 2]")
    conditions = linearized(scene)
    z, step = conditions.generic(0.3), 1e-6
    before = fields_at(conditions, z)
    after = []
    for sign in (1, -1):
        vector = sign * step * np.eye(6)[column]
        turn = Rotation.from_rotvec(vector[3:]).as_matrix()
        origin = conditions.reference
        moved = RodFields(
            origin + 2 * vector[:3] + (before.r - origin) @ turn.T,
            turn @ before.frames,
            before.n @ turn.T,
            before.m @ turn.T,
        )
        x, c = conditions.ribbon.model.pack(moved, origin)
        q = x.reshape(2, 7)[:, 3:]
        q *= np.sign(np.sum(q * np.array([z[3:7], z[10:14]]), axis=1, keepdims=True))
        after.append(np.concatenate([x.ravel(), c]))
    expected = (after[0] - after[1]) / (2 * step)
    np.testing.assert_allclose(rigid(conditions, z)[:, column], expected, atol=1e-8)


def test_sliding_is_the_solution_one_step_on() -> None:
    scene = load_scene(CONFIGS / "moebius_half.yaml")
    found, conditions = solve(scene), linearized(scene)

    def ends(shift: float) -> np.ndarray:
        x = found.dense.states(0, np.array([0.2 + shift / 0.5, 0.7 + shift / 0.5]))
        return np.concatenate([x.ravel(), found.constants])

    expected = 0.5 * (ends(1e-5) - ends(-1e-5)) / 2e-5
    np.testing.assert_allclose(along_itself(conditions, ends(0))[:, 0], expected, atol=1e-6)


def test_looking_costs_little() -> None:
    scene = load_scene(CONFIGS / "moebius_half.yaml")
    posed = Posed.of(scene)
    ribbon, problem = formulate(posed)
    calls = 0

    def count(_frame: object, event: str, _argument: object) -> None:
        nonlocal calls
        calls += event in ("call", "c_call")

    # Counted, not timed: the same on any machine.
    before = sys.getprofile()
    sys.setprofile(count)
    try:
        examine(ribbon, problem, posed)
    finally:
        sys.setprofile(before)
    assert 0 < calls < 10_000  # 4,500; solving this scene takes 20,000
