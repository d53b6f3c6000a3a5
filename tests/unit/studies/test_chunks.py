"""Chunks of a study: neighbours together, whatever the order they are listed in."""

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from half_studies import BAD, SCENE, VARIATIONAL, loaded, swept
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.studies.batch.chunks import Chunk, chunks_of
from ribbonopt.studies.batch.inputs import InputRows, rows_of
from ribbonopt.studies.batch.study import Source, Study, StudyRibbon, Sweep
from ribbonopt.studies.batch.sweep import load_study


def numbers(chunks: list[Chunk]) -> list[list[int]]:
    return [[ribbon.number for ribbon in chunk.ribbons] for chunk in chunks]


VALUES = st.sampled_from([0, 1, 2.5, -1e3, True, "x", "y", None])


@given(
    st.fixed_dictionaries(
        {},
        optional={
            "grid": st.dictionaries(
                st.sampled_from("abc"), st.lists(VALUES, min_size=1, max_size=5), min_size=1
            ),
            "list": st.lists(st.dictionaries(st.sampled_from("de"), VALUES), min_size=1),
        },
    ).filter(bool)
)
def test_chunks_divide_a_study(sweep: dict[str, Any]) -> None:
    study = swept(**sweep)
    chunks = chunks_of(study)
    assert sorted(itertools.chain(*numbers(chunks))) == list(range(1, study.count + 1))
    assert numbers(chunks_of(swept(**sweep))) == numbers(chunks)
    for chunk in chunks:
        assert 1 <= len(chunk.ribbons) <= math.isqrt(study.count - 1) + 1
        assert len({kept(ribbon) for ribbon in chunk.ribbons}) == 1


def kept(ribbon: StudyRibbon) -> str:
    """All of a ribbon that is no number among its inputs."""
    inputs = {k: "number" if type(v) in (int, float) else v for k, v in ribbon.inputs.items()}
    return repr((ribbon.source, ribbon.common, inputs))


@pytest.mark.parametrize("both", ["scenes", "settings"])
def test_scenes_that_differ_are_not_chunked_together(tmp_path: Path, both: str) -> None:
    """Two scenes in one file, and one scene under two laws."""
    sweep = "sweep: {grid: {tolerance: [1e-5, 1e-6, 1e-7]}}\n"
    laws = "{type: sadowsky}", "{type: variational, delta: 0.1}"
    if both == "scenes":
        inline = ", ".join(f"{{name: a, law: {law}, boundary: {{}}}}" for law in laws)
        study = loaded(tmp_path, f"scene: [{inline}]\n{sweep}")
    else:
        for name, law in zip("ab", laws, strict=True):
            loaded(tmp_path, f"scene: scene.yaml\nset: {{law: {law}}}\n{sweep}")
            (tmp_path / "study.yaml").rename(tmp_path / f"{name}.yaml")
        study = load_study([tmp_path / "a.yaml", tmp_path / "b.yaml"])
    for chunk in chunks_of(study):
        assert len({kept(ribbon) for ribbon in chunk.ribbons}) == 1


@pytest.mark.parametrize("count", [1, 2, 3, 10, 100, 101, 2500, 25_000])
def test_chunks_are_about_as_long_as_they_are_many(count: int) -> None:
    spaced = {"from": 0, "to": 1, "count": count}
    lengths = [len(chunk.ribbons) for chunk in chunks_of(swept(grid={"a": spaced}))]
    longest = min(math.ceil(math.sqrt(count)), 100)
    assert lengths == [longest] * (count // longest) + [count % longest] * (count % longest > 0)


@pytest.mark.parametrize("count", [2, 3, 40, 150])
def test_each_ribbon_is_the_nearest_of_those_left(count: int) -> None:
    over = {
        "a": {"log_uniform": [1e-6, 1e-4]},
        "b": {"uniform": [-1e3, 1e3]},
        "c": {"normal": [0, 1]},
    }
    inputs = rows_of(Path(), {"random": {"count": count, "seed": 4, "over": over}})
    study = Study("s", (Sweep(Source("s", SCENE), {}, with_constant(inputs)),))
    spans = {k: max(r[k] for r in inputs) - min(r[k] for r in inputs) for k in over}

    def gap(one: StudyRibbon, two: StudyRibbon) -> float:
        return sum(abs(one.inputs[k] - two.inputs[k]) / spans[k] for k in over)

    walk = [ribbon for chunk in chunks_of(study) for ribbon in chunk.ribbons]
    assert len(walk) == count
    for i in range(count - 1):
        nearest = min(gap(walk[i], other) for other in walk[i + 1 :])
        assert gap(walk[i], walk[i + 1]) == pytest.approx(nearest, abs=1e-12)


def with_constant(inputs: InputRows) -> InputRows:
    """Add a key that has no range."""
    return replace(inputs, keys=(*inputs.keys, "d"), at=lambda i: inputs.at(i) | {"d": 7})


def test_plain_scenes_are_chunked_by_what_they_share(tmp_path: Path) -> None:
    for name, epsilon in zip("abcde", (0.1, 0.01, 0.05, 0.2, 0.02), strict=True):
        (tmp_path / f"{name}.yaml").write_text(SCENE.replace("0.1", str(epsilon)))
    (tmp_path / "f.yaml").write_text(BAD)
    (tmp_path / "g.yaml").write_text(VARIATIONAL)
    (tmp_path / "h.yaml").write_text(VARIATIONAL.replace("0.1", "0.2").replace("43", "40"))
    (tmp_path / "i.yaml").write_text(BAD)
    study = load_study([tmp_path])
    names = [[Path(r.source.name).stem for r in c.ribbons] for c in chunks_of(study)]
    # By epsilon: 0.01, 0.02, 0.05, 0.1, 0.2, in chunks of three at most.
    assert names == [["b", "e", "c"], ["a", "d"], ["f"], ["g", "h"], ["i"]]
    # What is set for all may make them the same.
    common = load_study([tmp_path / "a.yaml", tmp_path / "g.yaml"], ["law={type: sadowsky}"])
    assert numbers(chunks_of(common)) == [[1, 2]]


@pytest.mark.parametrize("count", [2, 3, 12, 40])
def test_chunks_do_not_depend_on_the_order_of_a_list(count: int) -> None:
    listed = [{"a": i % 4, "b": float(i // 4)} for i in range(count)]  # many gaps are equal
    shuffled = [listed[i] for i in np.random.default_rng(3).permutation(count)]
    one, two = (
        [[ribbon.inputs for ribbon in chunk.ribbons] for chunk in chunks_of(swept(list=some))]
        for some in (listed, shuffled)
    )
    assert one == two
