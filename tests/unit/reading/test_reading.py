"""Files from outside: whatever a path leads to, reading ends, in its contents or in one message."""

import json
import os
import random
import socket
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from ribbonopt import reading
from ribbonopt.errors import OutputError, SceneError
from ribbonopt.plain import parsed
from ribbonopt.reading import Kind, is_file, read_bytes, read_json, read_lines, read_text
from ribbonopt.scene import load_scene, locate
from ribbonopt.studies.batch.sweep import load_study

SMALL = Kind("a small file", most=1000, line=100)
PIPED = Kind("a small file", most=1000, error=SceneError, piped=True)
SECRET = "hunter2"

posix = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "file"


@pytest.mark.parametrize("text", ["", "a\n", "é\n\r\n", "\ufeffa", "x" * 999])
def test_a_text_is_read(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="")
    assert read_text(path, SMALL) == text.removeprefix("\ufeff")
    assert read_bytes(str(path), SMALL) == text.encode()


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("é".encode("latin-1"), "not a text in UTF-8 (byte 0)"),
        ("é".encode("utf-16"), "it seems to be in UTF-16: save it in UTF-8"),
        (b"x" * 1001, "is larger than 0 MB; expected a small file"),
    ],
)
def test_what_is_no_small_text_is_refused(path: Path, data: bytes, words: str) -> None:
    path.write_bytes(data)
    with pytest.raises(OutputError) as refused:
        read_text(path, SMALL)
    assert str(refused.value).startswith(f"{path}: ")
    assert words in str(refused.value)


def test_a_file_that_says_no_size_is_not_read_beyond_its_limit() -> None:
    status = Path("/proc/self/status")
    if not status.exists():
        pytest.skip("no files without a size")
    assert status.stat().st_size == 0
    assert b"Name:" in read_bytes(status, Kind("a status", most=100_000))
    with pytest.raises(OutputError, match="is larger than"):
        read_bytes(status, Kind("a status", most=100))


def test_a_huge_file_costs_nothing(path: Path) -> None:
    with open(path, "wb") as file:
        file.truncate(2**40)
    with pytest.raises(OutputError, match="is larger than 64 MB"):
        read_bytes(path, Kind("a file", most=64 * reading.MEGA))


def as_folder(path: Path) -> None:
    path.mkdir()


def as_zeros(path: Path) -> None:
    path.symlink_to("/dev/zero")


def as_socket(path: Path) -> None:
    os.chdir(path.parent)  # names of sockets are short
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(path.name)


def as_link(path: Path) -> None:
    path.symlink_to(path.with_name("nowhere"))


def as_loop(path: Path) -> None:
    path.symlink_to(path)


ODD: dict[str, tuple[Callable[[Path], None], str]] = {
    "folder": (as_folder, "is a directory; expected a small file"),
    "zeros": (as_zeros, "is a device; expected a small file"),
    "socket": (as_socket, "is a socket; expected a small file"),
    "pipe": (lambda path: os.mkfifo(path), "is a pipe; expected a small file"),
    "broken link": (as_link, "no such file"),
    "loop": (as_loop, "cannot be read: "),
    "nothing": (lambda path: None, "no such file"),
}


