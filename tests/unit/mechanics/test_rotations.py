"""Quaternions and frames: one rotation, whichever way it is written."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ribbonopt.mechanics.rotations import directors_of, product, quaternions_from

unit = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)


def frame(q: np.ndarray) -> np.ndarray:
    """Return the matrix whose columns are the directors of q."""
    return np.array(ca.horzcat(*directors_of(ca.DM(q))))


@given(q=unit)
def test_directors_are_the_columns_of_the_rotation_matrix(q: tuple[float, ...]) -> None:
    a = np.array(q) / np.linalg.norm(q)
    expected = Rotation.from_quat(np.roll(a, -1)).as_matrix()
    np.testing.assert_allclose(frame(a), expected, atol=1e-15)


@given(p=unit, q=unit)
def test_product_turns_one_rotation_after_the_other(
    p: tuple[float, ...], q: tuple[float, ...]
) -> None:
    a, b = (np.array(x) / np.linalg.norm(x) for x in (p, q))
    np.testing.assert_allclose(frame(np.array(product(a, b))), frame(a) @ frame(b), atol=1e-14)


@given(q=unit)
def test_quaternion_of_a_frame_gives_the_frame_back(q: tuple[float, ...]) -> None:
    a = np.array(q) / np.linalg.norm(q)
    (found,) = quaternions_from(frame(a)[None])
    np.testing.assert_allclose(frame(found), frame(a), atol=1e-14)
    assert np.linalg.norm(found) == pytest.approx(1, abs=1e-15)
    assert found[0] >= 0


@pytest.mark.parametrize("axis", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, -2, 3]])
@pytest.mark.parametrize("beyond", [0, 1e-16, 1e-9, -1e-9, 1e-4])
def test_half_turns_are_no_exception(axis: list[int], beyond: float) -> None:
    R = Rotation.from_rotvec((np.pi + beyond) * np.array(axis) / np.linalg.norm(axis)).as_matrix()
    (q,) = quaternions_from(R[None])
    np.testing.assert_allclose(frame(q), R, atol=1e-14)


def test_quaternions_of_a_continuous_frame_are_continuous() -> None:
    angle = np.linspace(0, 8 * np.pi, 400)
    axis = np.array([0.6, 0.0, 0.8])
    q = quaternions_from(Rotation.from_rotvec(angle[:, None] * axis).as_matrix())
    half = angle[:, None] / 2
    expected = np.hstack([np.cos(half), np.sin(half) * axis])
    np.testing.assert_allclose(q, expected, atol=1e-13)
