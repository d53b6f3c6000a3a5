"""Bad studies: each is refused by file, line and key; a bad scene alone spoils its own rows."""

import re
from pathlib import Path

import pytest
from hostile import NAMES_REFUSED

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene
from ribbonopt.studies.batch.cells import as_yaml
from ribbonopt.studies.batch.chunks import chunks_of
from ribbonopt.studies.batch.sweep import load_study

SCENE = """\
name: half
law: {type: regularized, epsilon: 0.1}
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end:
    position: {y: 0, z: 0}
tolerance: 1e-7
"""
BAD = SCENE.replace("boundary", "bondary")
GRID = "sweep: {grid: {law.epsilon: [0.1, 0.2]}}\n"
INLINE = "".join(f"  {line}\n" for line in SCENE.splitlines())
EPSILON = "scene: scene.yaml\nsweep:\n  grid:\n    law.epsilon: "
DRAWN = "scene: scene.yaml\nsweep:\n  random:\n    count: 2\n    over: "
DRAWS = "line 5, sweep.random.over.law.epsilon"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the current folder, a sound scene and a bad one in it."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.yaml").write_text(SCENE)
    (tmp_path / "bad.yaml").write_text(BAD)
    return tmp_path


def refusal(text: str, *overrides: str) -> str:
    """Return why a study is refused when it is read."""
    Path("study.yaml").write_text(text)
    with pytest.raises(SceneError) as caught:
        load_study(["study.yaml"], overrides)
    return str(caught.value)


def refusal_of_check(text: str, *overrides: str) -> str:
    """Return why a study that can be read is refused once its first ribbon is looked at."""
    Path("study.yaml").write_text(text)
    study = load_study(["study.yaml"], overrides)
    with pytest.raises(SceneError) as caught:
        study.check()
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("scene: scene.yaml\nseep: {}\n", "line 2, seep", "did you mean 'sweep'"),
        ("scene: scene.yaml\nsweep: {gird: {a: [1]}}", "line 2, sweep.gird", "did you mean 'grid'"),
        ("scene: scene.yaml\nsweep:\n", "line 2, sweep", "found null, expected one or more of"),
        ("name: a\nsweep: {grid: {a: [1]}}", "scene", "missing"),
        ("name: a\nscene: 3", "line 2, scene", "found 3, expected the name of a scene"),
        ("scene: [scene.yaml, 3]", "line 1, scene", "found 3, expected the name of a scene"),
        ("name: a\nscene: []", "line 2, scene", "names no scene"),
        ("scene: scene.yaml\nname: a/b", "line 2, name", "found 'a/b', expected a name"),
        ("scene: scene.yaml\nname: ..", "line 2, name", "expected a name"),
        ("scene: scene.yaml\nname: 3", "line 2, name", "found 3, expected a name"),
        ("scene: scene.yaml\nsave: some", "line 2, save", "expected one of all, failed, none"),
        ("scene: scene.yaml\ntime_limit: true", "line 2, time_limit", "found true, expected a num"),
        ("scene: scene.yaml\ntime_limit: 0", "line 2, time_limit", "found 0, expected a number of"),
        ("scene: scene.yaml\ntime_limit: 1 h", "line 2, time_limit", "found '1 h', expected a num"),
        ("scene: scene.yaml\ntime_limit: .inf", "line 2, time_limit", "expected a number of"),
        ("scene: scene.yaml\nset: [1]", "line 2, set", "found [1], expected keys of the scene"),
        (f"{EPSILON}0.1", "line 4, sweep.grid.law.epsilon", "found 0.1, expected a list"),
        (f"{EPSILON}[]", "line 4, sweep.grid.law.epsilon", "empty"),
        ("scene: scene.yaml\nsweep: {list: []}", "line 2, sweep.list", "empty"),
        ("scene: scene.yaml\nsweep: {list: [1]}", "line 2, sweep.list", "a list of mappings"),
        ("scene: scene.yaml\nsweep: {zip: [1]}", "line 2, sweep.zip", "keys and their values"),
        (
            "scene: scene.yaml\nsweep:\n  zip: {a: [1, 2], b: {from: 0, to: 1, count: 3}}",
            "line 3, sweep.zip",
            "unequal length (a: 2, b: 3)",
        ),
        (
            "scene: scene.yaml\nsweep:\n  grid: {a: [1]}\n  list:\n  - {b: 1}\n  - {a: 1}",
            "line 4, sweep.list.a",
            "swept by grid already",
        ),
        ("scene: scene.yaml\nsweep:\n  csv: 7", "line 3, sweep.csv", "name of a CSV file"),
        ("scene: scene.yaml\nsweep:\n  random: 7", "line 3, sweep.random", "found 7, expected"),
        ("scene: scene.yaml\nsweep: {random: {count: 2}}", "line 2, sweep.random", "over: {"),
        (f"{DRAWN}{{}}", "line 5, sweep.random.over", "found {}, expected"),
        (f"{DRAWN}{{law.epsilon: 1}}", DRAWS, "found 1, expected {uniform: [a, b]}"),
        (f"{DRAWN}{{law.epsilon: {{gauss: [0, 1]}}}}", DRAWS, "or {normal: [a, b]}"),
        (f"{DRAWN}{{law.epsilon: {{normal: [0, -1]}}}}", DRAWS, "standard deviation >= 0"),
        (f"{DRAWN}{{law.epsilon: {{normal: [0]}}}}", DRAWS, "expected {uniform"),
        (f"{DRAWN}{{law.epsilon: {{uniform: [true, 1]}}}}", DRAWS, "expected {uniform"),
        (f"{DRAWN}{{law.epsilon: {{log_uniform: [0, 1]}}}}", DRAWS, "bounds > 0"),
        (f"{DRAWN}{{law.epsilon: {{uniform: [1, 0]}}}}", DRAWS, "uniform"),
        (f"{DRAWN}{{law.epsilon: {{log_uniform: [1, 0.1]}}}}", DRAWS, "uniform"),
        (f"{DRAWN}{{law.epsilon: {{uniform: [0, .inf]}}}}", DRAWS, "uniform"),
        (f"{DRAWN}{{law.epsilon: {{normal: [.nan, 1]}}}}", DRAWS, "normal"),
    ],
)
def test_a_bad_study_is_refused_by_line_and_key(
    folder: Path, text: str, place: str, words: str
) -> None:
    message = refusal(text)
    assert re.match(rf"study\.yaml[,:] {re.escape(place)}: ", message), message
    assert words in message
    assert "\n" not in message


