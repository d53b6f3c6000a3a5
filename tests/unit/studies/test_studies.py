"""Studies as they are read: the rows of every kind of sweep, and the scenes."""

import itertools
import json
import math
import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import NormalDist
from typing import Any

import numpy as np
import pytest
from half_studies import SCENE, loaded
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene, Variational, loads_scene
from ribbonopt.scene.yamlio import plain_yaml
from ribbonopt.studies.batch.inputs import rows_of
from ribbonopt.studies.batch.study import Study, StudyRibbon, assignments
from ribbonopt.studies.batch.sweep import load_study


def rows(**sweep: Any) -> list[dict[str, Any]]:
    return list(rows_of(Path(), sweep))


def scene_of(ribbon: StudyRibbon) -> Scene:
    return loads_scene(ribbon.source.text, ribbon.source.name, ribbon.overrides)


def epsilons(study: Study) -> list[float]:
    return [scene_of(ribbon).law.epsilon for ribbon in study.ribbons]  # type: ignore[union-attr]


@given(
    st.dictionaries(
        st.text("abc.", min_size=1), st.lists(st.integers(), min_size=1, max_size=4), min_size=1
    )
)
def test_a_grid_is_the_product_in_the_order_of_the_file(axes: dict[str, list[int]]) -> None:
    axes = dict(itertools.islice(axes.items(), 4))
    found = rows(grid=axes)
    assert found == [dict(zip(axes, row, strict=True)) for row in itertools.product(*axes.values())]
    assert all(list(row) == list(axes) for row in found)


def test_zip_and_list() -> None:
    spaced = {"from": 0, "to": 1, "count": 3}
    assert rows(zip={"b": [1, "x", None], "a": spaced}) == [
        {"b": 1, "a": 0.0},
        {"b": "x", "a": 0.5},
        {"b": None, "a": 1.0},
    ]
    given = [{"a": 1}, {"b": [1, 2]}, {"b": True, "a": 0}]
    assert rows(list=given) == given
    assert rows_of(Path(), {"list": given}).keys == ("a", "b")


def test_kinds_are_multiplied_in_the_order_of_the_file() -> None:
    kinds = {"zip": {"a": [1, 2], "b": [3, 4]}, "list": [{"c": 5}, {"d": 6}], "grid": {"e": [7, 8]}}
    for order in itertools.permutations(kinds):
        parts = [rows(**{kind: kinds[kind]}) for kind in order]
        expected = [
            {k: v for part in row for k, v in part.items()} for row in itertools.product(*parts)
        ]
        found = rows_of(Path(), {kind: kinds[kind] for kind in order})
        assert list(found) == expected
        assert (found.size, len(found), found[:]) == (8, 8, expected)
        assert set(found.keys) == set("abcde")
    with pytest.raises(IndexError):
        found[8]


def test_csv_cells_are_yaml(tmp_path: Path) -> None:
    (tmp_path / "rows.csv").write_text(
        ' law.a ,b,"c"\n1,1e-3,"[1, 2]"\ntrue,"x, y",\n-0.5,"""7""","{type: sadowsky}"\n\n,,\n \n',
        encoding="utf-8-sig",  # as spreadsheets write it
    )
    found = list(rows_of(tmp_path, {"csv": "rows.csv"}))
    assert found == [
        {"law.a": 1, "b": 1e-3, "c": [1, 2]},
        {"law.a": True, "b": "x, y", "c": None},
        {"law.a": -0.5, "b": "7", "c": {"type": "sadowsky"}},
    ]
    assert [type(row["law.a"]) for row in found] == [int, bool, float]


SPACED = [(0.1, 0.7, 7), (0, 1, 11), (3, -2, 4), (0.83, 0.01, 13), (2.5, 9, 1), (-1, 1, 2)]
POWERS = [(0.1, 1e-6, 6), (0.31, 0.43, 17), (1, 1000, 4), (7.0, 8, 1), (1e-300, 1e300, 5)]


@pytest.mark.parametrize(("first", "last", "count"), SPACED)
def test_numbers_are_evenly_spaced(first: float, last: float, count: int) -> None:
    spaced = {"from": first, "to": last, "count": count}
    for item in (spaced, spaced | {"scale": "linear"}):
        found = [row["a"] for row in rows(grid={"a": item})]
        assert found == pytest.approx(np.linspace(first, last, count).tolist(), rel=1e-14)
        assert all(type(value) is float for value in found)


