"""States in a plane: the same equilibria as in space, by less than half of the unknowns."""

from collections.abc import Callable
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from references import ELASTICA, agrees
from scipy.spatial.transform import Rotation

from ribbonopt import Continuation, load_solution, save_solution
from ribbonopt.errors import ModelError
from ribbonopt.mechanics.planar import Plane, planar_model
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import Scene, load_scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import value_of

PLANES = [Plane(axis, sign) for axis in range(3) for sign in (1, -1)]
each_plane = pytest.mark.parametrize("plane", PLANES, ids=str)
REFERENCE = np.array([0.3, -0.2, 0.5])


def frame_at(plane: Plane, turn: float) -> np.ndarray:
    """Return d1, d2, d3 as columns, turned about d2 by an angle."""
    a, b = plane.basis
    normal = plane.sign * np.eye(3)[plane.axis]
    cos, sin = np.cos(turn), np.sin(turn)
    return np.stack([cos * a - sin * b, normal, sin * a + cos * b], axis=1)


def fields_in(plane: Plane, count: int = 12) -> RodFields:
    """Return random cross sections in a plane; n constant and m its integral."""
    rng = np.random.default_rng(4)
    inside, k = list(plane.inside), plane.axis
    r = np.tile(REFERENCE, (count, 1))
    r[:, inside] = rng.standard_normal((count, 2))
    n = np.zeros(3)
    n[inside] = rng.standard_normal(2)
    m = np.zeros((count, 3))
    m[:, k] = rng.standard_normal() + np.cross(n, r - r[0])[:, k]
    turns = np.cumsum(rng.uniform(-3, 3, count))
    frames = np.stack([frame_at(plane, turn) for turn in turns])
    return RodFields(r, frames, np.tile(n, (count, 1)), m)


@each_plane
def test_fields_are_packed_without_loss_and_move_by_the_equations(plane: Plane) -> None:
    model, fields, u2 = planar_model((), ca.SX.sym, plane), fields_in(plane), 0.7
    x, c = model.pack(fields, REFERENCE)
    assert x.shape[1] == len(model.states) == 3
    assert len(c) == len(model.constants) == 3
    symbols = ca.SX.sym("x", 3), ca.SX.sym("c", 3)
    section = model.section(*symbols, ca.SX(0), ca.SX(REFERENCE))
    values = ca.vertcat(*(getattr(section, key) for key in ("r", "d1", "d2", "d3", "n", "m")))
    rates = model.rates(symbols[0], section, ca.DM([0, u2, 0]))
    both = [ca.densify(values), ca.densify(ca.jtimes(values, symbols[0], rates))]
    function = ca.Function("f", list(symbols), both)
    for i in range(len(x)):
        found, slopes = (np.array(part).reshape(6, 3) for part in function(x[i], c))
        frame, n = fields.frames[i], fields.n[i]
        expected = [fields.r[i], *frame.T, n, fields.m[i]]
        np.testing.assert_allclose(found, expected, atol=1e-13)
        turning = np.cross(u2 * frame[:, 1], frame.T)  # (2.2)
        expected = [frame[:, 2], *turning, np.zeros(3), np.cross(n, frame[:, 2])]
        np.testing.assert_allclose(slopes, expected, atol=1e-13)


@each_plane
def test_motions_are_those_of_the_fields(plane: Plane) -> None:
    model, fields = planar_model((), ca.SX.sym, plane), fields_in(plane, 1)
    x, c = model.pack(fields, REFERENCE)
    changes, step = model.moved(x[0], c, REFERENCE), 1e-6
    for column in [*plane.inside, 3 + plane.axis]:
        move = step * np.eye(6)[column]
        turn = Rotation.from_rotvec(move[3:]).as_matrix()
        r = REFERENCE + move[:3] + (fields.r - REFERENCE) @ turn.T
        there = RodFields(r, turn @ fields.frames, fields.n @ turn.T, fields.m @ turn.T)
        after = model.pack(there, REFERENCE)
        for change, old, new in zip(changes, (x[0], c), (after[0][0], after[1]), strict=True):
            np.testing.assert_allclose(change[:, column], (new - old) / step, atol=1e-5)
    assert model.motions.shape == (6, 3)


