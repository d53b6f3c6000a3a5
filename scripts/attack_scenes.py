"""Scenes nobody would write: shipped ones with wild numbers, and with their structure broken.

    python scripts/attack_scenes.py --seed 1 --count 2000        # through load and check
    python scripts/attack_scenes.py --seed 1 --show 5            # print some mutants

`mutants` is deterministic. Numeric fields are read from the scene's dataclasses, so that a new one
is attacked without a word here. No outcome but a scene, or one of the package's own errors, is
right: all others are counted by kind.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from types import NoneType
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

from ribbonopt.scene import Scene
from ribbonopt.scene.schema.annotations import branches, hints, key_of, only_in_python
from ribbonopt.scene.yamlio import plain_yaml

MARK = "@number@"
CONFIGS = Path(__file__).parents[1] / "configs"
SECONDS, MEMORY = 20, 6 << 30  # of one mutant: more is a hang, or would be one elsewhere
SOLVING = 120  # seconds

REALS = (
    *("0", "-0.0", "1e-320", "-5e-324", "1e-308", "1e-200", "1e-160", "1e-100", "1e-30", "-1e-30"),
    *("1e-16", "1e-8", "0.5", "-1", "3", "1e3", "-1e3", "1e6", "1e9", "-1e9", "1e12", "1e15"),
    *("1e20", "-1e20", "1e30", "1e75", "1e100", "1e150", "1e155", "-1e155", "1e200", "1e300"),
    *("-1e308", "1.7976931348623157e308", "1e309", ".inf", "-.inf", ".nan", "9" * 30),
    *("9" * 308, "9" * 399, "9" * 400, "9" * 5000, "-" + "9" * 5000, "0x10", "0x" + "f" * 300),
    *("0x" + "f" * 5000, "0o7", "0o" + "7" * 6000, "1_000", "true", "null"),
    *('"2**(9**9)"', '"2**2**2**2**2**2"', '"1e200*1e200"', '"1e308*10-1e308*10"', '"1/1e-320"'),
    *('"(-1)**0.5"', '"exp(800)"', '"exp(-800)"', '"log(0)"', '"sqrt(-1)"', '"tan(pi/2)"'),
    *('"' + "(" * 60 + "1" + ")" * 60 + '"', '"' + "-" * 100 + '1"', '"1e155**2"', '"0**-1"'),
    *('"' + "1+" * 240 + '1"', '"sin(1e300)"', '"1e-200**2"', '"' + "9" * 400 + '"'),
    # numbers along the ribbon
    *('"s"', '"1 - s"', '"1/(s - 0.503)**2"', '"log(s)"', '"sqrt(s - 0.5)"', '"exp(1e3*s)"'),
    *('"1 + 0.1*sin(1e9*s)"', '"s**99"', '"0*s"', '{"s": [0, 1], "values": [1, 2]}'),
    *('{"s": [0, 0], "values": [1, 2]}', '{"s": [0, 1e-300, 1], "values": [1, -1e30, 1]}'),
    *('{"s": [], "values": []}', '{"file": "none.csv"}', '{"file": "/dev/zero"}', '{"file": ""}'),
    *('{"file": "attack.yaml"}', '{"file": "a\\u0000b"}', '{"s": [-9, 99], "values": [3, 0.5]}'),
)
WHOLES = (
    *(
        "0",
        "-1",
        "1",
        "2",
        "3",
        "7",
        "10",
        "64",
        "1000",
        "10000",
        "100000",
        "1000000",
        "1000000000",
    ),
    *("-1000000000", "2147483647", "2147483648", "4294967296", "9223372036854775807"),
    *("9223372036854775808", "18446744073709551616", "9" * 30, "9" * 399, "9" * 400, "9" * 5000),
    *("0x7fffffff", "0x" + "f" * 300, "0x" + "f" * 5000, "1.0", "1e3", ".inf", ".nan", "true"),
)
ODD = (
    *(None, True, "", "x", "\u2028", "auto", [], {}, [[]], [1, 2, 3], [0, 0, 0], {"x": 1}, 0, -1),
    *(1e300, "1 +", "d1(start)", "nan", {"type": "x"}, {"type": "sadowsky"}, [None] * 3, "9" * 500),
)
WORDS = ("lenght", "type", "x", "positon", "d4", "epsilon", "from", "../a", "null", "é", "a b")


class Mutant(NamedTuple):
    """One scene to try: what was done to it, its text, and overrides to load it with."""

    label: str
    text: str
    overrides: tuple[str, ...]


class Field(NamedTuple):
    """A numeric field of the schema: where it is, whether whole, and data that hold a number."""

    path: tuple[str, ...]
    whole: bool
    made: Any


def mutants(seed: int, count: int, folder: str | Path = CONFIGS) -> Iterator[Mutant]:
    """Yield mutants of the scenes in a folder, the same for the same seed."""
    rng = random.Random(seed)
    numeric = list(numeric_fields(Scene))
    named = sorted(Path(folder).glob("*.yaml"))
    texts = {path.stem: path.read_text(encoding="utf-8") for path in named}
    scenes = {name: plain_yaml(text, name) for name, text in texts.items()}
    kinds: list[Callable[..., Mutant]] = [_of_schema, _of_leaf, _structural, _textual]
    for _ in range(count):
        name = rng.choice(list(texts))
        data = json.loads(json.dumps(scenes[name]))
        (kind,) = rng.choices(kinds, (50, 20, 20, 10))
        label, text, overrides = kind(rng, numeric, data, texts[name])
        yield Mutant(f"{name}: {label}", text, overrides)


def numeric_fields(annotation: Any, path: tuple[str, ...] = ()) -> Iterator[Field]:
    """Yield every place of an annotation where a number may stand."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if only_in_python(annotation) or origin is Literal:
        return
    if origin is Annotated:
        yield from numeric_fields(arguments[0], path)
    elif annotation in (float, int):
        yield Field(path, annotation is int, MARK)
    elif branches(annotation):
        for branch in branches(annotation).values():
            yield from numeric_fields(branch, path)
    elif origin is tuple:
        items = [item for item in arguments if item is not Ellipsis]
        for index, item in enumerate(items):
            for found in numeric_fields(item, (*path, str(index))):
                yield found._replace(
                    made=[found.made if i == index else _sample(a) for i, a in enumerate(items)]
                )
    elif origin is dict:
        for found in numeric_fields(arguments[1], (*path, "a")):
            yield found._replace(made={"a": found.made})
    elif is_dataclass(annotation):
        needed = {
            key_of(member.name): _sample(hints(annotation)[key_of(member.name)])
            for member in fields(annotation)
            if (member.default is MISSING and member.default_factory is MISSING)
            or member.name == "type"
        }
        for key, inner in hints(annotation).items():
            for found in numeric_fields(inner, (*path, key)):
                yield found._replace(made={**needed, key: found.made})