@pytest.mark.parametrize(
    "item",
    [
        "{from: true, to: 1, count: 2}",
        "{from: 0, to: a, count: 2}",
        "{from: 0, to: 1, count: true}",
        "{from: 0, to: 1, count: 0}",
        "{from: 0, to: 1, count: -2}",
        "{from: 0, to: 1, count: 2.0}",
        "{from: 0, to: 1, count: 10000000000000000000000}",
        "{from: 0, to: 1}",
        "{from: 0, to: 1, count: 2, scael: log}",
        "{from: 0, to: 1, count: 2, scale: cubic}",
        "{from: 0, to: 1, count: 2, scale: log}",
        "{from: -1, to: -2, count: 2, scale: log}",
        "{from: 0, to: .inf, count: 2}",
        "{from: .nan, to: 1, count: 2}",
    ],
)
def test_numbers_that_cannot_be_spaced(folder: Path, item: str) -> None:
    message = refusal(EPSILON + item)
    assert message.startswith("study.yaml, line 4, sweep.grid.law.epsilon: found {'from': ")
    assert "expected" in message


@pytest.mark.parametrize("count", ["-1", "true", "2.5", "two"])
def test_numbers_of_draws(folder: Path, count: str) -> None:
    message = refusal(DRAWN.replace("count: 2", f"count: {count}") + "{a: {uniform: [0, 1]}}")
    assert message.startswith("study.yaml, line 4, sweep.random.count: found ")
    message = refusal(DRAWN.replace("count: 2", "count: 0") + "{a: {uniform: [0, 1]}}")
    assert message.startswith("study.yaml, line 3, sweep.random: ") and "empty" in message


