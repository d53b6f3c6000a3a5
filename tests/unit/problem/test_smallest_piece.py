"""`piece: auto`: which piece of a loop is solved, and what is told of it.

Truth: a piece that symmetry allows has the energy of the whole loop divided by their number, and
one that is not allowed is refused where it is asked for by name.
"""

from typing import Any

import pytest
from independent.confirm import confirm
from references import VARIATIONAL, agrees

from ribbonopt.errors import ModelError
from ribbonopt.output.report import report
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene, loads_scene
from ribbonopt.studies.continuation.continuation import Continuation

TEXT = """
name: band
law: {type: variational, delta: 0.01}
boundary:
  loop: {half_twists: 3, piece: auto}
"""


def band(half_twists: int = 3, *changes: str) -> Scene:
    return loads_scene(TEXT, overrides=[f"boundary.loop.half_twists={half_twists}", *changes])


def solved_piece(scene: Scene) -> tuple[Any, float, str]:
    posed = Posed.of(scene)
    loop = posed.given.boundary.loop
    assert loop is not None and posed.scene.boundary.loop == loop
    start, end = posed.given.interval
    return loop.piece, end - start, posed.undivided


@pytest.mark.parametrize(
    ("half_twists", "changes", "piece", "why"),
    [
        (3, (), "fundamental", ""),
        (-5, ("law={type: sadowsky}", "tolerance=1e-6"), "fundamental", ""),
        (1, (), "half", ""),
        (0, (), "half", ""),
        (3, ("boundary.start.position=[0, 0, 0]",), "half", "where it is"),
        (3, ("guess={force: [0, 157, -102], moment: [0, 11, 29]}",), "half", "where it is"),
        (3, ("loads.force={z: -1}",), "whole", "loads"),
        (0, ("loads.pressure=1",), "whole", "loads"),
        (0, ("loads.pressure=1", "states=planar"), "half", ""),
        (0, ("loads.pressure=1 + s", "states=planar"), "whole", "not the same all along"),
        (0, ("natural.curvature=1",), "half", ""),
        (1, ("natural.curvature=1",), "whole", "not the same all along"),
        (2, ("natural.curvature=1",), "half", "a flip about d2"),
        (2, ("width=1 + 0.1*s",), "whole", "not the same all along"),
        (3, ("record.up=dot(r, ez) at 0.8",), "whole", "recorded"),
        (3, ("switching=[0.5]",), "whole", "switching"),
        (3, ("boundary.also=['dot(n(start), ex) = 0']",), "whole", "also"),
        (3, ("continuation={parameter: law.delta, to: 0.1}",), "whole", "stability"),
        (3, ("continuation={parameter: law.delta, to: 0.1, stability: false}",), "fundamental", ""),
    ],
)
def test_the_smallest_piece_that_is_like_its_images(
    half_twists: int, changes: tuple[str, ...], piece: str, why: str
) -> None:
    scene = band(half_twists, *changes)
    found, length, reason = solved_piece(scene)
    assert found == piece and why in reason and bool(why) == bool(reason)
    count = {"whole": 1, "half": 2, "fundamental": 2 * abs(half_twists)}[piece]
    assert length == pytest.approx(1 / count)


@pytest.mark.parametrize(
    ("half_twists", "change"), [(3, "loads.force={z: -1}"), (1, "natural.curvature=1")]
)
def test_what_it_leaves_whole_is_refused_by_name(half_twists: int, change: str) -> None:
    half = band(half_twists, change, "boundary.loop.piece=half", "interval=[0, 0.5]")
    with pytest.raises(ModelError, match="solve piece: whole"):
        prepare(half)


def test_all_of_the_loop_is_told() -> None:
    scene = band(1, "tolerance=1e-9")
    found = solve(scene)
    assert found.verified and found.scene.interval == (0.0, 0.5)
    assert confirm(found) < 1e-9
    _, H = VARIATIONAL[0.01]
    summary = summarize(found)
    assert agrees(summary["symmetry"]["energy"], H) and summary["symmetry"]["length"] == 1
    assert summary["symmetry"]["pieces"] == 2 and summary["half_twists"] == 1
    text = report(summary)
    assert "1/2 of the loop is solved, symmetry gives the rest (length 1 in all)" in text
    assert "the other half of the loop" in text and H[:7] in text


def test_a_branch_keeps_to_one_piece() -> None:
    along = "continuation={{parameter: law.delta, to: 0.02, stability: {}}}"
    for stability, piece in ((False, "half"), (True, "whole")):
        scene = band(1, along.format(str(stability).lower()))
        loop = Continuation(scene).prepared.scene.boundary.loop
        assert loop is not None and loop.piece == piece
