"""Rows as text: what a reader that knows the format alone reads back; and how long the text is."""

import base64
import zlib
from dataclasses import replace

import numpy as np
import pytest
from analytic_shape import helix

from ribbonopt.viewer.packing import COLUMNS, packed
from ribbonopt.viewer.ranges import ranges_of
from ribbonopt.views.shape import Shape

KILO = 1000


def read(text: str, counts: list[int]) -> list[dict[str, np.ndarray]]:
    """Read what `packed` writes, row by row, as its docstring says."""
    raw = zlib.decompress(base64.b64decode(text))
    total, many = sum(counts) * len(COLUMNS), len(COLUMNS) * len(counts)
    assert len(raw) == 8 * many + 2 * total
    scales = np.frombuffer(raw[: 8 * many], "<f4").reshape(-1, 2)
    high, low = raw[8 * many : 8 * many + total], raw[8 * many + total :]
    found, place = [], 0
    for i, count in enumerate(counts):
        shape = {}
        for k, name in enumerate(COLUMNS):
            offset, step = map(float, scales[i * len(COLUMNS) + k])
            values, whole, slope = [], 0, 0
            for j in range(place, place + count):
                folded = 256 * high[j] + low[j]
                slope += -(folded + 1) // 2 if folded % 2 else folded // 2
                whole = (whole + slope + 32768) % 65536 - 32768
                values.append(np.nan if whole == -32768 else offset + step * whole)
            shape[name] = np.array(values)
            place += count
        found.append(shape)
    return found


def truth(shape: Shape) -> dict[str, np.ndarray]:
    return {
        "s": shape.s,
        **dict(zip("xyz", shape.r.T, strict=True)),
        "width": shape.half_widths,
        "u1": shape.u1,
        "u2": shape.u2,
        "u3": shape.u3,
        "angle": np.arctan(shape.eta),
        **{f"n{axis}": part for axis, part in zip("xyz", shape.n.T, strict=True)},
        **{f"m{axis}": part for axis, part in zip("xyz", shape.m.T, strict=True)},
        "energy": shape.energy,
    }


def same(found: dict[str, np.ndarray], shape: Shape) -> None:
    for name, values in truth(shape).items():
        known = values[np.isfinite(values)]
        room = 2e-5 * np.ptp(known) + 2e-7 * np.abs(known).max() if len(known) else 0.0
        np.testing.assert_allclose(found[name], values, rtol=0, atol=room + 1e-300, err_msg=name)
    w, x, y, z = (found[f"q{k}"] for k in range(4))
    size = w * w + x * x + y * y + z * z
    d1 = np.column_stack([size - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])
    d3 = np.column_stack([2 * (x * z + w * y), 2 * (y * z - w * x), size - 2 * (x * x + y * y)])
    d1, d3 = d1 / size[:, None], d3 / size[:, None]
    np.testing.assert_allclose(d1, shape.d1, atol=2e-4)
    np.testing.assert_allclose(d3, shape.d3, atol=2e-4)
    b = np.cross(d3, d1) + found["slant"][:, None] * d3
    np.testing.assert_allclose(b, shape.b, atol=4e-4)


@pytest.mark.parametrize("size", [1.0, 1e-3, 1e6])
def test_what_is_read_is_what_was_written(size: float) -> None:
    shapes = [helix(241, size=size), helix(7, turns=0.3, size=size), helix(50, size=size)]
    found = read(packed(shapes), [241, 7, 50])
    for one, shape in zip(found, shapes, strict=True):
        same(one, shape)


def test_leaps_and_what_is_no_number() -> None:
    shape = helix(60)
    leaping = np.where(np.arange(60) < 31, 400.0, -250.0)
    forces = shape.n.copy()
    forces[12], forces[40, 1], forces[41, 2] = np.nan, np.inf, -np.inf
    shape = replace(shape, u2=leaping, n=forces, eta=np.where(np.arange(60) == 5, 1e300, -3.0))
    found = read(packed([shape]), [60])[0]
    assert np.isnan(found["nx"]).nonzero()[0].tolist() == [12]
    assert np.isnan(found["ny"]).nonzero()[0].tolist() == [12, 40]
    assert np.isnan(found["nz"]).nonzero()[0].tolist() == [12, 41]
    np.testing.assert_allclose(found["u2"], leaping, atol=0.02)
    np.testing.assert_allclose(found["angle"], np.arctan(shape.eta), atol=1e-4)
    same(found, replace(shape, n=np.where(np.isfinite(forces), forces, np.nan)))


def test_a_failed_result_has_no_numbers_at_all() -> None:
    shape, none = helix(20), np.full((20, 3), np.nan)
    found = read(packed([replace(shape, r=none, d1=none, d2=none, d3=none, b=none)]), [20])[0]
    assert np.isnan(found["x"]).all()
    assert np.isnan(found["q0"]).all()
    np.testing.assert_allclose(found["s"], shape.s, atol=1e-4)


def test_a_ribbon_is_ten_kilobytes_and_four_hundred_are_two_megabytes() -> None:
    assert len(packed([helix()])) < 10 * KILO
    many = [helix(121, turns=i / 400) for i in range(400)]
    assert len(packed(many)) < 2000 * KILO


def test_ranges_are_over_all_shapes() -> None:
    slower = helix(60, size=2.0)
    found = ranges_of([helix(), replace(slower, eta=np.full(60, -1e300))])
    radius, pitch, speed = 0.1, 0.05, 0.1**2 + 0.05**2
    assert found["u2"] == pytest.approx([radius / speed / 2, radius / speed])
    assert found["u3"] == pytest.approx([pitch / speed / 2, pitch / speed])
    assert found["eta"] == pytest.approx([-1.5, pitch / radius])
    assert "energy" not in found  # there is none
    along = np.concatenate([np.sum(shape.n * shape.d1, axis=1) for shape in (helix(), slower)])
    assert found["n1"] == pytest.approx([along.min(), along.max()])
