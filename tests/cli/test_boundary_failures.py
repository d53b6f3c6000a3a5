"""Supports, rotations, loops and sizes that no ribbon has: told with a line to write instead."""

from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

Run = Callable[..., Any]

SCENE = """\
name: held
law: {type: sadowsky}
parameters: {turn: 0.5}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: free}
guess: auto
interval: [0, 1]
"""
START = "  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
END = "  end: {support: free}\n"
BOTH = START + END
SIZES = "length: 0.3, width: 0.01, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3"


class Bad(NamedTuple):
    """What the user wrote, in place of what, and what the message must say."""

    old: str
    new: str
    line: str
    words: tuple[str, ...]


def end(text: str) -> str:
    return f"  end: {{{text}}}\n"


BAD = {
    "misspelt support": Bad(
        "support: free",
        "support: fre",
        "line 6, boundary.end.support",
        ("found 'fre'", "expected 'clamped', 'pinned'", "did you mean 'free'?"),
    ),
    "support without its keys": Bad(
        END,
        end("support: hinged, position: [0, 0, 1]"),
        "line 6, boundary.end",
        ("needs axis and along", 'add for example "axis: d2, along: [0, 1, 0]"'),
    ),
    "clamped without a frame": Bad(
        ", directors: identity",
        "",
        "line 5, boundary.start",
        ("support: clamped needs directors", 'add for example "directors: identity"'),
    ),
    "clamped with a load": Bad(
        "directors: identity",
        "directors: identity, force: [0, 0, 1]",
        "line 5, boundary.start.force",
        ("contradicts support: clamped", "takes only position and directors", "support: sliding"),
    ),
    "pinned with a frame": Bad(
        "support: clamped",
        "support: pinned",
        "line 5, boundary.start.directors",
        ("contradicts support: pinned", 'write for example "support: clamped"'),
    ),
    "pinned at half a point": Bad(
        END,
        end("support: pinned, position: {y: 0}"),
        "line 6, boundary.end.position",
        ("found {y: 0}", "needs all three components", '"position: [0, 0, 0]"'),
    ),
    "free with a position": Bad(
        END,
        end("support: free, position: [0, 0, 1]"),
        "line 6, boundary.end.position",
        ("contradicts support: free", "takes only force and moment"),
    ),
    "free with half a load": Bad(
        END,
        end("support: free, force: {x: 1}"),
        "line 6, boundary.end.force",
        ("found {x: 1}", "needs all its components", '"force: [0, 0, 0]"'),
    ),
    "hinged with a whole moment": Bad(
        END,
        end("support: hinged, position: [0, 0, 1], axis: d2, along: [0, 1, 0], moment: [0, 1, 0]"),
        "line 6, boundary.end.moment",
        ("found [0, 1, 0]", "about the hinge, d2", 'write for example "moment: {d2: 0}"'),
    ),
    "hinge along nothing": Bad(
        END,
        end("support: hinged, position: [0, 0, 1], axis: d2, along: [0, 0, 0]"),
        "line 6, boundary.end.along",
        ("found [0, 0, 0]", "expected a direction", '"along: [0, 1, 0]"'),
    ),
    "sliding with a load across": Bad(
        END,
        end(
            "support: sliding, position: [0, 0, 1], directors: identity, along: [0, 0, 1], "
            "force: {x: 1}"
        ),
        "line 6, boundary.end.force",
        ("x is across it", 'write for example "force: {z: 0}"'),
    ),
    "flip with a frame": Bad(
        END,
        end("support: flip, position: [0, 0, 1], axis: d1, along: [1, 0, 0], directors: identity"),
        "line 6, boundary.end.directors",
        ("contradicts support: flip", "position, axis and along"),
    ),
    "string at the start": Bad(
        START,
        "  start: {support: held, distance: 0.5}\n",
        "line 5, boundary.start.support",
        ("found 'held'", '"end: {support: held, distance: 0.5}"'),
    ),
    "string without a length": Bad(
        END,
        end("support: held"),
        "line 6, boundary.end",
        ("needs distance", 'add for example "distance: 0.5"'),
    ),
    "string of negative length": Bad(
        END,
        end("support: held, distance: turn - 1"),
        "line 6, boundary.end.distance",
        ("found -0.5", "expected a number > 0", '"distance: 0.5"'),
    ),
    "string to nowhere": Bad(
        BOTH,
        END.replace("end", "start") + end("support: held, distance: 0.5"),
        "line 5, boundary.start.support",
        ("found 'free'", "a fixed point", '"support: pinned"'),
    ),
    "axis without a support": Bad(
        END,
        end("axis: d2"),
        "line 6, boundary.end.axis",
        ("only with support: hinged or flip", '"support: hinged"'),
    ),
    "distance without a support": Bad(
        END,
        end("distance: 0.5"),
        "line 6, boundary.end.distance",
        ("only with support: held", '"support: held"'),
    ),
    "no rotation": Bad(
        "identity",
        "{quaternion: [1, 0, 1, 0]}",
        "line 5, boundary.start.directors.quaternion",
        ("has length 1.41421, expected 1", '"quaternion: [0.707106781, 0, 0.707106781, 0]"'),
    ),
    "misspelt rotation": Bad(
        "identity",
        "{quaternoin: [1, 0, 0, 0]}",
        "line 5, boundary.start.directors.quaternoin",
        ("did you mean 'quaternion'?",),
    ),
    "turn about two axes": Bad(
        "identity",
        "{turns: [{x: 90*deg, d3: 1}]}",
        "line 5, boundary.start.directors.turns.0",
        ("found {x: 90*deg, d3: 1}", "expected one axis", '"{x: 90*deg}, {d3: 1}"'),
    ),
    "no turns": Bad(
        "identity",
        "{turns: []}",
        "line 5, boundary.start.directors.turns",
        ("found []", "at least one turn", '"turns: [{x: 90*deg}]"'),
    ),
    "unknown name in a turn": Bad(
        "identity",
        "{turns: [{x: 90*degree}]}",
        "line 5, boundary.start.directors.turns.0.x",
        ("unknown name 'degree'", "did you mean 'deg'?"),
    ),
    "misspelt loop": Bad(
        BOTH,
        "  loop: {half_twist: 1}\n",
        "line 5, boundary.loop.half_twist",
        ("did you mean 'half_twists'?", "known keys: half_twists, piece"),
    ),
    "half a half twist": Bad(
        BOTH,
        "  loop: {half_twists: 1.5}\n",
        "line 5, boundary.loop.half_twists",
        ("found 1.5", "expected a whole number"),
    ),
    "loop without fundamental piece": Bad(
        BOTH,
        "  loop: {half_twists: 0, piece: fundamental}\n",
        "line 5, boundary.loop.half_twists",
        ("found 0", "fewer than two half twists", '"piece: half"'),
    ),
    "loop with an end": Bad(
        BOTH,
        "  loop: {half_twists: 1}\n" + END,
        "line 6, boundary.end",
        ("`support` of the end follow", '"loop: {half_twists: 1, piece: whole}" says it all'),
    ),
    "loop with a support": Bad(
        BOTH,
        "  loop: {half_twists: 1}\n" + START,
        "line 6, boundary.start.support",
        ("follows from the loop", '"start: {position: [0, 0, 0], directors: identity}"'),
    ),
    "misspelt guess": Bad("auto", "atuo", "line 7, guess", ("found 'atuo'", "did you mean 'auto'")),
    "misspelt key of a guess": Bad(
        "auto",
        "{moebuis: {half_twists: 1}}",
        "line 7, guess.moebuis",
        ("did you mean 'moebius'?",),
    ),
    "two guesses": Bad(
        "auto",
        "{arc: 1, helix: {turns: 1, rise: 0}}",
        "line 7, guess.helix",
        ("cannot stand beside arc",),
    ),
    "guess without a value": Bad(
        "auto", "{arc: sqrt(-turn)}", "line 7, guess.arc", ("has no finite real value",)
    ),
    "helix too steep": Bad(
        "auto",
        "{helix: {turns: 3, rise: 1.5}}",
        "line 7, guess.helix.rise",
        ("found 1.5", "expected a number from -1 to 1"),
    ),
    "loop and guess of other half twists": Bad(
        BOTH + "guess: auto\n",
        "  loop: {half_twists: 1}\nguess: {moebius: {half_twists: 3}}\n",
        "line 6, guess.moebius.half_twists",
        ("found 3", "half_twists: 1; one of them must go", '"half_twists: 1"'),
    ),
    "loop and circle": Bad(
        BOTH + "guess: auto\n",
        "  loop: {half_twists: 1}\nguess: circle\n",
        "line 6, guess",
        ("found 'circle'", "one of them must go", "guess: {moebius: {half_twists: 1,"),
    ),
    "ribbon too short": Bad(
        "interval: [0, 1]\n",
        f"interval: [0, 1]\nribbon: {{{SIZES}}}\n",
        "line 8, interval",
        ("found [0, 1]", "ribbon.length: 0.3", 'write for example "interval: [0, 0.3]"'),
    ),
    "thickness in millimetres": Bad(
        "interval: [0, 1]\n",
        f"interval: [0, 0.3]\nribbon: {{{SIZES.replace('1e-4', '0.1')}}}\n",
        "line 9, ribbon.thickness",
        ("found 0.1", "less than ribbon.width, 0.01", "metres", '"thickness: 0.001"'),
    ),
    "no sizes": Bad(
        "interval: [0, 1]\n",
        f"ribbon: {{{SIZES.replace('length', 'lenght')}}}\n",
        "line 8, ribbon.lenght",
        ("did you mean 'length'?",),
    ),
}