def _sample(annotation: Any) -> Any:
    """Return plain data that an annotation takes."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _sample(arguments[0])
    if branches(annotation):
        return _sample(next(iter(branches(annotation).values())))
    if origin is Literal:
        return arguments[0]
    if origin is tuple:
        return [_sample(item) for item in arguments if item is not Ellipsis]
    if origin is dict:
        return {}
    if is_dataclass(annotation):
        members = [m for m in fields(annotation) if m.default is MISSING or m.name == "type"]
        return {
            key_of(m.name): _sample(hints(annotation)[key_of(m.name)])
            for m in members
            if m.default_factory is MISSING
        }
    return {float: 0.5, int: 2, bool: True, str: "a", NoneType: None}.get(annotation)


def _of_schema(rng: random.Random, numeric: list[Field], data: Any, text: str) -> Mutant:
    field = rng.choice(numeric)
    literal = rng.choice(WHOLES if field.whole and rng.random() < 0.8 else REALS)
    label = f"{'.'.join(field.path)} = {_short(literal)}"
    top = field.path[0]
    if rng.random() < 0.3:
        made = _merged(data.get(top), field.made[top])
        return Mutant(f"--set {label}", text, (f"{top}={_flow(made, literal)}",))
    return Mutant(label, _flow(_merged(data, {top: field.made[top]}), literal), ())


def _short(literal: str) -> str:
    return literal if len(literal) < 40 else f"{literal[:9]}... ({len(literal)} characters)"


def _merged(base: Any, over: Any) -> Any:
    if not (isinstance(base, dict) and isinstance(over, dict)):
        return over
    if base.get("type", over.get("type")) != over.get("type", base.get("type")):
        return over
    return {**base, **{key: _merged(base.get(key), value) for key, value in over.items()}}


def _flow(data: Any, literal: str = "", indent: int | None = None) -> str:
    return json.dumps(data, indent=indent).replace(f'"{MARK}"', literal)


def _of_leaf(rng: random.Random, numeric: list[Field], data: Any, text: str) -> Mutant:
    """Replace one number of the scene, or all that stand in one list."""
    numbers = [(h, k) for h, k in _places(data) if isinstance(h[k], int | float)]
    holder, key = rng.choice(numbers)
    literal = rng.choice(WHOLES if isinstance(holder[key], int) and rng.random() < 0.4 else REALS)
    label = f"{key} {holder[key]} -> {_short(literal)}"
    if isinstance(holder, list) and rng.random() < 0.3:
        holder[:] = [MARK] * len(holder)
    else:
        holder[key] = MARK
    return Mutant(label, _flow(data, literal, 1), ())


def _places(data: Any) -> list[tuple[Any, Any]]:
    keys = list(data) if isinstance(data, dict) else range(len(data))
    found = []
    for key in keys:
        found.append((data, key))
        if isinstance(data[key], dict | list):
            found += _places(data[key])
    return found


def _structural(rng: random.Random, numeric: list[Field], data: Any, text: str) -> Mutant:
    """Break the data: keys dropped, renamed or moved, values of other kinds, lists reshaped."""
    labels = []
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        holder, key = rng.choice(_places(data) or [({"name": 1}, "name")])
        value = holder[key]
        match rng.randrange(8):
            case 0:
                del holder[key]
                labels.append(f"drop {key}")
            case 1 | 2:
                holder[key] = json.loads(json.dumps(rng.choice(ODD)))
                labels.append(f"{key} -> {holder[key]!r:.30}")
            case 3 if isinstance(holder, dict):
                word = rng.choice(WORDS)
                holder[word] = holder.pop(key)
                labels.append(f"{key} renamed {word}")
            case 4 if isinstance(holder, list):
                holder.append(value)
                labels.append(f"{key} twice")
            case 5:
                holder[key] = [value]
                labels.append(f"{key} in a list")
            case 6:
                holder[key] = {rng.choice(WORDS): value}
                labels.append(f"{key} in a mapping")
            case _:
                other, place = rng.choice(_places(data))
                other[place] = json.loads(json.dumps(value))
                labels.append(f"{key} put at {place}")
    return Mutant("; ".join(labels), _flow(data, indent=rng.choice((None, 1))), ())


def _textual(rng: random.Random, numeric: list[Field], data: Any, text: str) -> Mutant:
    """Break the text: lines twice, gone, moved; characters; aliases; deep or long values."""
    lines = text.splitlines()
    index = rng.randrange(len(lines))
    match rng.randrange(9):
        case 0:
            lines.insert(index, lines[index])
            label = f"line {index + 1} twice"
        case 1:
            del lines[index]
            label = f"line {index + 1} gone"
        case 2:
            lines[index] = " " * rng.randrange(1, 5) + lines[index]
            label = f"line {index + 1} moved"
        case 3:
            sign = rng.choice("\t\0\x1b\u2028\ufeff:{}[]&*!|>%@`\"'#,-é")
            at = rng.randrange(len(lines[index]) + 1)
            lines[index] = lines[index][:at] + sign + lines[index][at:]
            label = f"{sign!r} in line {index + 1}"
        case 4:
            lines.append("record: {a: &a [1, *a]}")
            label = "alias of itself"
        case 5:
            bombs = [f"b{i}: &b{i} [{', '.join([f'*b{i - 1}'] * 9)}]" for i in range(1, 12)]
            lines += ["b0: &b0 [1, 1]", *bombs]
            label = "aliases that multiply"
        case 6:
            depth = rng.choice((60, 2000, 100_000))
            lines.append("parameters: " + "[" * depth + "]" * depth)
            label = f"depth {depth}"
        case 7:
            letters = rng.choice("x9(")
            lines.append("parameters: {a: " + letters * rng.choice((10_000, 1_000_000)) + "}")
            label = f"a million {letters!r}"
        case _:
            del lines[index:]
            label = f"torn at line {index + 1}"
    return Mutant(label, "\n".join(lines) + "\n", ())


def outcome(mutant: Mutant) -> str:
    """Load and check a mutant in this process; return what came of it, in a word."""
    from ribbonopt.errors import ConvergenceError, RibbonoptError
    from ribbonopt.pipeline.check import check_scene
    from ribbonopt.scene.yamlio import loads_scene

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            check_scene(loads_scene(mutant.text, "attack.yaml", mutant.overrides))
            return "valid"
        except ConvergenceError:
            return "out of reach"
        except RibbonoptError as error:
            return "refused" if len(str(error)) < 20_000 else "wrong: long message"
        except Warning as warning:
            return f"wrong: warning: {warning} {_where()}"
        except TimeoutError:
            return f"wrong: hang {_where()}"
        except Exception as error:
            return f"wrong: {type(error).__name__}: {error!s:.60} {_where()}"


def _where() -> str:
    frames = traceback.extract_tb(sys.exc_info()[2])
    own = [f for f in frames if "/ribbonopt/" in f.filename]
    return f"({Path(own[-1].filename).name}:{own[-1].lineno})" if own else ""


def _alarm(signum: int, frame: Any) -> None:
    raise TimeoutError


def check_all(seed: int, count: int, folder: Path) -> tuple[Counter[str], list[str]]:
    """Count outcomes of mutants; also return a line for each that is wrong."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGALRM, _alarm)
    counts: Counter[str] = Counter()
    wrong = []
    with tempfile.TemporaryFile() as chatter:
        os.dup2(chatter.fileno(), 2)
        for mutant in mutants(seed, count, folder):
            print(f"\r{mutant.label:.60}", end="", file=sys.stdout) if sys.stdout.isatty() else None
            begun, size = time.perf_counter(), os.fstat(2).st_size
            signal.alarm(SECONDS)
            found = outcome(mutant)
            signal.alarm(0)
            if os.fstat(2).st_size > size:
                found = "wrong: chatter on stderr"
            word = re.sub(r"\d{6,}", "N", found)
            counts[word] += 1
            seconds = time.perf_counter() - begun
            if found.startswith("wrong") or seconds > 5:
                wrong.append(f"{mutant.label}: {found} [{seconds:.1f} s]")
    return counts, wrong


