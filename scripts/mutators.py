"""Ways to spoil a file: its bytes, what its JSON says, its arrays, or what it is at all.

Each takes a source of chance and a file, changes the file and returns in words what was done.
"""

from __future__ import annotations

import base64
import io
import json
import os
import random
import socket
import zipfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

DEEP = 100_000
RAW = "@raw@"  # stands for text that `json.dumps` would not write
#: values that no reader expects; of (RAW, text) the text is written as it is
ODD: tuple[Any, ...] = (
    *(
        None,
        True,
        False,
        0,
        -1,
        1,
        2,
        7,
        10**9,
        10**18,
        10**400,
        -(2**63),
        0.5,
        -0.0,
        1e308,
        5e-324,
    ),
    *("", " ", "text", "0", "\ud800", "\0", "\x1b[31m", "<script>", "../../evil", "x" * 100_000),
    *([], {}, [[]], [1], [1.5, 2], ["a"], [None], {"a": 1}, {"type": "sadowsky"}, [True] * 3),
    *((RAW, "NaN"), (RAW, "-Infinity"), (RAW, "1e999"), (RAW, "1" * 5000), (RAW, "01")),
    (RAW, "[" * DEEP + "]" * DEEP),
    (RAW, '{"a":' * 500 + "1" + "}" * 500),
    (RAW, '{"a": 1, "a": 2}'),
)
ODD_NODES = ("folder", "fifo", "zeros", "socket", "broken link", "missing", "5 GB", "loop")


def bytewise(chance: random.Random, path: Path) -> str:
    """Spoil the bytes of a file, whatever they mean."""
    data = path.read_bytes()
    at = chance.randrange(len(data))
    to = min(len(data), at + chance.choice((1, 10, 100, 1000)))
    lines = data.splitlines(keepends=True)
    text = data.decode("utf-8", errors="replace")
    ways: dict[str, Callable[[], bytes]] = {
        "cut": lambda: data[:at],
        "without its begin": lambda: data[at:],
        "bit flipped": lambda: (
            data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]
        ),
        "byte changed": lambda: data[:at] + bytes([chance.randrange(256)]) + data[at + 1 :],
        "byte inserted": lambda: data[:at] + bytes([chance.randrange(256)]) + data[at:],
        "piece missing": lambda: data[:at] + data[to:],
        "piece zeroed": lambda: data[:at] + bytes(to - at) + data[to:],
        "zeros at the end": lambda: data + bytes(4096),
        "empty": lambda: b"",
        "white": lambda: b" \n\n",
        "noise": lambda: chance.randbytes(300),
        "UTF-16": lambda: text.encode("utf-16"),
        "UTF-32": lambda: text.encode("utf-32-be"),
        "BOM": lambda: b"\xef\xbb\xbf" + data,
        "Latin 1": lambda: "é".encode("latin-1") + data,
        "CRLF": lambda: data.replace(b"\n", b"\r\n"),
        "CR": lambda: data.replace(b"\n", b"\r"),
        "line twice": lambda: b"".join(lines[: at % len(lines) + 1] + lines[at % len(lines) :]),
        "line missing": lambda: b"".join(lines[: at % len(lines)] + lines[at % len(lines) + 1 :]),
        "lines reversed": lambda: b"".join(reversed(lines)),
        "twice": lambda: data + data,
        "glued": lambda: data.replace(b"\n", b"", 1),
        "two lines torn": lambda: data[:at].rstrip(b"\n") + b"\n" + data[at:],
        "of another kind": lambda: chance.choice(
            (b"\x89PNG\r\n\x1a\n", b"PK\x03\x04", b"root:x:0:0::/root:/bin/bash\n", b"%PDF-1.4")
        ),
        "deep": lambda: b"[" * DEEP,
    }
    word = chance.choice(list(ways))
    path.write_bytes(ways[word]())
    return f"{word} at {at}"


