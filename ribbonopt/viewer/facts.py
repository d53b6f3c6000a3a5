"""What is said of a ribbon beside its picture: numbers with their bars, warnings, what it is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ribbonopt.output.digits import SMALL, digits, upwards

ROUNDED = 1e-12  # of the largest component: what is zero but for rounding


def numbers_of(summary: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return names and numbers of a summary, each with its bar."""
    bars, si = summary.get("error_estimate") or {}, _si(summary)
    units = {"n0": " N", "m0": " N m", "energy": " J"} if si else {}
    names = {"energy": "energy", "n0": "force n(0), lab frame", "m0": "moment m(0), lab frame"}
    found = [
        (label, _number(summary.get(name), bars.get(name), units.get(name, "")))
        for name, label in names.items()
    ]
    recorded, errors = summary.get("recorded") or {}, summary.get("recorded_error") or {}
    found += [(name, _number(value, errors.get(name), "")) for name, value in recorded.items()]
    twists = summary.get("half_twists")
    return [*found, *([("half twists", str(twists))] if twists is not None else [])]


def about_of(summary: Mapping[str, Any]) -> str:
    """Return a line on the law and the units of a result."""
    law = dict(summary.get("law") or {})
    kind = law.pop("type", "")
    said = ", ".join(f"{name} = {_plain(v)}" for name, v in law.items() if v is not None)
    parts = [f"law {kind}" + (f" ({said})" if said else "")] if kind else []
    return ", ".join([*parts, f"units {summary['units']}"] if summary.get("units") else parts)


def status_of(summary: Mapping[str, Any]) -> str:
    """Return in words how a solve ended."""
    word = str(summary.get("status", "")).replace("_", " ")
    return "verified" if summary.get("verified") else f"{word}: {summary.get('message', '')}"


def number_of(value: object) -> str:
    """Return a value of a row as it is read: numbers to six digits, words as they are."""
    if value is None:
        return "not known"
    return f"{value:.6g}" if isinstance(value, int | float) else str(value)


def vector_of(parts: Sequence[float]) -> str:
    """Return a vector as it is read, components that are but rounding as 0."""
    most = max(map(abs, parts))
    return f"({', '.join(number_of(v if abs(v) > ROUNDED * most else 0) for v in parts)})"


def _number(value: Any, bar: float | None, unit: str) -> str:
    values = list(value) if isinstance(value, Sequence) else [value]
    small = 0 < max(abs(v or 0.0) for v in values) < SMALL
    text = ", ".join(digits(v, bar, small) for v in values)
    text = f"({text})" if isinstance(value, Sequence) else text
    return f"{text}{unit} " + ("± not known" if bar is None else f"± {upwards(bar)}")


def _si(summary: Mapping[str, Any]) -> bool:
    return str(summary.get("units", "")).startswith("SI")


def _plain(value: Any) -> str:
    if isinstance(value, Sequence) and not isinstance(value, str):
        return f"({', '.join(map(_plain, value))})"
    return value if isinstance(value, str) else f"{value:g}"
