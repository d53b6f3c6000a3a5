"""A map of true ribbons, ended at any moment and gone on with; the arch's map against truth."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import ribbonopt

ROOT = Path(__file__).parents[2]
TINY = """\
name: tiny
law: {type: kirchhoff, B2: 1, B3: 2}
parameters: {angle: 0, shortening: 0.1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 1 - shortening], directors: {turns: [{y: angle*deg}]}}
states: planar
transcription: {type: collocation, scheme: gauss, degree: 6, intervals: 8}
equilibria: {along: {parameters.angle: [-1, 40]}, below: 7}
map:
  parameters: {parameters.angle: [20, 38], parameters.shortening: [0.09, 0.11]}
  lines: [0.1]
  largest: 0.5
"""
#: fold of the arch of which one clamp is turned (degrees), by its shortening: SCIENCE, shooting
FOLD = {0.05: 22.8595483544, 0.4: 64.3483022372}

pytestmark = pytest.mark.slow


def begun(folder: Path, *more: str) -> subprocess.Popen[str]:
    words = [sys.executable, "-m", "ribbonopt", "map", "tiny.yaml", "--out", "out", *more]
    return subprocess.Popen(words, cwd=folder, text=True, stderr=subprocess.PIPE)


def rows(folder: Path) -> int:
    place = folder / "out" / "jobs.jsonl"
    return place.read_text().count("\n") if place.exists() else 0


def test_killed_and_gone_on_with(tmp_path: Path) -> None:
    (tmp_path / "tiny.yaml").write_text(TINY)
    for count, how in ((0, signal.SIGKILL), (1, signal.SIGKILL), (2, signal.SIGINT)):
        process = begun(tmp_path, "--resume")
        while rows(tmp_path) <= count and process.poll() is None:
            time.sleep(0.05)
        os.kill(process.pid, how)
        process.wait()
    last = begun(tmp_path, "--resume")
    said = last.communicate()[1]
    assert (last.returncode, said) == (0, "")
    places = [json.loads(line)["place"] for line in open(tmp_path / "out" / "jobs.jsonl")]
    assert sorted(places) == [
        "map-branches/1",
        "map-loci/1",
        "map-points/1",
        "map-points/2",
    ]  # each once
    found = ribbonopt.load(tmp_path / "out")
    assert isinstance(found, ribbonopt.Map)
    assert [(region["count"], region["stable"]) for region in found.regions] == [(3, 2), (1, 1)]
    (locus,) = found.loci
    assert sum(row["stage"] for row in locus.rows) == 3  # behind the branch that leads there
    (two, one) = (found.shapes(point["number"]) for point in found.data["points"])
    assert (len(two), len(one)) == (3, 1)
    assert all(solution.verified for solution in (*two, *one))
    assert not [path for path in (tmp_path / "out").rglob(".*")]  # of what was killed


def test_the_map_of_the_arch(tmp_path: Path) -> None:
    """Its first fold to the digits of the table; how many are stable on both sides of it."""
    words = [sys.executable, "-m", "ribbonopt", "map", str(ROOT / "configs/maps/arch_map.yaml")]
    subprocess.run([*words, "--out", "out", "--quiet"], cwd=tmp_path, check=True)
    found = ribbonopt.load(tmp_path / "out")
    assert isinstance(found, ribbonopt.Map)
    assert found.doubts == []
    first = next(locus for locus in found.data["loci"] if locus["changes"])
    ends = {round(y, 9): x for x, y in (first["points"][0], first["points"][-1])}
    for shortening, angle in FOLD.items():
        assert ends[shortening] == pytest.approx(angle, rel=1e-10)
    large = found.regions[0]
    assert (large["count"], large["stable"]) == (6, 2)
    assert {region["stable"] for region in found.regions[1:]} == {1}
    assert (tmp_path / "out" / "map.png").is_file()
