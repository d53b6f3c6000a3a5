"""`ribbonopt map`: bad input is refused, work that is done is kept, what is written is read."""

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from made_maps import SCENE, MadeCrew

import ribbonopt
from ribbonopt.studies.maps import run as module

Run = Callable[..., Any]
RANGES = "{parameters.angle: [0, 80], parameters.shortening: [0.05, 0.4]}"
PARAMETERS = "map.parameters="

#: what the user did, and what the message must say
BAD: dict[str, tuple[str, tuple[str, ...]]] = {
    "one number": (PARAMETERS + "{parameters.angle: [0, 60]}", ("expected two numbers",)),
    "unknown": (
        PARAMETERS + "{parameters.angel: [0, 60], parameters.shortening: [0.1, 0.2]}",
        ("parameters.angel", "did you mean parameters.angle?"),
    ),
    "the wrong way": (
        PARAMETERS + "{parameters.angle: [60, 0], parameters.shortening: [0.1, 0.2]}",
        ("[60, 0]", "[0, 60]"),
    ),
    "the same twice": (
        PARAMETERS + "{interval.end: [0.9, 1], interval.1: [0.9, 1]}",
        ("interval.end and interval.1", "same number"),
    ),
    "changes nothing": (
        PARAMETERS + "{parameters.angle: [0, 60], parameters.idle: [0, 1]}",
        ("parameters.idle", "changes nothing"),
    ),
    "out of reach": (
        PARAMETERS + "{parameters.angle: [0, 60], parameters.shortening: [-0.1, 0.2]}",
        ("map.parameters", "1.1 apart"),
    ),
    "a line outside": ("map.lines=[1]", ("map.lines.0", "0.05 to 0.4")),
    "a line twice": ("map.lines=[0.1, 0.1]", ("map.lines.1", "already")),
    "no lines": ("map.lines=[]", ("map.lines", "at least one")),
    "of nothing": ("map.of=[]", ("map.of",)),
    "of kinks": ("map.of=[kink]", ("map.of.0", "kink")),
    "a point outside": ("map.points=[[10, 2]]", ("map.points.0.1", "2")),
    "no step": ("map.largest=0", ("map.largest", "0")),
    "misspelt": ("map.line=[0.1]", ("did you mean 'lines'",)),
    "no map": ("map=null", ("map: the scene has none",)),
}


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    place = tmp_path / "made.yaml"
    place.write_text(SCENE)
    return place


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> Iterator[type[MadeCrew]]:
    """Let work cost nothing, and no shape be drawn."""
    monkeypatch.setattr(module, "Crew", MadeCrew)
    monkeypatch.setattr("ribbonopt.studies.maps.map.Map.pictured", lambda self: {})
    MadeCrew.asked, MadeCrew.alive = [], None
    yield MadeCrew
    MadeCrew.alive = None


@pytest.fixture
def undrawn(made: type[MadeCrew], monkeypatch: pytest.MonkeyPatch) -> type[MadeCrew]:
    """Let the figure cost nothing either."""
    monkeypatch.setattr("ribbonopt.cli.map._draw", lambda *_: [])
    return made


@pytest.mark.parametrize("case", BAD)
def test_bad_maps_are_refused(run: Run, scene: Path, tmp_path: Path, case: str) -> None:
    override, said = BAD[case]
    found = run("map", scene, "--set", override)
    assert found.status == 2
    assert found.out == ""
    assert len(found.err.splitlines()) == 1
    for words in said:
        assert words in found.err, found.err
    assert [*tmp_path.iterdir()] == [scene]


