"""Lines of a report, from the summary of a solve: text, digit by digit what the bars leave.

Numbers at the start in the units of the scene, vectors in the lab frame but strains.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ribbonopt.checks.phase_words import phase_words

from .digits import SMALL, digits, upwards

Summary = Mapping[str, Any]


def head(s: Summary) -> list[str]:
    """Return what came out: verified or not and then why, and notes of what was tried before."""
    name = f"{s['name']}: {s['status'].replace('_', ' ')}"
    said = [name + _verified(s)] if s["verified"] else [name, f"  {s['message']}"]
    return said + [f"  note: {what}" for what in (*s["given_up"], *s["fell_back"])]


def law(s: Summary) -> str:
    """Return the law and its numbers."""
    said = {k: v for k, v in s["law"].items() if k != "type" and v is not None}
    numbers = ", ".join(f"{k} = {_plain(v)}" for k, v in said.items())
    return f"law {s['law']['type']}{f' ({numbers})' if numbers else ''}"


def loads_and_strains(s: Summary) -> list[str]:
    """Return rows of force, moment and strains at the start."""
    bars = s["error_estimate"]
    return [
        row("force n(0), lab frame", s["n0"], bars["n0"]),
        row("moment m(0), lab frame", s["m0"], bars["m0"]),
        row("strains u(0), directors", s["u0"], bars["u0"]),
        *(["  (force and moment recovered from the costates)"] * (s["loads_from"] == "costates")),
    ]


def recorded(s: Summary) -> list[str]:
    """Return rows of what the scene records."""
    return [row(name, value, s["recorded_error"][name]) for name, value in s["recorded"].items()]


def stability(verdict: str) -> list[str]:
    """Return a row of what stability was found to be; none where it was not asked."""
    return [f"  {'stability':<25}{verdict}"] if verdict else []


def symmetry(summary: Summary) -> list[str]:
    """Lines on all of the ribbon, where a piece of it is solved."""
    all_of, bar = summary.get("symmetry"), summary["error_estimate"]["energy"]
    if all_of is None:
        return []
    count, length = all_of["pieces"], f"{all_of['length']:.6g}"
    words = f"1/{count} of the {all_of['of']} is solved, symmetry gives the rest"
    energy = row("energy of all of it", all_of["energy"], None if bar is None else count * bar)
    return [f"  {words} (length {length} in all)", energy]


def acting(s: Summary) -> list[str]:
    """Lines on loads and on what supports and ends carry, where n(0) does not say all of it."""
    if not s["loads"] and not _between(s):
        return []
    unit = "N, N m, " if s["units"].startswith("SI") else ""
    lines = [f"  on the ribbon ({unit}lab frame):"]
    for load in s["loads"]:
        where = "in all" if load["at"] is None else f"at s = {load['at']:.6g}"
        lines.append(f"    {load['path']:<22} {_load(load)} {where}")
    return lines + [_carried(held, "  ") for held in s["reactions"]]


def reactions(s: Summary) -> list[str]:
    """Return rows of what supports between the ends carry."""
    return [_carried(held) for held in _between(s)]


def _between(s: Summary) -> list[Mapping[str, Any]]:
    return [held for held in s["reactions"] if not held["path"].startswith("boundary.")]


def _carried(held: Mapping[str, Any], indent: str = "") -> str:
    where = held["path"].removeprefix("boundary.")
    label = f"carried at {where}" if where == held["path"] else f"at the {where}"
    return row(indent + label, held["force"], held["error"])


def _load(load: Mapping[str, Any]) -> str:
    """Write the force and the moment of a load, but for one that is zero."""
    both = [(word, load[word]) for word in ("force", "moment") if any(load[word])]
    texts = []
    for word, vector in both or [("force", load["force"])]:
        numbers = ", ".join(digits(v, None, small=False) for v in vector)
        texts.append(f"({numbers})" if word == "force" else f"moment ({numbers})")
    return " and ".join(texts)


def others(equilibria: Sequence[Mapping[str, Any]], search: str | None = None) -> list[str]:
    """Lines on all equilibria found, where there are several, or a `search` for all was made."""
    if len(equilibria) == 1 and not search:
        return []
    told = [found.get("potential") for found in equilibria]
    worked = None not in told and told != [found["energy"] for found in equilibria]
    name = "potential" if worked else "energy"
    count = "1 equilibrium" if len(equilibria) == 1 else f"{len(equilibria)} equilibria"
    lines = [f"  {count}, by {name}; the first is the one above:"]
    for i, found in enumerate(equilibria, start=1):
        n = ", ".join(f"{v:.6g}" for v in found["n0"])
        m = ", ".join(f"{v:.6g}" for v in found["m0"])
        more = _among_all(i, found) if "image_of" in found else [f"from {found['starts']} starts"]
        loads = f"n(0) = ({n}), m(0) = ({m})"
        lines.append(f"    {i}: " + ", ".join([f"{name} {found[name]:.8g}", loads, *more]))
    return lines + ([f"  {search}"] if search else [])


def _among_all(number: int, found: Mapping[str, Any]) -> list[str]:
    """Say what a search for all equilibria tells of one."""
    if found["image_of"] != number:
        return [f"an image of {found['image_of']}"]
    return [text for text in (found["stability"], found["symmetry"]) if text]


def row(label: str, value: float | Sequence[float] | None, error: float | None) -> str:
    """Return a number, or a vector of them, with its bar."""
    values = value if isinstance(value, Sequence) else [value]
    small = 0 < max(abs(v or 0.0) for v in values) < SMALL
    numbers = ", ".join(digits(v, error, small) for v in values)
    text = f"({numbers})" if isinstance(value, Sequence) else numbers
    bar = "  +- not known" if error is None else f"  +- {upwards(error)}"
    return f"  {label:<25}{text}{bar}"


def phases(s: Summary) -> list[str]:
    """Lines on half twists and on sign changes of m2, where there are any."""
    lines = []
    if s["half_twists"] is not None:
        lines.append(f"  half twists              {s['half_twists']}")
    if s["phases"]:
        at = ", ".join(f"{point:.6g}" for point in s["switch_points"])
        where = f"; switches at s = {at}" if at else " all along"
        words = phase_words(s["phases"], s.get("switch", "m2"))
        lines.append(f"  phases                   {words}{where}")
    return lines


def _verified(s: Summary) -> str:
    """Return the words of a verified answer: also that its bars could be known and are not."""
    unknown = None in s["error_estimate"].values() and s["loads_from"] != "costates"
    return ", verified" + (", its errors not known (see the warnings)" if unknown else "")


def _plain(value: float | Sequence[float]) -> str:
    """Write a number of the scene, or a vector of them."""
    if isinstance(value, Sequence):
        return f"({', '.join(map(_plain, value))})"
    return f"{value:g}"
