"""Loci of folds and branch points against shooting and closed forms, however they are posed.

Whatever the law of ribbons, the mesh, the states, the units, the side of the bow or the order of
the parameters is, the place is that of the elastica, and no bar is below its error.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from map_truth import MIRROR, ONE_CLAMP, SHEARED, WEIGHTED, same_sense

from ribbonopt.scene import load_scene, loads_scene
from ribbonopt.studies.continuation.continuation import Continuation

MAPS = Path(__file__).parents[2] / "configs" / "maps"
#: last digits of the truth (1e-10 degrees, 12 digits), and rounding
DIGITS = 5e-12
ANGLE, SHORTENING = "parameters.angle", "parameters.shortening"


def rows(scene: str, values: Sequence[float], *settings: str) -> list[dict]:
    """Rows of a locus where its second parameter has values."""
    asked = [
        "continuation.to=null",
        f"continuation.values={list(values)}",
        "continuation.scale=linear",
        "continuation.stability=false",
    ]
    continuation = Continuation(load_scene(MAPS / f"{scene}.yaml", [*asked, *settings]))
    points = [point for point in continuation if point.row.get("of")]
    assert continuation.ending.reached, continuation.ending.reason
    moved = continuation.stages[-1].moved
    found = []
    for value in values:
        (row,) = (p.row for p in points if p.row[moved] == value and p.row["kind"] == "point")
        found.append(row)
    return found


def assert_there(row: dict, path: str, truth: float, widest: float = 1e-8) -> None:
    apart, bar = abs(row[path] / truth - 1), row["error"]
    assert apart <= bar + DIGITS
    assert bar <= widest


OTHERS = {
    "degree 4": ["transcription={type: collocation, scheme: gauss, degree: 4, intervals: 20}"],
    "degree 8, three elements": [
        "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 3}"
    ],
    "in space": ["states=reduced"],
    "all states": ["states=full"],
    "differentiated": ["formulation=differentiated", "states=reduced"],
    "algebraic": ["formulation=algebraic"],
    "tolerance 1e-6": ["tolerance=1e-6"],
    "tolerance 1e-12": ["tolerance=1e-12"],
    "sadowsky": ["law={type: sadowsky}"],
    "variational": ["law={type: variational, delta: 0.1}"],
}


@pytest.mark.parametrize("other", OTHERS)
def test_the_fold_is_there_whatever_finds_it(other: str) -> None:
    (row,) = rows("arch_fold", [0.15], *OTHERS[other])
    assert_there(row, ANGLE, ONE_CLAMP[0.15], 1e-4 if "-6" in other else 1e-8)


def test_the_bow_to_the_other_side() -> None:
    (row,) = rows(
        "arch_fold",
        [0.15],
        "guess={force: [0, 0, -42], moment: [0, -4, 0]}",
        "continuation.between=[0, -90]",
    )
    assert_there(row, ANGLE, -ONE_CLAMP[0.15])


def test_turned_in_space() -> None:
    """The first clamp stands askew, and all that is held turns with it."""
    a, b = 0.4, 0.7
    about_x = [[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]]
    about_z = [[np.cos(b), -np.sin(b), 0], [np.sin(b), np.cos(b), 0], [0, 0, 1]]
    R = np.array(about_z) @ about_x
    turns = f"{{x: {a}}}, {{z: {b}}}"
    place = ", ".join(f"{component:.17g}*(1 - shortening)" for component in R[:, 2])
    force, moment = R @ [0, 0, -42], R @ [0, 4, 0]
    scene = loads_scene(
        f"""
        name: askew
        law: {{type: kirchhoff, B2: 1, B3: 2}}
        parameters: {{angle: 0, shortening: 0.1}}
        boundary:
          start: {{support: clamped, position: [0, 0, 0], directors: {{turns: [{turns}]}}}}
          end:
            support: clamped
            position: [{place}]
            directors: {{turns: [{turns}, {{d2: angle*deg}}]}}
        guess: {{force: {list(map(float, force))}, moment: {list(map(float, moment))}}}
        tolerance: 1e-9
        continuation: {{parameter: [{ANGLE}, {SHORTENING}], of: fold, between: [0, 90],
                        values: [0.15], stability: false}}
        """
    )
    point = list(Continuation(scene))[-1]
    assert_there(point.row, ANGLE, ONE_CLAMP[0.15])


def test_the_other_way_round() -> None:
    """The shortening moves on branches, the locus is followed in the angle."""
    angle = ONE_CLAMP[0.15]
    (row,) = rows(
        "arch_fold",
        [angle],
        "parameters.angle=30",
        "parameters.shortening=0.25",
        f"continuation.parameter=[{SHORTENING}, {ANGLE}]",
        "continuation.between=[0.25, 0.01]",
    )
    assert_there(row, SHORTENING, 0.15)


def test_under_a_load() -> None:
    """The second parameter is a force per length, both ways through zero."""
    asked = [-2.0, -4.0]
    settings = [
        "parameters.force=0",
        "loads={force: {x: force}}",
        f"continuation.parameter=[{ANGLE}, parameters.force]",
    ]
    for row in rows("arch_fold", asked, *settings):
        assert_there(row, ANGLE, WEIGHTED[row["parameters.force"]])


@pytest.mark.parametrize("kind", ["branch point", "fold"])
def test_both_clamps_against_the_bow(kind: str) -> None:
    for row in rows("arch_mirror", [0.15, 0.2], f"continuation.of={kind}"):
        assert_there(row, ANGLE, MIRROR[row[SHORTENING]][kind == "fold"])


def test_both_clamps_in_the_same_sense() -> None:
    """From the S shape to the pitchfork, and along it, as the scene is shipped."""
    continuation = Continuation(load_scene(MAPS / "arch_same.yaml"))
    found = [p.row for p in continuation if p.row.get("of") and p.row["kind"] == "point"]
    assert continuation.ending.reached, continuation.ending.reason
    assert {1e-4, 0.5} <= {row[SHORTENING] for row in found}
    for row in found:
        angle, force = same_sense(row[SHORTENING])
        # 1 - d = 2 E / K - 1 leaves rounding over d of the truth.
        assert abs(row[ANGLE] / angle - 1) <= row["error"] + DIGITS
        assert np.hypot(row["n0x"], row["n0z"]) == pytest.approx(force, rel=1e-8)


def test_the_sheared_arch() -> None:
    for row in rows("sheared_thresholds", [0.3, 0.35]):
        assert abs(row["parameters.across"] - SHEARED[row[SHORTENING]][0]) < 1e-10
        assert_there(row, "parameters.across", SHEARED[row[SHORTENING]][0])


def test_in_seconds_and_newtons() -> None:
    """A ribbon of polyester: the same angle at the same relative shortening."""
    (row,) = rows(
        "arch_fold",
        [0.15],
        "ribbon={length: 0.3, width: 0.01, thickness: 1e-4, youngs_modulus: 4.5e9,"
        " poisson_ratio: 0.38}",
        "interval=[0, 0.3]",
        "law=sadowsky",
        "boundary.end.position=[0, 0, 0.3*(1 - shortening)]",
        "guess=auto",
        "record={}",
        "starts=1",
    )
    assert abs(abs(row[ANGLE]) / ONE_CLAMP[0.15] - 1) <= row["error"] + DIGITS