def clamped(plane: Plane, distance: float, states: str) -> Scene:
    """Return a strip between two clamps at a distance, in any plane, its start off the origin."""
    frame, start = frame_at(plane, 0.4), REFERENCE
    end = start + distance * frame[:, 2]
    rows = ", ".join(f"{d}: {frame[:, i].tolist()}" for i, d in enumerate(("d1", "d2", "d3")))
    return loads_scene(
        f"""
name: strip
law: {{type: sadowsky}}
states: {states}
boundary:
  start: {{position: {start.tolist()}, directors: {{{rows}}}}}
  end: {{position: {end.tolist()}, directors: {{{rows}}}}}
transcription: {{type: collocation, degree: 8, intervals: 16}}
"""
    )


@each_plane
def test_the_elastica_of_any_plane(plane: Plane) -> None:
    found = solve(clamped(plane, 0.75, "planar"))
    assert found.verified, found.message
    assert agrees(found.energy, ELASTICA[0.25].energy)
    assert found.dense.blocks.layout.nx == 3
    np.testing.assert_allclose(found.n0 @ frame_at(plane, 0.4)[:, 1], 0, atol=1e-15)
    spatial = solve(clamped(plane, 0.75, "reduced"))
    np.testing.assert_allclose(np.linalg.norm(found.n0), np.linalg.norm(spatial.n0), rtol=1e-10)


HINGES = """
name: hinges
law: {{type: variational, delta: 0.1}}
states: {states}
boundary:
  start: {{support: pinned, position: [0, 0, 0]}}
  end: {{support: pinned, position: [0, 0, 0.7]}}
"""


def test_pins_at_both_ends_determine_a_planar_ribbon_and_no_spatial_one() -> None:
    found = solve(loads_scene(HINGES.format(states="planar")))
    assert found.verified, found.message
    assert np.abs(found.sample(np.linspace(0, 1, 11), "r")[:, 1]).max() == 0
    assert abs(found.sample(0.5, "dot(r, ex)")) > 0.2
    with pytest.raises(ModelError, match="turn about the line through its ends"):
        solve(loads_scene(HINGES.format(states="reduced")))


@pytest.mark.parametrize(
    ("override", "match"),
    [
        ("boundary.end.position=[0, 0.1, 0.7]", r"boundary\.end\.position\.y leads out .*0\.1"),
        ("boundary.end.moment={x: 1, y: 0, z: 0}", r"boundary\.end\.moment\.x leads out"),
        ("loads.force={y: 1}", r"loads\.force leads out of the plane"),
        (
            "boundary.start={position: [0, 0, 0], directors: {turns: [{x: 0.3}]}}",
            r"d2 at the start along an axis",
        ),
        ("boundary.start={position: [0, 0, 0]}", r"1 missing: prescribe 1 more"),
        ("formulation=energy", r"stated in space.*use states: reduced"),
    ],
)
def test_what_is_not_planar_is_refused(tmp_path: Path, override: str, match: str) -> None:
    (tmp_path / "scene.yaml").write_text(HINGES.format(states="planar"), encoding="utf-8")
    with pytest.raises(ModelError, match=match):
        prepare(load_scene(tmp_path / "scene.yaml", [override]))


@pytest.mark.parametrize("formulation", ["inverted", "algebraic", "differentiated"])
def test_every_equilibrium_form(configs: Path, formulation: str) -> None:
    overrides = ["states=planar", f"formulation={formulation}"]
    found = solve(load_scene(configs / "cantilever.yaml", overrides))
    assert found.verified, found.message
    assert found.sample(1.0, "dot(r, ex)") == pytest.approx(0.3017207738, abs=1e-9)


def test_saved_and_loaded(solved: Callable[..., Solution], tmp_path: Path) -> None:
    found = solved("elastica_clamped", "states=planar")
    save_solution(found, tmp_path)
    s = np.linspace(0, 1, 7)
    np.testing.assert_array_equal(load_solution(tmp_path).sample(s, "r"), found.sample(s, "r"))


def test_the_snap_has_its_fold_in_the_plane_too(configs: Path) -> None:
    folds = []
    for states in ("planar", "reduced"):
        branch = list(Continuation(load_scene(configs / "snap.yaml", [f"states={states}"])))
        folds += [value_of(p.row) for p in branch if p.kind == "fold"]
        assert next(p.row["negative"] for p in branch if p.kind == "point") == 0
    assert len(folds) == 2
    assert folds[0] == pytest.approx(folds[1], abs=1e-9)
