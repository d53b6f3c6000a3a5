"""A helix as a shape, by formulas: what pages are made of, without a solve."""

import numpy as np

from ribbonopt.scene.units import Units
from ribbonopt.views.shape import Shape

RADIUS, PITCH = 0.1, 0.05  # of r = (R cos t, R sin t, P t), t = s / sqrt(R^2 + P^2)


def helix(count: int = 241, turns: float = 0.0, name: str = "helix", size: float = 1.0) -> Shape:
    """Return a helix that begins at an angle of `turns` turns; all lengths times `size`."""
    speed = np.hypot(RADIUS, PITCH)
    s = np.linspace(0, 1, count)
    t = s / speed + 2 * np.pi * turns
    zero, one = np.zeros(count), np.ones(count)
    r = np.column_stack([RADIUS * np.cos(t), RADIUS * np.sin(t), PITCH * t])
    d3 = np.column_stack([-RADIUS * np.sin(t), RADIUS * np.cos(t), PITCH * one]) / speed
    d1 = np.column_stack([-np.cos(t), -np.sin(t), zero])  # the principal normal
    d2 = np.cross(d3, d1)
    u2, u3 = RADIUS / speed**2 * one, PITCH / speed**2 * one
    eta = u3 / u2
    force = np.tile([1.0, -2.0, 3.0], (count, 1))
    return Shape(
        name=name,
        units=Units(),
        s=size * s,
        r=size * r,
        d1=d1,
        d2=d2,
        d3=d3,
        b=d2 + eta[:, None] * d3,
        half_widths=0.05 * size * one,
        u1=zero,
        u2=u2 / size,
        u3=u3 / size,
        eta=eta,
        n=force,
        m=np.cross(size * r, force),
        energy=np.full(count, np.nan),
        mirrored=s > 0.5,
        starts=(0,),
        closing=0,
        half_width=0.05 * size,
        own=False,
        rod=False,
    )