@pytest.mark.parametrize(
    ("cells", "place"),
    [
        (None, "study.yaml, line 3, sweep.csv: rows.csv: no such file"),
        ("", "rows.csv: is empty"),
        (" \n,,\n", "rows.csv: is empty"),
        ("law.epsilon,tolerance\n", "study.yaml, line 3, sweep.csv: the sweep is empty"),
        ("a,b\n1,2\n3\n", "rows.csv, line 3: found 1 values, expected 2"),
        ('a,b\n"x\ny",2\n\n1,2,3\n', "rows.csv, line 5: found 3 values, expected 2"),
        ("a,b\n1,2\n1,[3\n", "rows.csv, line 3"),
        ("a,b,a\n1,2,3\n", "rows.csv, line 1"),  # which of the two would it be?
        ("a,\n1,2\n", "rows.csv, line 1"),  # a column without a key
    ],
)
def test_bad_tables_are_refused(folder: Path, cells: str | None, place: str) -> None:
    if cells is not None:
        (folder / "rows.csv").write_text(cells)
    message = refusal("scene: scene.yaml\nsweep:\n  csv: rows.csv\n")
    assert message.startswith(place), message
    assert len(re.findall(r"line \d", message)) == place.count("line "), message


def test_what_is_no_yaml_is_refused(folder: Path) -> None:
    assert refusal("scene: scene.yaml\nsweep:\n\tgrid: 1\n").startswith("study.yaml, line 3: not")
    assert refusal("scene: a\nscene: b\n").startswith("study.yaml, line 1, scene: given again")
    where = "study.yaml, line 2, scene: "
    assert refusal(GRID + "scene: none.yaml\n") == where + "none.yaml: no such file"
    assert refusal(GRID + "scene: scene.yaml\n", "law.epsilon").startswith("--set law.epsilon: exp")
    for path, words in (("none.yaml", "no such file"), ("*.yml", "no file matches")):
        with pytest.raises(SceneError, match=f"^{re.escape(path)}: {words}"):
            load_study([path])
    (folder / "empty").mkdir()
    with pytest.raises(SceneError, match=r"^empty: holds no \.yaml file"):
        load_study(["empty"])


@pytest.mark.parametrize(
    ("text", "overrides", "place", "words"),
    [
        (
            "sweep:\n  grid:\n    tolerance: [1e-6]\n    law.epsilom: [1]\n",
            (),
            "study.yaml, line 5, sweep.grid.law.epsilom",
            "did you mean 'epsilon'",
        ),
        (
            "set:\n  tolerance: 1e-6\n  law.epsilon: -1\n",
            (),
            "study.yaml, line 4, set.law.epsilon",
            "found -1",
        ),
        (
            "sweep:\n  zip: {tolerance: [1e-6]}\n  list:\n  - law.epsilon: -1\n",
            (),
            "study.yaml, line 5, sweep.list.0.law.epsilon",
            "found -1",
        ),
        (
            "sweep:\n  random:\n    count: 2\n    over:\n      law.epsilon: {uniform: [-2, -1]}\n",
            (),
            "study.yaml, line 6, sweep.random.over.law.epsilon",
            "found -1.",
        ),
        ("set: {law.epsilon: 1}\n", ("law.epsilon=-1",), "--set law.epsilon", "found -1"),
        ("set: {law.epsilon: 1}\n", ("lw.epsilon=1",), "--set lw.epsilon", "did you mean 'law'"),
        # What is swept replaces what is set: it alone can be wrong.
        (
            "set: {law.epsilon: 1}\nsweep:\n  grid:\n    law.epsilon: [-1]\n",
            (),
            "study.yaml, line 5, sweep.grid.law.epsilon",
            "found -1",
        ),
    ],
)
def test_the_wrong_key_is_blamed(
    folder: Path, text: str, overrides: tuple[str, ...], place: str, words: str
) -> None:
    message = refusal_of_check("scene: scene.yaml\n" + text, *overrides)
    assert message.startswith(f"{place}: scene.yaml, "), message
    assert words in message


def test_a_bad_scene_spoils_its_own_rows(folder: Path) -> None:
    Path("study.yaml").write_text("scene: [bad.yaml, scene.yaml]\n" + GRID)
    study = load_study(["study.yaml"])
    study.check()
    for chunk in chunks_of(study):
        assert len({ribbon.source.name for ribbon in chunk.ribbons}) == 1
    load_study(["bad.yaml", "scene.yaml"]).check()
    for text in ("scene: bad.yaml\n", "scene: [bad.yaml, bad.yaml]\n"):
        message = refusal_of_check(text + GRID)
        assert message.startswith("bad.yaml") and "line 3, bondary: unknown key" in message
    # A key of the study that fits one of its scenes only is wrong all the same.
    Path("other.yaml").write_text(SCENE.replace("regularized, epsilon", "variational, delta"))
    message = refusal_of_check("scene: [scene.yaml, other.yaml]\n" + GRID)
    assert message.startswith("study.yaml, line 2, sweep.grid.law.epsilon: other.yaml, ")


