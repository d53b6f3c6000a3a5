"""What is seen of a surface: its two sides, what is in front, and what is allowed in a plane."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba

from ribbonopt.views.camera import Camera
from ribbonopt.views.facets import BACK, FRONT, draw_surface
from ribbonopt.views.pieces import Piece
from ribbonopt.views.plane import _shade
from ribbonopt.views.style import ALLOWED, FORBIDDEN, blank
from ribbonopt.views.surface import sweep

AXES = np.eye(3)
ABOVE = Camera(AXES[0], AXES[1], AXES[2])
BELOW = Camera(AXES[0], -AXES[1], -AXES[2])


def strip(height: float, start: float, facing: float = 1.0) -> Piece:
    """Return rows of a flat strip along x at a height z, its side d1 up or down."""
    s, zero = start + np.linspace(0, 1, 21), np.zeros(21)
    d1, d3 = facing * np.tile(AXES[2], (21, 1)), np.tile(AXES[0], (21, 1))
    r = np.stack([s - start, zero, zero + height], axis=1)
    return Piece(s, zero, zero, zero, zero, r, d1, np.cross(d3, d1), d3)


def hue(colour: np.ndarray) -> np.ndarray:
    """Return a colour without its brightness, by which it is lit."""
    return np.asarray((colour[:3] - colour[:3].mean()) / np.ptp(colour[:3]))


@pytest.mark.parametrize(("camera", "facing"), [(ABOVE, 1), (ABOVE, -1), (BELOW, 1), (BELOW, -1)])
def test_the_side_of_d1_has_the_colour_of_the_front(camera: Camera, facing: int) -> None:
    drawing = draw_surface(sweep((strip(0.0, 0.0, facing),)), camera)
    expected = FRONT if facing * camera.towards[2] > 0 else BACK
    faces = drawing.faces[drawing.faces[:, 3] == 1]
    assert len(faces) > 100
    for colour in faces:
        np.testing.assert_allclose(hue(colour), hue(expected), atol=0.05)


@pytest.mark.parametrize(("camera", "last"), [(ABOVE, FRONT), (BELOW, BACK)])
def test_what_is_nearer_is_painted_later(camera: Camera, last: np.ndarray) -> None:
    # The lower strip shows its back to who looks from below, the upper its front from above.
    drawing = draw_surface(sweep((strip(0.0, 0.0), strip(0.5, 1.0))), camera)
    faces = np.flatnonzero(drawing.faces[:, 3] == 1)
    half = len(faces) // 2
    # Haze whitens what is far.
    far, near = (drawing.faces[rows, :3].mean(axis=0) for rows in (faces[:half], faces[half:]))
    assert (far > near).all()
    np.testing.assert_allclose(hue(near), hue(last), atol=0.05)


def test_the_region_of_one_sheet_is_drawn_as_allowed() -> None:
    axes = blank(4, 4).add_subplot()
    _shade(axes, 10.0)
    rng = np.random.default_rng(2)
    for u2, u3 in rng.uniform(-4, 4, size=(40, 2)):
        found = {p.get_facecolor() for p in axes.patches if p.get_path().contains_point((u2, u3))}
        assert found == {to_rgba(ALLOWED if abs(u3) < abs(u2) else FORBIDDEN)}
