"""Saved results that are not as they were written: one message that names what is wrong."""

import io
import json
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ribbonopt.errors import OutputError
from ribbonopt.output.results import load_solution, save_solution
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
HALF = ("moebius_half", "law={type: variational, delta: 0.1}")


@pytest.fixture(scope="module")
def sound(solved: Solved, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Return results: of the half band, of another one, and of one that has phases."""
    made = {}
    for name, given in (
        ("half", [*HALF, "law.delta=0.1"]),
        ("other", [*HALF, "law.delta=0.12"]),
        ("phases", ["clamped_arch"]),
    ):
        made[name] = tmp_path_factory.mktemp(name)
        save_solution(solved(*given), made[name])
    return made


@pytest.fixture
def saved(sound: dict[str, Path], tmp_path: Path) -> Path:
    return Path(shutil.copytree(sound["half"], tmp_path / "half"))


def refusal(folder: Path) -> str:
    with pytest.raises(OutputError) as refused:
        load_solution(folder)
    assert str(refused.value).count("\n") == 0
    return str(refused.value)


def with_summary(folder: Path, **changes: Any) -> Path:
    path = folder / "summary.json"
    data = json.loads(path.read_text()) | changes
    path.write_text(json.dumps({k: v for k, v in data.items() if v is not KeyError}))
    return path


def with_arrays(folder: Path, **changes: Any) -> Path:
    path = folder / "solution.npz"
    with np.load(path) as data:
        arrays = dict(data) | changes
    np.savez(path, **{k: v for k, v in arrays.items() if v is not None})
    return path


NUMBER, NAMES = "expected a number", "expected a mapping of names"
SUMMARIES: dict[str, tuple[dict[str, Any], str]] = {
    "missing": ({"message": KeyError}, "message: missing; expected text"),
    "null": ({"iterations": None}, "iterations: found null, expected a whole number >= 0"),
    "truth": ({"iterations": True}, "iterations: found true, expected a whole number >= 0"),
    "negative": ({"iterations": -1}, "iterations: found -1, expected a whole number >= 0"),
    "text": ({"worst_condition": "1"}, f"worst_condition: found '1', {NUMBER}"),
    "digits": ({"law_residual": 10**400}, "law_residual: found 1000"),
    "list": ({"timings": [1]}, f"timings: found [1], {NAMES}, each to a number"),
    "steps": ({"path": [1]}, f"path.0: found 1, {NAMES}"),
    "words": ({"skipped": [1]}, "skipped.0: found 1, expected text"),
    "half twists": ({"half_twists": "one"}, "half_twists: found 'one', expected a whole number"),
    "vector": ({"n0": [1, 2]}, "n0: found [1, 2], expected a list of 3 items, each a number"),
    "status": ({"status": "fine"}, "status: expected one of converged, max_iterations,"),
    "verified": ({"verified": False}, "verified: contradicts the status"),
    "drifts": ({"invariant_drift": {"n": 1.0}}, "invariant_drift: expected keys n, n_dot_m"),
    "two": ({"message": 1, "law_residual": []}, "message: found 1, expected text, and 1 more"),
}


@pytest.mark.parametrize("case", SUMMARIES)
def test_summaries_that_say_what_none_says(saved: Path, case: str) -> None:
    changes, words = SUMMARIES[case]
    path = with_summary(saved, **changes)
    message = refusal(saved)
    assert message.startswith(f"{path}: is damaged ({words}")
    assert message.endswith("); solve the scene again")


CONTRADICTIONS: dict[str, tuple[dict[str, Any], str]] = {
    "name": ({"name": "other"}, "summary.json says name: 'other', its scene 'moebius-half'"),
    "states": ({"states": "full"}, "summary.json says states: 'full'"),
    "parameters": ({"parameters": {"a": 1.0}}, "summary.json says parameters: {'a': 1.0}"),
    "unknowns": ({"unknowns": 502}, "summary.json says other unknowns"),
    "intervals": ({"intervals": 11}, "summary.json says other intervals"),
    "phases": ({"phases": [1]}, "summary.json says other phases"),
    "energy": ({"energy": 1e308}, "energy: what is told is not what the numbers give"),
    "force": ({"n0": [1.0, 2.0, 3.0]}, "n0: what is told is not what the numbers give"),
    "invariant": ({"H0": 0.0}, "H0: what is told is not what the numbers give"),
}


@pytest.mark.parametrize("case", CONTRADICTIONS)
def test_summaries_of_other_numbers(saved: Path, case: str) -> None:
    changes, words = CONTRADICTIONS[case]
    with_summary(saved, **changes)
    assert words in refusal(saved)


def test_summaries_of_other_versions_are_read(saved: Path, solved: Solved) -> None:
    with_summary(saved, fell_back=KeyError, given_up=KeyError, half_twists=KeyError, new=[{}])
    assert load_solution(saved).energy == solved(*HALF, "law.delta=0.1").energy


@pytest.mark.parametrize("file", ["scene.yaml", "summary.json", "solution.npz"])
def test_files_of_another_result(sound: dict[str, Path], saved: Path, file: str) -> None:
    shutil.copy(sound["other"] / file, saved)
    message = refusal(saved)
    if file == "summary.json":
        assert "what is told is not what the numbers give" in message
    else:
        assert "law.delta = 0." in message and "its scene says 0." in message


def test_other_scenes_in_python(saved: Path, configs: Path) -> None:
    scene = load_scene(configs / f"{HALF[0]}.yaml", [HALF[1], "law.delta=0.3"])
    with pytest.raises(OutputError, match=r"law\.delta = 0\.1, its scene says 0\.3"):
        load_solution(saved, scene)


def test_scenes_that_cannot_be_read(saved: Path) -> None:
    (saved / "scene.yaml").write_text("name: x\nlaw: 3\n")
    with pytest.raises(OutputError, match=r"scene\.yaml: 2 problems"):
        load_solution(saved)


# arrays

ROW = "expected a row of numbers"
ARRAYS: dict[str, tuple[Callable[[dict[str, Any]], dict[str, Any]], str]] = {
    "missing": (lambda a: {"w": None}, "w: missing"),
    "complex": (lambda a: {"w": a["w"] + 0j}, f"w: found an array (503,) of complex128, {ROW}"),
    "objects": (lambda a: {"theta": np.array([{}])}, "theta: found an array (1,) of object"),
    "truth": (lambda a: {"theta": a["theta"] > 0}, "theta: found an array (19,) of bool"),
    "matrix": (lambda a: {"widths": a["widths"][None]}, "widths: found an array (1, 10)"),
    "scalar": (lambda a: {"w": 3.0}, "w: found an array () of float64"),
    "floats": (lambda a: {"elements": np.array([10.0])}, "expected a row of whole numbers"),
    "not finite": (lambda a: {"w": a["w"] * np.nan}, "w: holds numbers that are not finite"),
    "shorter": (lambda a: {"w": a["w"][1:]}, "summary.json says other unknowns"),
    "widths": (lambda a: {"widths": a["widths"][1:]}, "widths: expected one for each element"),
    "sum": (lambda a: {"widths": a["widths"] * 2}, "relative widths add up to 2"),
    "negative": (lambda a: {"widths": -a["widths"]}, "widths must be positive"),
    "kinds": (lambda a: {"sheets": np.array([7])}, "sheets: expected kinds of phases"),
    "huge": (lambda a: {"elements": np.array([10**15])}, "widths: expected one for each"),
    "none": (lambda a: {"elements": np.array([], int)}, "elements: expected a number of them"),
    "zero": (lambda a: {"elements": np.array([0])}, "elements: expected a number of them"),
    "units": (lambda a: {"units": np.array([0.0, 1, 1])}, "units: expected a length, a force"),
    "two units": (lambda a: {"units": np.ones(2)}, "units: expected a length, a force"),
    "theta": (lambda a: {"theta": a["theta"] + 1}, "it was solved at law.delta = 1.1"),
    "numbers": (lambda a: {"w": a["w"] * 1.01}, "what is told is not what the numbers give"),
}


@pytest.mark.parametrize("case", ARRAYS)
def test_arrays_that_no_result_has(saved: Path, case: str) -> None:
    changes, words = ARRAYS[case]
    with np.load(saved / "solution.npz") as data:
        arrays = dict(data)
    with_arrays(saved, **changes(arrays))
    assert words in refusal(saved)


def test_numbers_may_be_stored_otherwise(saved: Path, solved: Solved) -> None:
    with np.load(saved / "solution.npz") as data:
        arrays = {name: data[name].astype(data[name].dtype.newbyteorder()) for name in data}
    with_arrays(saved, **arrays | {"units": None})
    assert load_solution(saved).energy == solved(*HALF, "law.delta=0.1").energy


def entries(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as file:
        return {name: file.read(name) for name in file.namelist()}


def header(shape: str) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": "<f8", "fortran_order": False, "shape": (0,)}
    )
    data = file.getvalue()
    return data[:10] + data[10:].replace(b"(0,)", shape.encode())[: len(data) - 10]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (header("(1000000000000,)") + bytes(8), "w: says that it has 1000000000000 numbers"),
        (header("(-1,)"), "w: says that it has -1 numbers"),
        (header("'text'"), "w: expected an array"),
        (header("(" * 20), "w: expected an array"),
        (b"", "w: expected an array"),
        (b"\x93NUMPY\x07\x00" + bytes(100), "w: expected an array"),
    ],
)
def test_entries_that_claim_what_is_not_there(saved: Path, data: bytes, words: str) -> None:
    path = saved / "solution.npz"
    known = entries(path)
    with zipfile.ZipFile(path, "w") as file:
        for name, content in known.items():
            file.writestr(name, data if name == "w.npy" else content)
    assert f"{path}: is damaged ({words}" in refusal(saved)


def test_packed_entries_are_not_unpacked(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = saved / "solution.npz"
    known = entries(path) | {"w.npy": header("(12500000,)") + bytes(10**8)}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in known.items():
            file.writestr(name, content)
    assert path.stat().st_size < 10**6

    def unpack(*_: object) -> bytes:
        raise AssertionError("unpacked")

    monkeypatch.setattr(zipfile.ZipFile, "read", unpack)
    assert "w.npy: is larger than the file" in refusal(saved)


def test_flipped_bits_of_arrays_are_seen(saved: Path) -> None:
    path = saved / "solution.npz"
    data = bytearray(path.read_bytes())
    with zipfile.ZipFile(path) as file:
        place = file.getinfo("w.npy").header_offset + 500
    data[place] ^= 1
    path.write_bytes(bytes(data))
    assert "no archive of arrays, BadZipFile" in refusal(saved)


# all that is solved comes back

KINDS = {
    "phases": ("clamped_arch", ()),
    "energy": ("moebius_half", ("formulation=energy",)),
    "sizes": ("ribbon_si", ()),
    "planar": ("snap", ("states=planar",)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_sound_results_are_never_refused(configs: Path, tmp_path: Path, kind: str) -> None:
    name, given = KINDS[kind]
    found = solve(load_scene(configs / f"{name}.yaml", given))
    save_solution(found, tmp_path)
    loaded = load_solution(tmp_path)
    assert (loaded.status, loaded.energy) == (found.status, found.energy)


def test_failed_results_are_never_refused(configs: Path, tmp_path: Path) -> None:
    found = solve(
        load_scene(
            configs / "moebius_half.yaml",
            [
                "solver={type: newton, max_iterations: 1}",
                "guess={force: [0, 90, 1], moment: [0, 9, 9]}",
            ],
        )
    )
    assert not found.status.converged
    save_solution(found, tmp_path)
    assert load_solution(tmp_path).status is found.status