def jsonwise(chance: random.Random, path: Path, other: Path) -> str:
    """Spoil one value, one key, or one state of what a file of JSON (or of its lines) says."""
    many = path.suffix == ".jsonl"
    texts = path.read_text(encoding="utf-8").splitlines() if many else [path.read_text()]
    at = chance.randrange(len(texts))
    data = json.loads(texts[at])
    holder, key = _place(chance, data)
    value = holder[key]
    word = chance.choice(
        ("other value", "other value", "missing", "renamed", "of another", "nudged")
    )
    if isinstance(value, str) and len(value) > 200:
        holder[key], word = _base64(chance, value)
    elif word == "missing":
        del holder[key]
    elif word == "renamed" and isinstance(holder, dict):
        holder[f"{key}_"] = holder.pop(key)
    elif word == "of another" and many and len(texts) > 1:
        texts[at], texts[at - 1] = texts[at - 1], texts[at]
        path.write_text("\n".join(texts) + "\n")
        return "lines exchanged"
    elif word == "nudged" and isinstance(value, int | float) and not isinstance(value, bool):
        holder[key] = chance.choice((value + 1, -value, value * 2, value + 0.5))
    else:
        holder[key] = chance.choice(ODD)
        if isinstance(holder[key], tuple):
            raw = holder[key][1]
            holder[key] = RAW
            texts[at] = json.dumps(data).replace(json.dumps(RAW), raw)
            path.write_text("\n".join(texts) + "\n")
            return f"line {at + 1}, {key}: {raw[:20]}"
    texts[at] = json.dumps(data)
    path.write_text("\n".join(texts) + "\n")
    there = key in holder if isinstance(holder, dict) else key < len(holder)
    return f"line {at + 1}, {key}: {word}: {str(holder[key])[:40] if there else ''!r}"


def _place(chance: random.Random, data: Any) -> tuple[Any, Any]:
    """Return a random place in JSON: what holds it, and the key or index."""
    places: list[tuple[Any, Any]] = []

    def walk(node: Any) -> None:
        items = node.items() if isinstance(node, dict) else enumerate(node)
        for key, value in items:
            places.append((node, key))
            if isinstance(value, dict | list) and value:
                walk(value)

    walk(data)
    return chance.choice(places)


def _base64(chance: random.Random, text: str) -> tuple[str, str]:
    array = np.frombuffer(base64.b64decode(text), dtype="<f8").copy()
    at = chance.randrange(len(array))

    def packed(changed: Any, kind: str = "<f8") -> str:
        return base64.b64encode(np.asarray(changed, dtype=kind).tobytes()).decode("ascii")

    def changed(value: float) -> str:
        array[at] = value
        return packed(array)

    ways: dict[str, Callable[[], str]] = {
        "letter": lambda: text[:at] + chance.choice("AZaz09+/=!é \n") + text[at + 1 :],
        "cut": lambda: text[: chance.randrange(len(text))],
        "NaN": lambda: changed(np.nan),
        "infinite": lambda: changed(np.inf),
        "number": lambda: changed(chance.choice((0.0, -1.0, 1e300, array[at] * 1.01))),
        "shorter": lambda: packed(array[:-1]),
        "longer": lambda: packed(np.append(array, 0.0)),
        "none": lambda: "",
        "single": lambda: packed(array, "<f4"),
    }
    word = chance.choice(list(ways))
    return ways[word](), f"base64: {word}"