def test_what_is_written_is_read_again(run: Run, scene: Path, made: type[MadeCrew]) -> None:
    found = run("map", scene)
    assert (found.status, found.err) == (0, "")
    for words in ("locus 1, fold", "7 shapes found, 2 stable", "written: results/made-map"):
        assert words in found.out
    map_ = ribbonopt.load("results/made-map")
    assert repr(map_) == (
        "<Map made: parameters.angle and parameters.shortening; 3 loci, 4 regions>"
    )
    assert {region["stable"] for region in map_.regions} == {1, 2}
    assert Path("results/made-map/map.csv").read_text().count("\n") == 1 + 3 * 23
    assert map_.plot().axes[0].get_xlabel() == "angle (degrees)"
    again = run("plot", "results/made-map", "--out", "pictures", "--format", "svg")
    assert (again.status, again.out) == (0, "pictures/map.svg\n")


def test_in_json(run: Run, scene: Path, undrawn: type[MadeCrew]) -> None:
    found = json.loads(run("map", scene, "--json").out)
    assert found["status"] == "converged"
    assert len(found["loci"]) == 3


def test_a_map_is_no_shape(run: Run, scene: Path, undrawn: type[MadeCrew]) -> None:
    run("map", scene)
    for verb in ("view", "export"):
        found = run(verb, "results/made-map")
        assert found.status in (2, 3)
        assert "is a map" in found.err
        assert "map-loci/1" in found.err


@pytest.mark.parametrize("alive", [0, 5])
def test_work_that_is_done_is_not_done_again(
    run: Run, scene: Path, undrawn: type[MadeCrew], alive: int
) -> None:
    assert run("map", scene, "--out", "whole").status == 0
    whole = [*undrawn.asked]
    undrawn.asked, undrawn.alive = [], alive
    broken = run("map", scene, "--out", "broken")
    assert broken.status == 3
    assert len(undrawn.asked) == alive
    if alive:
        with open("broken/jobs.jsonl", "a") as file:
            file.write('{"place": "cut sh')  # as by a kill
        assert "holds a map already" in run("map", scene, "--out", "broken").err
    undrawn.alive = None
    assert run("map", scene, "--out", "broken", "--resume").status == 0
    assert sorted(undrawn.asked) == sorted(whole)  # each once
    for name in ("map.csv", "map.json"):
        assert Path("broken", name).read_bytes() == Path("whole", name).read_bytes()


def test_work_whose_files_are_gone_is_done_again(
    run: Run, scene: Path, undrawn: type[MadeCrew]
) -> None:
    run("map", scene)
    shutil.rmtree("results/made-map/map-loci/2")
    undrawn.asked = []
    assert run("map", scene, "--resume").status == 0
    assert undrawn.asked == ["map-loci/2"]


def test_a_map_of_another_scene_is_not_gone_on_with(
    run: Run, scene: Path, undrawn: type[MadeCrew]
) -> None:
    run("map", scene)
    before = Path("results/made-map/map.json").read_bytes()
    found = run("map", scene, "--resume", "--set", "map.lines=[0.1]")
    assert found.status == 2
    assert "of another scene" in found.err
    assert Path("results/made-map/map.json").read_bytes() == before


def test_lines_that_find_nothing(
    run: Run, scene: Path, undrawn: type[MadeCrew], monkeypatch: pytest.MonkeyPatch
) -> None:
    def nothing(self: MadeCrew, ribbon: Any) -> Any:
        from made_maps import done

        return done(ribbon, slopes=())

    monkeypatch.setattr(MadeCrew, "done", nothing)
    found = run("map", scene)
    assert found.status == 3
    assert found.err.count("\n") == 1
    assert "no fold" in found.err and "kept in results/made-map" in found.err
    assert Path("results/made-map/map-branches/1").is_dir()


def test_damaged_files_are_told(run: Run, scene: Path, undrawn: type[MadeCrew]) -> None:
    run("map", scene)
    place = Path("results/made-map/map.json")
    data = json.loads(place.read_text())
    data["loci"][0]["kind"] = 3
    place.write_text(json.dumps(data))
    found = run("plot", "results/made-map")
    assert found.status == 2
    assert "map.json: is damaged (loci.0.kind" in found.err