@pytest.mark.parametrize("verb", ["solve", "check"])
@pytest.mark.parametrize("case", BAD)
def test_bad_boundaries_are_refused(run: Run, tmp_path: Path, case: str, verb: str) -> None:
    old, new, line, words = BAD[case]
    assert SCENE.count(old) == 1
    path = tmp_path / "held.yaml"
    path.write_text(SCENE.replace(old, new), encoding="utf-8")
    extra = ["--out", tmp_path / "result"] if verb == "solve" else []
    status, out, err = run(verb, path, *extra)
    assert (status, out) == (2, "")
    assert err.startswith("ribbonopt: ")
    assert err.count("ribbonopt: ") == 1
    assert "Traceback" not in err
    assert "held.yaml" in err
    assert len(err.splitlines()) == 1
    assert line in err
    for word in words:
        assert word in err
    assert [entry.name for entry in tmp_path.iterdir()] == ["held.yaml"]


def test_bad_boundaries_are_refused_by_overrides_too(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "held.yaml"
    path.write_text(SCENE, encoding="utf-8")
    status, _, err = run("check", path, "--set", "boundary.end.support=hinged")
    assert status == 2
    assert "support: hinged needs position, axis and along; add for example" in err


def test_all_problems_of_the_boundary_are_told_at_once(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "held.yaml"
    bad = end("support: held, distance: 0, along: [0, 0, 0]")
    path.write_text(SCENE.replace(END, bad).replace("auto", "{arc: 1/0}"), encoding="utf-8")
    status, _, err = run("check", path)
    assert status == 2
    for words in (
        "4 problems",
        "line 6, boundary.end.distance: found 0",
        "line 6, boundary.end.along: contradicts support: held",
        "line 6, boundary.end.along: found [0, 0, 0]",
        "line 7, guess.arc: formula '1/0'",
    ):
        assert words in err
