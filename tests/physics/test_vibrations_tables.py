"""Natural frequencies over the whole of the tables: arches, folds, pitchforks, a Moebius band."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_vibrations import ARCH, ROD, agree, arch_text, modes, solved_text

from ribbonopt.checks.modes import modes_of
from ribbonopt.checks.stability import second_variation
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.scene.inertia import Inertia
from ribbonopt.scene.laws import Variational
from ribbonopt.studies.continuation.continuation import Continuation

pytestmark = pytest.mark.slow

CONFIGS = Path(__file__).parents[2] / "configs"
PLANAR = {
    1e-4: [44.362356666, 74.379155869, 182.082790070, 259.42394004, 398.747998],
    0.1: ARCH,
    0.25: [42.526001613, 78.068298619, 124.448384008, 209.888210651, 339.596199],
    0.5: [37.276049910, 82.804103868, 97.826069886, 175.499795593, 304.754731],
}
FOLD = 0.564847083249  # of the arch a tenth shorter, one clamp turned against it, in radians
SHEARED = {
    0.1: 1759.931483,
    0.2: 415.829473,
    0.22: 136.994563,
    0.225: 69.781488,
    0.235: -61.329282,
    0.24: -125.141473,
    0.4: -1205.324981,
    0.46: -361.089631,
}


@pytest.mark.parametrize("shortening", PLANAR)
def test_arches_in_their_plane(shortening: float) -> None:
    text = arch_text(shortening, 8, 24) + "planar: true\n"
    found = modes_of(solved_text(text), 5, planar=True)
    assert not isinstance(found, str)
    agree(found, PLANAR[shortening], np.arange(5), 2e-9)


def snapping(stage: str) -> Continuation:
    """Return a branch of the arch, bent to +x, one clamp turned against it."""
    text = arch_text(0.1).replace("[0, 0, 0], directors: identity", "[0, 0, 0], directors: TURN")
    text = text.replace("TURN", "{turns: [{y: -a}]}")
    for line in (
        "tolerance: 1e-11",
        "planar: true",
        "parameters: {a: 0}",
        'record: {height: "dot(r, ex) at 0.5"}',
        f"continuation: {stage}",
    ):
        text += f"{line}\n    "
    return Continuation(loads_scene(text))


def test_stable_arches_with_one_clamp_turned() -> None:
    degrees = {
        10: [41.13283761, 69.45933302, 146.02679159, 232.76151997],
        30: [19.11269249, 66.77423001, 142.24575313, 231.61788600],
        32: [11.06317892],
        32.3: [6.94931428],
    }
    values = [0.0, *(float(np.radians(a)) for a in degrees)]
    branch = snapping(f"{{parameter: parameters.a, values: {values}, modes: 8}}")
    # Shorter steps lie between.
    points = [point for point in branch if point.row["parameters.a"] in values]
    for point, expected in zip(points, [ARCH[:4], *degrees.values()], strict=True):
        found = modes_of(point.solution, 4, planar=True)
        assert not isinstance(found, str)
        agree(found, expected, np.arange(4), 2e-9)
        row = [point.row[f"frequency{i + 1}"] for i in range(8)]
        assert np.abs(np.subtract.outer(row, expected)).min(axis=0).max() < 1e-6


def test_the_square_goes_through_the_fold() -> None:
    """Straight in the height of the middle, as a root in the angle, on both sides."""
    stage = "{parameter: parameters.a, to: 0.7, modes: 1, largest: 0.03, stop: ['height < 0.09']}"
    rows = [point.row for point in snapping(stage)]
    assert [row["kind"] for row in rows].count("fold") == 1
    near = [r for r in rows if r["kind"] == "point" and abs(r["height"] - 0.10512) < 0.015]
    heights = np.array([row["height"] - 0.1051206142 for row in near])
    squared = np.array([row["squared1"] for row in near])
    assert (heights > 0).any() and (heights < 0).any() and len(near) > 2
    assert (np.sign(squared) == np.sign(heights)).all()
    slope = np.polyfit(heights, squared / heights, 2)[-1]
    assert slope == pytest.approx(8661.756919, rel=1e-3)
    roots = np.sqrt([FOLD - row["parameters.a"] for row in near])
    side = np.sign(heights)
    root = np.polyfit(side * roots, squared / (side * roots), 2)[-1]
    assert root == pytest.approx(1395.972, rel=2e-3)
    for row in near:
        assert row["negative"] == int(row["squared1"] < 0)
        assert row["frequency1"] == pytest.approx(
            np.sign(row["squared1"]) * np.sqrt(abs(row["squared1"]))
        )


def test_a_stage_ends_at_a_frequency() -> None:
    """Exactly there, as it does at anything that varies along a branch."""
    stage = "{parameter: parameters.a, to: 0.7, modes: 2, stop: ['frequency1 < 11.06317892']}"
    last = [point.row for point in snapping(stage)][-1]
    assert last["frequency1"] == pytest.approx(11.06317892, abs=1e-8)
    assert np.degrees(last["parameters.a"]) == pytest.approx(32, abs=1e-7)


@pytest.mark.parametrize(
    "height, expected", [(0.102120614, -25.40431756), (0.108120614, 26.59499821)]
)
def test_beside_the_fold(height: float, expected: float) -> None:
    """Where a branch is stopped by the height of its middle, on either side of the fold."""
    stage = f"{{parameter: parameters.a, to: 0.7, modes: 1, stop: ['height < {height}']}}"
    row = [point.row for point in snapping(stage)][-1]
    assert row["height"] == pytest.approx(height, abs=1e-9)
    off = (row["height"] - height) * 8661.756919
    assert row["squared1"] == pytest.approx(expected + off, abs=2e-5)


def test_the_square_goes_straight_through_the_pitchfork() -> None:
    for values in ([0.225, 0.22, 0.2, 0.1], [0.225, 0.235, 0.24, 0.4, 0.46]):
        scene = loads_scene(
            f"""
            name: sheared
            law: {ROD}
            boundary:
              start: {{support: clamped, position: [0, 0, 0], directors: identity}}
              end: {{support: clamped, position: [0, 0.225, 0.75], directors: identity}}
            guess:
              force: [0, 38.40590989, -27.93903156]
              moment: [-17.61910499, 1.66905196, 10.87192434]
            tolerance: 1e-11
            transcription: {{type: collocation, degree: 8, intervals: 16}}
            continuation: {{parameter: boundary.end.position.y, values: {values}, modes: 1}}
            """
        )
        rows = [point.row for point in Continuation(scene)]
        found = {r["boundary.end.position.y"]: r for r in rows if r["kind"] == "point"}
        for value in values:
            row = found[value]
            assert row["squared1"] == pytest.approx(SHEARED[value], abs=2e-6, rel=1e-9)
            assert row["negative"] == int(row["squared1"] < 0)


@pytest.mark.parametrize(
    "loop, interval, intervals",
    [
        ("{half_twists: 1}", "[0, 1]", 24),
        ("{half_twists: -1}", "[0, 1]", 20),
        ("{half_twists: 1, piece: half}", "[0, 0.5]", 10),
        ("{half_twists: 1, piece: auto}", "[0, 1]", 12),
    ],
)
def test_a_free_moebius_band(loop: str, interval: str, intervals: int) -> None:
    """Left- or right-handed, of the whole or of a half: the same frequencies."""
    solution = solved_text(
        f"""
        name: moebius
        law: {{type: variational, delta: 0.1}}
        boundary: {{loop: {loop}}}
        interval: {interval}
        transcription: {{type: collocation, degree: 8, intervals: {intervals}}}
        tolerance: 1e-9
        """
    )
    found = modes(solution, 5)
    expected = [132.873401, 195.066868, 254.736786, 320.079089, 392.746417]
    agree(found, expected, np.arange(5), 4e-9)
    assert len(found.zero) == 7 and found.zero[-1] == "sliding along itself"
    turned = modes(solution, 4, Inertia(0, 1e-3))
    agree(turned, [131.779478, 179.502091, 234.730236, 299.434775], np.arange(4), 4e-9)
    # The band is closed: what moves its start moves its end, after the half twist too.
    np.testing.assert_allclose(found.displacement[:, 0], found.displacement[:, -1], atol=1e-9)
    np.testing.assert_allclose(found.rotation[:, 0], found.rotation[:, -1], atol=1e-7)


@pytest.mark.parametrize("half_twists, negative", [(3, 0), (5, 2)])
def test_bands_of_which_a_piece_is_solved(half_twists: int, negative: int) -> None:
    """The same frequencies from the whole, a half and the least piece, pair by pair."""
    pieces = {"whole": 1, "half": 2, "fundamental": 2 * half_twists}
    found = [
        modes(
            solved_text(
                f"""
                name: band
                law: {{type: variational, delta: 0.1}}
                boundary: {{loop: {{half_twists: {half_twists}, piece: {piece}}}}}
                interval: [0, {1 / count!r}]
                tolerance: 1e-9
                """
            ),
            4,
        )
        for piece, count in pieces.items()
    ]
    for one in found:
        apart = np.abs(one.frequencies - found[-1].frequencies)
        assert (apart <= (one.errors + found[-1].errors) * np.abs(one.frequencies)).all()
        assert one.errors.max() < 1e-6
        assert one.zero == found[-1].zero and len(one.zero) == 7 and one.negative == negative


@pytest.mark.parametrize("name", ["clamped_arch", "clamped_quarter", "clamped_twist"])
def test_the_limit_of_smooth_laws_across_switches(name: str) -> None:
    """Sadowsky's law, its switches moving, is the limit of the variational law."""
    scene = replace(load_scene(CONFIGS / f"{name}.yaml"), continuation=None)
    kinked = prepare(scene).solve()
    assert len(kinked.sheets) > 2
    limit, off = modes(kinked, 6), []
    for delta in (0.01, 0.001):
        smooth = prepare(replace(scene, law=Variational(delta=delta), tolerance=1e-7)).solve()
        assert smooth.verified
        off.append(np.abs(modes(smooth, 6).frequencies / limit.frequencies - 1))
    assert off[1].max() < 2e-4 and (off[1] < off[0] / 8).all()


CONTINUED = sorted(
    str(path.relative_to(CONFIGS))
    for path in CONFIGS.rglob("*.yaml")
    if "studies" not in path.parts and "\ncontinuation:" in path.read_text(encoding="utf-8")
)


@pytest.mark.parametrize("name", CONTINUED)
def test_negative_squares_are_the_negative_directions_of_every_branch(name: str) -> None:
    """On every point of every branch; of a piece only those with its symmetry are counted."""
    scene = load_scene(CONFIGS / name)
    for point in Continuation(scene):
        if point.row["kind"] != "point":
            continue
        counted, found = second_variation(point.solution), modes_of(point.solution, 2)
        if isinstance(counted, str) or isinstance(found, str):
            # In a plane there may be an energy where there is none in space.
            inside = not isinstance(found, str) and found.told.startswith("in its plane")
            assert isinstance(counted, str) and (inside or isinstance(found, str)), point.row
            continue
        if scene.boundary.repeats:
            assert found.negative >= counted.negative, point.row
        else:
            assert found.negative == counted.negative, point.row
