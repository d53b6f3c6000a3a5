"""What figures of a release depend on: versions of compilers and libraries, processor, date."""

from __future__ import annotations

import datetime
import re
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

PACKAGES = ("numpy", "scipy", "casadi")
COMPILERS = ("gcc", "gfortran")


def conditions() -> dict[str, Any]:
    """Return the processor's model, the day, and versions of packages and compilers found."""
    return {
        "model": _model(),
        "date": datetime.date.today().isoformat(),
        "tools": {name: found for name in PACKAGES if (found := _package(name))}
        | {name: found for name in COMPILERS if (found := _compiler(name))},
    }


def _package(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def _compiler(name: str) -> str:
    try:
        done = subprocess.run([name, "--version"], capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return (re.findall(r"\d+\.\d+\.\d+", done.stdout) or [""])[0]


def _model() -> str:
    """Return the name of the processor, where Linux tells it."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return ""
    return (re.findall(r"model name\s*:\s*(.*)", text) or [""])[0]