def solved(text: str, overrides: tuple[str, ...], folder: str, verb: str = "solve") -> str:
    """Solve a scene in a process of its own; return what came of it, in a word."""
    scene = Path(folder, "attack.yaml")
    scene.write_bytes(text.encode("utf-8", "surrogatepass"))
    command = [sys.executable, "-m", "ribbonopt", verb, str(scene), "--quiet"]
    command += [word for override in overrides for word in ("--set", override)]
    try:
        done = subprocess.run(
            command, capture_output=True, timeout=SOLVING, cwd=folder, preexec_fn=_limited
        )
    except subprocess.TimeoutExpired:
        return "wrong: hang"
    said = done.stderr.decode(errors="replace")
    if done.returncode not in (0, 2, 3) or "Traceback" in said:
        return f"wrong: exit {done.returncode}: {said.strip()[-150:]}"
    if done.stdout or (said and not said.startswith("ribbonopt: ")) or "Warning" in said:
        return f"wrong: chatter: {(done.stdout.decode(errors='replace') + said)[:150]}"
    return {0: "solved", 2: "refused", 3: "resists"}[done.returncode]


def _limited() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def solve_all(seed: int, count: int, folder: Path) -> tuple[Counter[str], list[str]]:
    """Solve the first so many mutants that are valid scenes; see `check_all`."""
    counts: Counter[str] = Counter()
    wrong = []
    with tempfile.TemporaryDirectory() as place:
        for mutant in mutants(seed, 1_000_000, folder):
            if len(mutant.text) > 100_000 or outcome(mutant) != "valid":
                continue
            begun = time.perf_counter()
            found = solved(mutant.text, mutant.overrides, place)
            seconds = time.perf_counter() - begun
            counts[found[:60]] += 1
            if found.startswith("wrong") or seconds > SOLVING / 2:
                wrong.append(f"{mutant.label}: {found} [{seconds:.1f} s]")
                print(" ", wrong[-1], flush=True)
            if sum(counts.values()) >= count:
                break
    return counts, wrong


def main() -> None:
    """Attack load and check, and print counts."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--folder", type=Path, default=CONFIGS)
    parser.add_argument("--show", type=int, default=0, metavar="N", help="print mutants only")
    parser.add_argument("--solve", action="store_true", help="solve those that are valid scenes")
    options = parser.parse_args()
    for mutant in mutants(options.seed, options.show, options.folder):
        print(mutant.label, mutant.overrides, mutant.text[:2000], sep="\n", end="\n\n")
    if options.show:
        return
    run = solve_all if options.solve else check_all
    counts, wrong = run(options.seed, options.count, options.folder)
    for line in [] if options.solve else wrong:
        print(" ", line)
    for word, number in counts.most_common():
        print(f"{number:8} {word}")


if __name__ == "__main__":
    main()
