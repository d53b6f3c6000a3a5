"""The rod: its two descriptions are one mechanics, that of eqs. (2.1)-(2.7)."""

import casadi as ca
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from ribbonopt.mechanics.model import full_model, least_model
from ribbonopt.mechanics.section import RodFields

MODELS = {"reduced": least_model((), ca.SX.sym), "full": full_model((), ca.SX.sym)}
each_model = pytest.mark.parametrize("name", MODELS)
REFERENCE = np.array([0.3, -0.2, 0.5])
NAMES = ("r", "d1", "d2", "d3", "n", "m")


def random_fields(count: int, seed: int = 0) -> RodFields:
    """Return random cross sections; n constant and m its integral, as without loads."""
    rng = np.random.default_rng(seed)
    r = rng.standard_normal((count, 3))
    n, m = rng.standard_normal((2, 3))
    moments = m + np.cross(n, r - r[0])
    return RodFields(
        r,
        Rotation.from_quat(rng.standard_normal((count, 4))).as_matrix(),
        np.tile(n, (count, 1)),
        moments,
    )


def section(name: str) -> ca.Function:
    """Return (x, c, u) -> all lab vectors of the cross section, and their derivatives along s."""
    model = MODELS[name]
    x, c = ca.SX.sym("x", len(model.states)), ca.SX.sym("c", len(model.constants))
    u = ca.SX.sym("u", 3)
    rod = model.section(x, c, ca.SX(0), ca.SX(REFERENCE))
    values = ca.vertcat(*(getattr(rod, key) for key in NAMES))
    return ca.Function("section", [x, c, u], [values, ca.jtimes(values, x, model.rates(x, rod, u))])


def evaluated(name: str, fields: RodFields, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    x, c = MODELS[name].pack(fields, REFERENCE)
    found = [section(name)(row, c, u) for row in x]
    return tuple(np.array([np.array(f[i]).ravel() for f in found]) for i in (0, 1))


@each_model
def test_fields_are_packed_without_loss(name: str) -> None:
    f = random_fields(20)
    values, _ = evaluated(name, f, np.zeros(3))
    directors = f.frames.swapaxes(1, 2).reshape(-1, 9)
    np.testing.assert_allclose(values, np.hstack([f.r, directors, f.n, f.m]), atol=1e-13)


@each_model
def test_states_and_constants_are_as_many_as_their_names(name: str) -> None:
    x, c = MODELS[name].pack(random_fields(4), REFERENCE)
    assert x.shape == (4, len(MODELS[name].states))
    assert c.shape == (len(MODELS[name].constants),)


@each_model
def test_rates_are_the_equations_of_the_paper(name: str) -> None:
    f, u = random_fields(20, seed=1), np.array([0.4, -1.3, 2.1])
    _, rates = evaluated(name, f, u)
    darboux = f.frames @ u
    d1, d2, d3 = (f.frames[:, :, i] for i in range(3))
    turning = [np.cross(darboux, d) for d in (d1, d2, d3)]  # (2.2)
    expected = [d3, *turning, np.zeros_like(f.n), np.cross(f.n, d3)]  # (2.1), (2.6), (2.7)
    np.testing.assert_allclose(rates, np.hstack(expected), atol=1e-13)


@each_model
def test_components_along_the_directors(name: str) -> None:
    f = random_fields(1, seed=2)
    x, c = MODELS[name].pack(f, REFERENCE)
    rod = MODELS[name].section(ca.DM(x[0]), ca.DM(c), ca.DM(0), ca.DM(REFERENCE))
    np.testing.assert_allclose(
        np.array(rod.along(rod.m)).ravel(), f.frames[0].T @ f.m[0], atol=1e-13
    )


@each_model
def test_frames_are_normal_where_the_normalisation_says_so(name: str) -> None:
    model = MODELS[name]
    x = model.pack(random_fields(1), REFERENCE)[0][0]
    residuals = [float(v) for v in model.start_conditions(ca.DM(x)).values()]
    np.testing.assert_allclose(residuals, 0, atol=1e-14)
    longer = [abs(float(v)) for v in model.start_conditions(ca.DM(1.1 * x)).values()]
    assert max(longer) > 0.1


@each_model
def test_normalisation_and_alignment_together_fix_the_frame(name: str) -> None:
    model = MODELS[name]
    q = np.array([0.5, -0.1, 0.7, 0.5]) / np.linalg.norm([0.5, -0.1, 0.7, 0.5])
    frame = Rotation.from_quat(np.roll(q, -1)).as_matrix()
    f = random_fields(1)
    at = model.pack(RodFields(f.r, frame[None], f.n, f.m), REFERENCE)[0][0]
    x = ca.SX.sym("x", len(at))
    equations = ca.vertcat(
        *model.alignment(x, ca.DM(q)).values(), *model.start_conditions(x).values()
    )
    values = ca.Function("f", [x], [equations, ca.densify(ca.jacobian(equations, x))])(at)
    assert np.abs(np.array(values[0])).max() < 1e-14
    columns = slice(3, 3 + len(model.orientation.names))
    singular = np.linalg.svd(np.array(values[1])[:, columns], compute_uv=False)
    assert equations.numel() == len(model.orientation.names)
    assert singular[-1] > 0.1


@each_model
def test_alignment_measures_the_turn_between_frames(name: str) -> None:
    model, angle = MODELS[name], 1e-6
    axis = np.array([0.0, 0.6, 0.8])
    f = random_fields(1)
    turned = Rotation.from_rotvec(angle * axis).as_matrix()[None]
    x = model.pack(RodFields(f.r, turned, f.n, f.m), REFERENCE)[0][0]
    turns = ca.vertcat(*model.alignment(ca.DM(x), ca.DM([1, 0, 0, 0])).values())
    found = np.array(ca.evalf(ca.SX(turns))).ravel()
    np.testing.assert_allclose(found, angle * axis, rtol=1e-9, atol=1e-15)
