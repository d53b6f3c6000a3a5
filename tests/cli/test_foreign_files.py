"""Files that are no scenes: nothing of them is printed, whatever they are, and nothing hangs."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from branches import environment
from conftest import Run

SECRET = "hunter2"
FOREIGN = {
    "shadow": f"root:$6${SECRET}:19000:0:99999:7:::\nme:{SECRET}:19000:0:99999:7:::\n",
    "passwd": f"{SECRET}:x:0:0:root:/root:/bin/bash\n",
    "key": f"-----BEGIN OPENSSH PRIVATE KEY-----\n{SECRET}b3BlbnNzaA==\n-----END-----\n",
    "environment": f"PASSWORD={SECRET}\nTOKEN='{SECRET}\n",
    "ini": f"[default]\nsecret = {SECRET}\n",
    "json": f'{{"{SECRET}": "{SECRET}"}}\n',
    "alias": f"*{SECRET}\n",
    "anchor": f"{SECRET}: &{SECRET} [*{SECRET}]\n",
    "tag": f"!{SECRET} x\n",
    "directive": f"%{SECRET}\n---\n",
    "twice": f"{SECRET}: 1\n{SECRET}: 2\n",
    "complex key": f"? [{SECRET}]\n: 1\n",
    "table": f"user,password\nme,{SECRET}\n",
    "quotes": f'"{SECRET}\n',
    "list": f"- {SECRET}\n- {{{SECRET}: [{SECRET}\n",
    "control": f"a: {SECRET}\0\n",
}


@pytest.mark.parametrize("name", FOREIGN)
def test_nothing_of_a_foreign_file_is_printed(run: Run, tmp_path: Path, name: str) -> None:
    (tmp_path / "foreign").write_text(FOREIGN[name])
    (tmp_path / "study.yaml").write_text("scene: foreign\nsweep: {grid: {starts: [1, 2]}}\n")
    (tmp_path / "table.yaml").write_text("scene: {name: x}\nsweep: {csv: foreign}\n")
    (tmp_path / "folder").mkdir()
    for file in ("summary.json", "solution.npz", "scene.yaml", "study.json", "rows.jsonl"):
        (tmp_path / "folder" / file).write_text(FOREIGN[name])
    for command in (
        ("solve", "foreign"),
        ("check", "foreign", "--json"),
        ("continue", "foreign"),
        ("batch", "foreign"),
        ("batch", "study.yaml"),
        ("batch", "table.yaml"),
        ("plot", "folder"),
    ):
        status, out, err = run(*command)
        assert status == 2
        assert SECRET not in out + err, err
        assert err.startswith("ribbonopt: ") and err.count("\n") == 1, err
    for file in ("summary.json", "rows.jsonl"):
        (tmp_path / "folder" / file).unlink(missing_ok=True)
        assert run("plot", "folder").status == 2


def test_a_misspelt_scene_is_quoted(run: Run, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text("nam: x\nlow: {type: sadowsky}\nbondary: {}\n")
    err = run("solve", "scene.yaml").err
    assert "did you mean 'name'" in err and "did you mean 'boundary'" in err
    (tmp_path / "scene.yaml").write_text("{}\n")
    assert "boundary: missing" in run("solve", "scene.yaml").err


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
@pytest.mark.parametrize("verb", ["solve", "batch"])
def test_devices_and_pipes_of_nobody_end_at_once(
    run: Run, tmp_path: Path, verb: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("ribbonopt.reading.PATIENCE", 0.05)
    os.mkfifo(tmp_path / "pipe")
    for path, words in (
        ("/dev/zero", "is a device"),
        ("pipe", "is a pipe that did not end"),
        ("a" * 5000, "cannot be read: "),
    ):
        status, _, err = run(verb, path)
        assert status == 2
        assert words in err
    message = run("plot", "a" * 5000).err
    assert "no such folder" in message


@pytest.mark.skipif(not Path("/dev/stdin").exists(), reason="no name for the standard input")
def test_a_scene_may_come_from_the_standard_input(configs: Path) -> None:
    def given(text: bytes, *arguments: str) -> subprocess.CompletedProcess[bytes]:
        return subprocess.run(
            [sys.executable, "-m", "ribbonopt", *arguments],
            input=text,
            capture_output=True,
            env=environment(),
            check=False,
        )

    scene = (configs / "helix.yaml").read_bytes()
    done = given(scene, "check", "/dev/stdin")
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.startswith(b"helix: valid")
    # a fault of the mechanics, whose line could only be found by reading again
    half = (configs / "moebius_half.yaml").read_bytes()
    done = given(half.replace(b", force: {d1: 0}", b""), "check", "/dev/stdin")
    assert done.returncode == 2
    assert done.stderr.startswith(b"ribbonopt: /dev/stdin: ")
    assert b"13 unknown" in done.stderr
