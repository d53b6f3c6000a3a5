"""An orthographic camera that finds its own place, and light.

It looks so that the centre line encloses much area and the ribbon shows much of its face: about
along the direction of least extent, raised where that would show a planar ribbon edge-on.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.scene.faults import shown

from .pieces import Array

DIRECTIONS = 600
LIGHT = np.array([-0.45, 0.6, 0.66])  # to the right, up, towards the viewer
UP = np.array([1.0, 0.5, 0.8])  # up in the picture and towards the viewer, if there is a choice
CHOICE = 0.03  # views this close to the best are as good
AMBIENT = 0.5
GLOSS = 0.16
ONE_WAY = 0.5  # mean of unit vectors of forces that go about one way
UPRIGHT = 4.0  # how much rather forces are seen upright
AXES = {"x": (0.0, 0.0), "y": (90.0, 0.0), "z": (-90.0, 90.0)}  # azimuth and elevation (degrees)
FACING = 0.5  # a face this frontal (cosine) needs not be more so


@dataclass(frozen=True)
class Camera:
    """Axes of the picture in the lab frame: unit vectors (3,) to the right, up, to the viewer."""

    right: Array
    up: Array
    towards: Array

    def project(self, points: Array) -> tuple[Array, Array]:
        """Picture coordinates (..., 2) and heights towards the viewer (...) of points (..., 3)."""
        plane = np.stack([points @ self.right, points @ self.up], axis=-1)
        return plane, np.asarray(points @ self.towards)

    def brightness(self, normals: Array) -> tuple[Array, Array]:
        """Diffuse light (k,), 0 to 1, and gloss (k,) of faces with unit normals (k, 3)."""
        axes = np.stack([self.right, self.up, self.towards], axis=1)
        seen = normals @ axes
        seen = np.where(seen[:, 2:] < 0, -seen, seen)
        light = LIGHT / np.linalg.norm(LIGHT)
        diffuse = AMBIENT + (1 - AMBIENT) * np.maximum(seen @ light, 0)
        half = light + np.array([0.0, 0.0, 1.0])
        gloss = GLOSS * np.maximum(seen @ (half / np.linalg.norm(half)), 0) ** 24
        return diffuse, gloss


def camera_said(text: str) -> Camera:
    """Return the camera at "azimuth,elevation" (degrees), or that looks from an axis, such as "-x".

    Azimuth is counted from x towards y, elevation from there towards z, which is up.

    Raises
    ------
    ModelError
        If it is no such text.
    """
    name, numbers = text.strip(), text.split(",")
    if name.removeprefix("-") in AXES:
        azimuth, elevation = AXES[name[-1]]
        if name.startswith("-"):
            azimuth, elevation = (azimuth, -90) if elevation else (azimuth + 180, 0)
    else:
        try:
            azimuth, elevation = map(float, numbers)
        except ValueError:
            azimuth, elevation = np.nan, np.nan
        if not (abs(azimuth) <= 360 and abs(elevation) <= 90):
            raise ModelError(
                f"camera: found {shown(text)}, expected azimuth,elevation in degrees (at most 360 "
                "and 90), such as 30,20, or an axis: x, y, z, -x, -y, -z"
            )
    a, e = np.deg2rad([azimuth, elevation])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return Camera(right, np.cross(towards, right), towards)


def camera_for(said: str, line: Array, normals: Array, ways: Array | None = None) -> Camera:
    """Return the camera that is asked for, else as `place_camera`."""
    return camera_said(said) if said else place_camera(line, normals, ways)


def place_camera(line: Array, normals: Array, ways: Array | None = None) -> Camera:
    """Place the camera for a centre line (k, 3) of evenly spaced points and its normals (k, 3).

    Unit vectors along `ways` (l, 3), of forces, are to be seen too.
    """
    spread = np.cov(line.T)
    towards = _directions()
    seen = np.minimum(np.abs(towards @ normals.T), FACING).mean(axis=1)
    # Squared area of the projected centre line's ellipse: cofactors of its covariance.
    total = np.trace(spread)
    cofactors = ((total**2 - np.sum(spread**2)) / 2) * np.eye(3) - total * spread + spread @ spread
    # That of a straight one is its length, as it is seen.
    size = total - np.einsum("ki,ij,kj->k", towards, spread, towards)
    squared = np.einsum("ki,ij,kj->k", towards, cofactors, towards)
    score = seen * np.sqrt(np.maximum(squared, 0) + size**2 / 50)
    upright = np.zeros(3)
    if ways is not None and len(ways):
        score *= np.sqrt(np.maximum(1 - (towards @ ways.T) ** 2, 0)).mean(axis=1)
        upright = ways.mean(axis=0)
    good = np.flatnonzero(score > (1 - CHOICE) * score.max())
    views = (_level(t, spread, upright) for t in towards[good])
    return max(views, key=lambda c: float(c.towards @ UP) + UPRIGHT * abs(float(c.up @ upright)))


def _directions() -> Array:
    """Return unit vectors spread evenly over the sphere (golden spiral)."""
    k = np.arange(DIRECTIONS) + 0.5
    z = 1 - 2 * k / DIRECTIONS
    angle = np.pi * (1 + 5**0.5) * k
    rho = np.sqrt(1 - z**2)
    return np.stack([rho * np.cos(angle), rho * np.sin(angle), z], axis=1)


def _level(towards: Array, spread: Array, upright: Array) -> Camera:
    """Turn the picture so that the lab axis nearest to its longest extent is level.

    Where forces go one way, `upright`, it is the one that is most across that.
    """
    across = np.eye(3) - np.outer(towards, towards)
    level = np.linalg.eigh(across @ spread @ across)[1][:, -1]
    if np.linalg.norm(across @ upright) > ONE_WAY:
        level = np.cross(across @ upright, towards)
    right = across[np.argmax(np.abs(across @ level))]
    right = right / np.linalg.norm(right)
    up = np.cross(towards, right)
    if up @ UP < 0:
        towards, up = -towards, -up
    return Camera(right, up, towards)
