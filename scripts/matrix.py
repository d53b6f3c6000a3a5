#!/usr/bin/env python3
"""Run the tests on each Python that is here, with the oldest and the newest dependencies.

    scripts/matrix.py                                         # the quick suite, everything
    scripts/matrix.py --python 3.10 --dependencies oldest tests/unit tests/cli
    scripts/matrix.py --corners tests/unit tests/cli          # oldest of both, newest of both
    scripts/matrix.py --dry-run                               # only which versions are taken

Each pair gets a virtual environment from nothing, made by uv (`pip install -e '.[dev]'` has it).
Which Pythons, the classifiers of `pyproject.toml` say; what is oldest, its dependencies say: of
each, the oldest version they admit that has a wheel for that Python. Nothing is written twice.
Exit status 1 if a pair failed, or a Python that was asked for is not here.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
RESOLUTIONS = {"oldest": "lowest-direct", "newest": "highest"}
#: dependencies whose versions are told in the table
TOLD = ("casadi", "numpy", "matplotlib", "pyyaml", "pytest")


class Pair(NamedTuple):
    """What one line of the table says."""

    python: str
    dependencies: str
    outcome: str
    seconds: float = 0
    versions: tuple[str, ...] = ("",) * len(TOLD)
    failed: bool = False


def supported() -> list[str]:
    """Return the versions of Python that pyproject.toml names, as in `3.10`."""
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    return re.findall(r'"Programming Language :: Python :: (3\.\d+)"', text)


def candidates(version: str) -> Iterator[Path]:
    """Yield where a Python of that version may be: on the path, or of pyenv."""
    for folder in os.get_exec_path():
        yield Path(folder, f"python{version}")
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    yield from sorted(pyenv.glob(f"versions/{version}.*/bin/python"), reverse=True)


def found(version: str) -> Path | None:
    """Return the first Python of that version that starts (stand-ins of pyenv may not)."""
    for path in candidates(version):
        if shutil.which(path):
            done = subprocess.run([path, "-c", ""], capture_output=True, check=False)
            if done.returncode == 0:
                return path
    return None


def uv(*arguments: object) -> str:
    """Run uv and return what it prints; RuntimeError with what it says if it fails."""
    beside = str(Path(sys.executable).parent)
    program = shutil.which("uv", path=os.pathsep.join([beside, *os.get_exec_path()]))
    if program is None:
        sys.exit("scripts/matrix.py: uv is not here; `pip install uv`, or `pip install '.[dev]'`")
    command = [program, *map(str, arguments), "--quiet", "--no-python-downloads"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def requirements(version: str, dependencies: str) -> str:
    """Return the version of each package, `name==version` a line, for one pair."""
    return uv(
        *("pip", "compile", "pyproject.toml", "--extra", "test", "--python-version", version),
        *("--resolution", RESOLUTIONS[dependencies], "--only-binary", ":all:"),
        *("--no-header", "--no-annotate"),
    )


def told(pins: str) -> tuple[str, ...]:
    """Return the versions of the dependencies that the table tells."""
    versions = dict(line.split(";")[0].strip().split("==") for line in pins.splitlines())
    return tuple(versions[name] for name in TOLD)


def tested(python: Path, pins: str, tests: Sequence[str]) -> tuple[int, str]:
    """Run the tests in an environment of its own; return the exit status and the last line."""
    with tempfile.TemporaryDirectory(prefix="ribbonopt-matrix-") as folder:
        listed, new = Path(folder, "requirements.txt"), Path(folder, "venv")
        listed.write_text(pins, encoding="utf-8")
        uv("venv", new, "--python", python)
        inside = new / ("Scripts" if os.name == "nt" else "bin") / "python"
        uv("pip", "install", "--python", inside, "--only-binary", ":all:", "-r", listed)
        # Editable: tests run on the sources, and there the kernel is built.
        uv("pip", "install", "--python", inside, "--no-deps", "--editable", ".")
        command = [inside, "-m", "pytest", "-p", "no:cacheprovider", *tests]
        with subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            last = ""
            for line in process.stdout:
                print("   ", line, end="", flush=True)
                last = line.strip() or last
        return process.returncode, last.strip("= ")


def run(python: Path | None, version: str, dependencies: str, tests: Sequence[str] | None) -> Pair:
    """Return the line of one pair; without tests or without that Python, what it would take."""
    begun = time.monotonic()
    try:
        pins = requirements(version, dependencies)
        if python is None or tests is None:
            outcome = "not run" if python else "no such Python here"
            return Pair(version, dependencies, outcome, 0, told(pins))
        print(f"Python {version}, {dependencies} dependencies: {' '.join(pins.split())}")
        status, last = tested(python, pins, tests)
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return Pair(version, dependencies, str(error).splitlines()[-1], failed=True)
    seconds = time.monotonic() - begun
    return Pair(version, dependencies, last, seconds, told(pins), failed=status != 0)


def table(pairs: Sequence[Pair]) -> str:
    """Return the table of what came of each pair."""
    rows = [("python", "dependencies", *TOLD, "minutes", "outcome")]
    rows += [
        (p.python, p.dependencies, *p.versions, f"{p.seconds / 60:.1f}", p.outcome) for p in pairs
    ]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(n) for cell, n in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def main() -> int:
    """Run what is asked for, print the table, return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--python", action="append", choices=supported(), help="repeatable")
    parser.add_argument("--dependencies", choices=RESOLUTIONS, help="both unless said")
    parser.add_argument("--corners", action="store_true", help="oldest both, and newest both")
    parser.add_argument("--dry-run", action="store_true", help="tell the versions, run no test")
    parser.add_argument("tests", nargs="*", help="of pytest; all quick tests unless said")
    asked, more = parser.parse_known_args()
    tests = None if asked.dry_run else [*asked.tests, *more]
    pythons = {version: found(version) for version in asked.python or supported()}
    missing = [version for version, python in pythons.items() if python is None]
    kinds = [asked.dependencies] if asked.dependencies else list(RESOLUTIONS)
    wanted = [(version, which) for version in pythons for which in kinds]
    if asked.corners:
        here = [version for version in pythons if version not in missing]
        wanted = [(here[0], "oldest"), (here[-1], "newest")]
    pairs = [run(pythons[version], version, which, tests) for version, which in wanted]
    print(table(pairs))
    return int(any(pair.failed for pair in pairs) or bool(asked.python and missing))


if __name__ == "__main__":
    sys.exit(main())