@posix
@pytest.mark.parametrize("name", ODD)
def test_what_is_no_file_is_refused(path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    make, words = ODD[name]
    make(path)
    for read in (read_bytes, read_text, read_json, lambda *given: list(read_lines(*given))):
        with pytest.raises(OutputError) as refused:
            read(path, SMALL)
        assert str(refused.value).startswith(f"{path}: {words}")
    assert not is_file(path)


@pytest.mark.parametrize("name", ["a\0b", "a" * 5000, ""])
def test_paths_that_no_system_has(name: str) -> None:
    assert not is_file(name)
    with pytest.raises(OutputError):
        read_bytes(name, SMALL)


@pytest.mark.skipif(getattr(os, "geteuid", lambda: 0)() == 0, reason="root may read all")
def test_a_file_without_permission(path: Path) -> None:
    path.write_text(SECRET)
    path.chmod(0)
    with pytest.raises(OutputError, match="cannot be read: Permission denied"):
        read_text(path, SMALL)


def written(path: Path, *pieces: bytes) -> threading.Thread:
    """Write to a pipe from a thread, piece by piece, as long as it is read."""

    def write() -> None:
        try:
            with open(path, "wb", buffering=0) as file:
                for piece in pieces:
                    file.write(piece)
        except BrokenPipeError:
            pass

    thread = threading.Thread(target=write, daemon=True)
    thread.start()
    return thread


@posix
def test_a_pipe_is_read_to_its_end(path: Path) -> None:
    os.mkfifo(path)
    thread = written(path, b"ab", b"c" * 500, b"d")
    assert read_text(path, PIPED) == "ab" + "c" * 500 + "d"
    thread.join()


@posix
def test_a_pipe_without_end_is_refused(path: Path) -> None:
    os.mkfifo(path)
    thread = written(path, *[b"x" * 1000] * 1000)
    with pytest.raises(SceneError, match="is larger than"):
        read_text(path, PIPED)
    thread.join()


@posix
@pytest.mark.parametrize("begun", [False, True])
def test_a_pipe_that_nobody_ends_is_given_up(
    path: Path, begun: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "PATIENCE", 0.1)
    os.mkfifo(path)
    held = os.open(path, os.O_RDWR)  # a writer that stays
    if begun:
        os.write(held, b"name: x\n")
    with pytest.raises(SceneError, match=r"is a pipe that did not end within 0\.1 s"):
        load_scene(path)
    with pytest.raises(SceneError, match=r"is a pipe that did not end within 0\.1 s"):
        load_study([path])
    os.close(held)


@posix
def test_a_scene_comes_through_a_pipe(path: Path, configs: Path) -> None:
    os.mkfifo(path)
    shipped = configs / "helix.yaml"
    thread = written(path, shipped.read_bytes())
    assert load_scene(path) == load_scene(shipped)
    thread.join()
    # a pipe is not read again to say where a key stood
    assert locate(path, [], "law") == ""
    assert locate(shipped, [], "law").startswith("line ")


@pytest.mark.parametrize("seed", range(5))
def test_lines_are_those_of_the_file(path: Path, seed: int) -> None:
    chance = random.Random(seed)
    lines = [bytes(chance.choices(b"ab\r\0", k=chance.randrange(90))) for _ in range(50)]
    data = b"\n".join(lines)
    path.write_bytes(data)
    *whole, last = lines
    expected = [line + b"\n" for line in whole] + [last] * bool(last)
    assert list(read_lines(path, Kind("lines", most=10**6))) == expected


def test_lines_go_on_from_piece_to_piece(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "PIECE", 7)
    path.write_bytes(b"one\ntwo is longer\n\nlast")
    assert list(read_lines(path, SMALL)) == [b"one\n", b"two is longer\n", b"\n", b"last"]
    path.write_bytes(b"one\n" + b"x" * 200)
    with pytest.raises(OutputError, match="has a line of more than 0 MB"):
        list(read_lines(path, SMALL))


# JSON

UNSOUND = {
    "NaN": "not finite",
    "[1, -Infinity]": "not finite",
    '{"a": 1e999}': "not finite",
    "-1e999": "not finite",
    f'{{"{SECRET}": 1, "{SECRET}": 2}}': "a key that stands twice",
    "[" * 100_000: "lists in lists without end",
    '{"a":' * 100 + "1" + "}" * 100: "in each other, more than 60",
    "1" * 5000: "a number of too many digits",
    f"{SECRET}": "no JSON at line 1, column 1",
    f'{{"a": 1}}\n{SECRET}': "no JSON at line 2, column 1",
    "": "no JSON at line 1, column 1",
}


@pytest.mark.parametrize("text", UNSOUND, ids=range(len(UNSOUND)))
def test_unsound_json_is_refused_and_not_quoted(path: Path, text: str) -> None:
    with pytest.raises(ValueError, match=UNSOUND[text]) as refused:
        parsed(text)
    assert SECRET not in str(refused.value)
    path.write_text(text)
    with pytest.raises(OutputError, match=UNSOUND[text]) as damaged:
        read_json(path, Kind("numbers", most=10**7, remedy="write them again"))
    assert SECRET not in str(damaged.value)
    assert str(damaged.value).endswith("; write them again")


def test_sound_json_is_what_json_reads() -> None:
    value = {
        "a": [1, -0.0, 1e308, 5e-324, True, None, "é\U0001f600"],
        "b": {"c": [[[]]]},
        "": 10**300,
    }
    assert parsed(json.dumps(value)) == value
    assert parsed(json.dumps(value).encode()) == value
    deepest = json.loads("[" * 60 + "]" * 60)
    assert parsed(json.dumps(deepest)) == deepest
    with pytest.raises(ValueError, match="not a text in UTF-8"):
        parsed('"é"'.encode("utf-16"))