def archived(chance: random.Random, path: Path) -> str:
    """Spoil an array of an archive, or its entry."""
    with np.load(path) as data:
        arrays = {name: data[name] for name in data}
    name = chance.choice(
        ("w", "w", "widths", "theta", "multipliers", "units", "sheets", "elements")
    )
    array = arrays[name]
    number = chance.choice((np.nan, np.inf, 0.0, -1.0, 1e300, 1e-300))
    one = array.astype(float).copy()
    if one.size:
        one[chance.randrange(len(one))] = number
    ways: dict[str, Callable[[], Any]] = {
        "complex": lambda: array.astype(complex),
        "objects": lambda: np.array([{"a": 1}] * max(len(array), 1), dtype=object),
        "texts": lambda: array.astype(str),
        "truth": lambda: array.astype(bool),
        "half": lambda: array.astype(np.float16),
        "other end": lambda: array.astype(">f8"),
        "whole": lambda: array.astype(np.int64),
        "floats": lambda: array.astype(float),
        "dates": lambda: array.astype(np.int64).astype("M8[s]"),
        "fields": lambda: np.zeros(len(array), dtype=[("a", float), ("b", int)]),
        "matrix": lambda: array[None],
        "column": lambda: array[:, None],
        "scalar": lambda: np.array(3.0),
        "none": lambda: array[:0],
        "shorter": lambda: array[:-1],
        "longer": lambda: np.append(array, array[-1:] if array.size else [1]),
        f"one {number}": lambda: one,
        "reversed": lambda: array[::-1],
        "many": lambda: np.full(max(len(array), 1), 10**9),
    }
    if chance.random() < 0.6:
        word = chance.choice(list(ways))
        arrays[name] = ways[word]()
        np.savez(path, **arrays)  # type: ignore[arg-type]
        return f"{name}: {word}"
    entries = {f"{key}.npy": _bytes(value) for key, value in arrays.items()}
    word = chance.choice(
        ("missing", "claims 1e12", "header", "no array", "bomb", "twice", "encrypted", "packed")
    )
    entry = f"{name}.npy"
    if word == "missing":
        del entries[entry]
    elif word == "claims 1e12":
        entries[entry] = _header("(1000000000000,)") + entries[entry][-8:]
    elif word == "header":
        entries[entry] = _header(
            chance.choice(("(-1,)", "(1e3,)", "()", "'x'", "(" * 200 + ")" * 200))
        )
    elif word == "no array":
        entries[entry] = chance.choice((b"", b"\x93NUMPY", b"text", b"\x93NUMPY\x09\x00aaaa"))
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED if word == "packed" else 0) as file:
        for key, value in entries.items():
            file.writestr(key, value)
        if word == "twice":
            with _quiet():
                file.writestr(entry, entries[entry][:-8])
    if word == "bomb":
        _bomb(path, entries, entry)
    if word == "encrypted":
        data = bytearray(path.read_bytes())
        where = data.find(b"PK\x01\x02")
        data[where + 8] |= 1
        path.write_bytes(bytes(data))
    return f"{name}: {word}"


def _bomb(path: Path, entries: dict[str, bytes], entry: str) -> None:
    """Write 300 MB of zeros, packed, in the place of an array."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        for key, value in entries.items():
            if key != entry:
                file.writestr(key, value)
        with file.open(entry, "w") as inner:
            inner.write(_header(f"({300_000_000 // 8},)"))
            for _ in range(300):
                inner.write(bytes(1_000_000))


def _quiet() -> Any:
    import warnings

    return warnings.catch_warnings(record=True)


def _bytes(array: Any) -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array(buffer, np.asarray(array), allow_pickle=False)
    return buffer.getvalue()


def _header(shape: str) -> bytes:
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}"
    text = text.ljust(-(-(len(text) + 11) // 64) * 64 - 11) + "\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode("ascii")


def odd_node(chance: random.Random, path: Path) -> str:
    """Put what is no file in the place of a file."""
    word = chance.choice(ODD_NODES)
    with suppress(FileNotFoundError):
        path.unlink()
    if word == "folder":
        path.mkdir()
    elif word == "fifo":
        os.mkfifo(path)
    elif word == "zeros":
        path.symlink_to("/dev/zero")
    elif word == "socket":
        here = os.getcwd()
        os.chdir(path.parent)  # names of sockets are short
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(path.name)
        os.chdir(here)
    elif word == "broken link":
        path.symlink_to(path.with_name("nowhere"))
    elif word == "loop":
        path.symlink_to(path)
    elif word == "5 GB":
        with open(path, "wb") as file:
            file.truncate(5 * 2**30)
    return word