@pytest.mark.parametrize(("first", "last", "count"), POWERS)
def test_powers_are_evenly_spaced(first: float, last: float, count: int) -> None:
    item = {"from": first, "to": last, "count": count, "scale": "log"}
    found = [row["a"] for row in rows(grid={"a": item})]
    assert found == pytest.approx(np.geomspace(first, last, count).tolist(), rel=1e-13, abs=0)


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_the_ends_are_the_numbers_given(scale: str) -> None:
    for first, last in itertools.permutations((0.01, 0.19, 0.31, 0.43, 0.83, 0.87), 2):
        item = {"from": first, "to": last, "count": 17, "scale": scale}
        found = [row["a"] for row in rows(grid={"a": item})]
        assert (found[0], found[-1]) == (first, last)


DISTRIBUTIONS: dict[str, tuple[list[float], Callable[[float], float]]] = {
    "uniform": ([-1, 3], lambda x: (x + 1) / 4),
    "log_uniform": ([1e-6, 10], lambda x: math.log10(x * 1e6) / 7),
    "normal": ([2, 0.5], NormalDist(2, 0.5).cdf),
}


@pytest.mark.parametrize("kind", DISTRIBUTIONS)
def test_draws_have_their_distribution(kind: str) -> None:
    two, share = DISTRIBUTIONS[kind]
    sizes = {"count": 10_000, "seed": 3}
    found = rows(random=sizes | {"over": {"other": {"uniform": [0, 1]}, "a": {kind: two}}})
    shares = sorted(share(row["a"]) for row in found)
    assert 0 <= shares[0] <= shares[-1] <= 1
    # Kolmogorov and Smirnov: further off in one of a hundred seeds.
    assert max(abs(i / 10_000 - x) for i, x in enumerate(shares, 1)) < 1.63 / 100
    # Neither the last draw nor the other key says anything of the next.
    draws = np.array([[share(row["a"]), row["other"]] for row in found])
    assert abs(np.corrcoef(draws[1:, 0], draws[:-1, 0])[0, 1]) < 0.035
    assert abs(np.corrcoef(draws.T)[0, 1]) < 0.035


def test_draws_depend_on_the_seed_and_their_own_key() -> None:
    def drawn(seed: int, **over: Any) -> list[float]:
        return [r["b"] for r in rows(random={"count": 9, "seed": seed, "over": over})]

    one, two = {"uniform": [0, 1]}, {"normal": [5, 2]}
    assert drawn(1, a=one, b=two) == drawn(1, a=two, b=two) == drawn(1, a=one, b=two, c=one)
    assert len({*drawn(1, a=one, b=two), *drawn(2, a=one, b=two), *drawn(0, a=one, b=two)}) == 27
    unseeded = rows(random={"count": 9, "over": {"a": one, "b": two}})
    assert [row["b"] for row in unseeded] == drawn(0, a=one, b=two)


@pytest.mark.parametrize("kind", ["uniform", "log_uniform"])
@pytest.mark.parametrize("bounds", [(0.1, 0.1), (0.3, 0.3), (0.7, math.nextafter(0.7, 1))])
def test_draws_keep_to_narrow_bounds(kind: str, bounds: tuple[float, float]) -> None:
    drawn = rows(random={"count": 50, "over": {"a": {kind: list(bounds)}}})
    assert all(bounds[0] <= row["a"] <= bounds[1] for row in drawn)


def test_a_huge_study_costs_nothing_before_its_rows_are_made(tmp_path: Path) -> None:
    axis = {"from": 0.1, "to": 1, "count": 10**5}
    sweep = {"grid": {"law.epsilon": axis, "interval.1": axis}}
    tracemalloc.start()
    study = loaded(tmp_path, json.dumps({"scene": "scene.yaml", "sweep": sweep}))
    assert study.count == 10**10
    assert study.sweeps[0].inputs[10**10 - 1] == {"law.epsilon": 1.0, "interval.1": 1.0}
    huge = {"count": 10**12, "over": {"law.epsilon": {"uniform": [0, 1]}}}
    assert rows_of(Path(), {"random": huge, "zip": {"a": [1, 2]}}).size == 2 * 10**12
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 5e7  # 10 MB: two lists of 10^5 numbers, and what they were read from