def test_a_scene_that_the_study_completes_is_sound(folder: Path) -> None:
    Path("part.yaml").write_text(SCENE.replace("{type: regularized, epsilon: 0.1}", ""))
    Path("study.yaml").write_text("scene: part.yaml\nset: {law: {type: regularized}}\n" + GRID)
    load_study(["study.yaml"]).check()


@pytest.mark.parametrize("head", ["", "name: a\n\n# lines\n" + GRID])
@pytest.mark.parametrize("tail", ["", "\n" + "# no more of it\nsave: all\n"])
def test_lines_of_a_scene_in_a_study_are_those_of_the_study(
    folder: Path, head: str, tail: str
) -> None:
    text = f"{head}scene: # as it stands\n{INLINE}{tail}"
    Path("study.yaml").write_text(text)
    (ribbon, *_) = load_study(["study.yaml"]).ribbons
    scene = loads_scene(ribbon.source.text, ribbon.source.name)
    assert scene == loads_scene(SCENE)
    faulty = text.replace("y: 0", "y: 0, w: 0")
    line = faulty[: faulty.index("w: 0")].count("\n") + 1
    message = refusal_of_check(faulty)
    assert message.startswith(f"study.yaml, line {line}, boundary.end.position.w: unknown key")


@pytest.mark.parametrize(
    "text",
    [
        "scene: {name: a, law: {type: sadowsky},\n boundary: {end: {position: &p [0, 0, 1]}}}\n",
        "{scene: {name: a, law: {type: sadowsky}, boundary: {end: {position: [0, 0, 1]}}}}\n",
        "scene:\n- name: a\n  law: {type: sadowsky}\n  boundary: {end: {position: [0, 0, 1]}}\n",
        "set: &law {law: {type: sadowsky}}\nscene:\n  name: a\n  law: {type: kirchhoff}\n"
        "  boundary: {end: {position: [0, 0, 1]}}\n",
    ],
)
def test_a_scene_in_a_study_may_be_written_in_any_style(folder: Path, text: str) -> None:
    Path("study.yaml").write_text(text)
    study = load_study(["study.yaml"])
    study.check()
    (ribbon,) = study.ribbons
    scene = loads_scene(ribbon.source.text, ribbon.source.name, ribbon.overrides)
    assert (scene.name, scene.law.type, scene.boundary.end.position) == ("a", "sadowsky", (0, 0, 1))
    message = refusal_of_check(text.replace("position", "positoin"))
    assert "study.yaml" in message and "did you mean 'position'" in message


def test_what_no_float_can_hold_and_broken_files(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("name: a\n")
    (tmp_path / "b.yaml").write_text("name: [b\n")
    found = load_study([tmp_path])
    assert found.count == 2
    numbers = [r.number for chunk in chunks_of(found) for r in chunk.ribbons]
    assert sorted(numbers) == [1, 2]
    path = tmp_path / "study.yaml"
    path.write_text(f"scene: a.yaml\nsweep: {{grid: {{x: [.inf, 1, 2, {10**400}, .nan]}}}}\n")
    assert sum(len(chunk.ribbons) for chunk in chunks_of(load_study([path]))) == 5
    path.write_text("scene: a.yaml\nsweep:\n  grid:\n    x: [1]\n    y: []\n")
    with pytest.raises(SceneError, match=r"line 5, sweep\.grid\.y: the sweep is empty"):
        load_study([path])


@pytest.mark.parametrize(
    "name", [name for name in NAMES_REFUSED if name.isprintable() or "\x1b" in name], ids=ascii
)
def test_names_of_studies_are_names_of_folders(folder: Path, name: str) -> None:
    message = refusal(f"name: {as_yaml(name)}\nscene: scene.yaml\n")
    assert "study.yaml, line 1, name: found" in message


def test_files_that_name_no_folder_name_no_study(folder: Path) -> None:
    for stem in ("..", "CON", "-a", "a:b", "equilibria", "a\n", " a"):
        (folder / f"{stem}.yaml").write_text("scene: scene.yaml\n")
        assert load_study([str(folder / f"{stem}.yaml")]).name == "batch"
    (folder / "arches 2.yaml").write_text("scene: scene.yaml\n")
    assert load_study([folder / "arches 2.yaml"]).name == "arches 2"