def test_scenes_folders_and_patterns(tmp_path: Path) -> None:
    (tmp_path / "odd[1].yaml").write_text(SCENE)
    (tmp_path / "more").mkdir()
    for name in ("b.yaml", "a.yml", "notes.txt", "c.yaml"):
        (tmp_path / "more" / name).write_text(SCENE)
    sweep = "{list: [{law.epsilon: 0.2}, {law.epsilon: 0.3}]}"
    study = loaded(tmp_path, f"scene: [scene.yaml, 'odd[1].yaml']\nsweep: {sweep}\n")
    assert (study.name, study.count, study.keys) == ("study", 4, ("law.epsilon",))
    assert [(r.number, Path(r.source.name).name) for r in study.ribbons] == list(
        zip(range(1, 5), ["scene.yaml"] * 2 + ["odd[1].yaml"] * 2, strict=True)
    )
    assert epsilons(study) == [0.2, 0.3, 0.2, 0.3]

    def names(*paths: str) -> list[str]:
        found = load_study([tmp_path / path for path in paths])
        return [Path(sweep.source.name).name for sweep in found.sweeps]

    assert names("more") == ["a.yml", "b.yaml", "c.yaml"]
    assert names("more/*.yaml", "odd[1].yaml") == ["b.yaml", "c.yaml", "odd[1].yaml"]
    assert names("**/[bc].yaml") == ["b.yaml", "c.yaml"]
    assert load_study([tmp_path / "more"]).name == "batch"
    assert load_study([tmp_path / "odd[1].yaml"]).name == "odd[1]"


def test_settings_of_a_study(tmp_path: Path) -> None:
    plain = loaded(tmp_path, "scene: scene.yaml\n")
    assert (plain.count, plain.save, plain.time_limit) == (1, "failed", 300.0)
    study = loaded(tmp_path, "{name: mine, scene: scene.yaml, save: all, time_limit: 2.5}")
    assert (study.name, study.save, study.time_limit) == ("mine", "all", 2.5)


def test_the_command_line_wins_over_set(tmp_path: Path) -> None:
    text = "scene: scene.yaml\nset: {law: {type: variational, delta: 0.2}, tolerance: 1e-5}\n"
    (ribbon,) = loaded(tmp_path, text, "tolerance=1e-6", "law.delta = 0.3").ribbons
    scene = scene_of(ribbon)
    assert (scene.tolerance, scene.law) == (1e-6, Variational(delta=0.3))
    (ribbon,) = loaded(tmp_path, text).ribbons
    assert (scene_of(ribbon).tolerance, scene_of(ribbon).law) == (1e-5, Variational(delta=0.2))
    alone = load_study([tmp_path / "scene.yaml"], ["law.epsilon=0.4"])
    assert epsilons(alone) == [0.4]


def test_the_command_line_is_not_passed_over_where_its_key_is_swept(tmp_path: Path) -> None:
    """`--set` is an override for all ribbons: it is obeyed, or refused."""
    text = "scene: scene.yaml\nsweep: {grid: {law.epsilon: [0.1, 0.2]}}\n"
    try:
        found = epsilons(loaded(tmp_path, text, "law.epsilon=0.7"))
    except SceneError as error:
        assert "law.epsilon" in str(error)
    else:
        assert set(found) == {0.7}


@given(
    st.recursive(
        st.none()
        | st.booleans()
        | st.integers(-(10**30), 10**30)
        | st.floats(allow_nan=False, allow_infinity=False)
        | st.text(st.characters(exclude_categories=["C"]), max_size=5),
        lambda inner: st.lists(inner, max_size=2) | st.dictionaries(st.text("ab"), inner),
        max_leaves=3,
    )
)
def test_values_come_to_the_scene_as_they_are(value: Any) -> None:
    (text,) = assignments({"a.b": value})
    assert text.startswith("a.b=")
    found = plain_yaml(text.removeprefix("a.b="), "")
    assert found == value and type(found) is type(value)


def test_the_digest_tells_all_that_decides_rows(tmp_path: Path) -> None:
    text = (
        "name: one\nscene: scene.yaml\nset: {tolerance: 1e-5}\nsweep: {grid: {law.epsilon: [1, 2]}}"
    )
    study = loaded(tmp_path, text)
    digests = [study.digest]
    for old, new in (("1e-5", "1e-6"), ("[1, 2]", "[1, 3]"), ("[1, 2]", "[2, 1]"), ("1, 2", "1")):
        digests.append(loaded(tmp_path, text.replace(old, new)).digest)
    digests.append(loaded(tmp_path, text, "tolerance=1e-4").digest)
    digests.append(loaded(tmp_path, text.replace("scene.yaml", "[scene.yaml, scene.yaml]")).digest)
    (tmp_path / "other.yaml").write_text(SCENE.replace("43", "44"))
    digests.append(loaded(tmp_path, text.replace("scene.yaml", "other.yaml")).digest)
    assert len(set(digests)) == len(digests) == 8
    assert loaded(tmp_path, text.replace("one", "two")).digest == study.digest
    assert replace(study, save="all", time_limit=1.0).digest == study.digest
