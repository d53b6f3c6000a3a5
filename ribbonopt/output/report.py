"""The readable report of a solve, from its summary: text only, printed by the command line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ribbonopt.checks.phase_words import phase_words

from .digits import SMALL, digits, upwards


def report(summary: Mapping[str, Any], *, steps: bool = True) -> str:
    """Return the report of a summary; digits beyond the estimated error are left out.

    Without `steps` where they are told apart, and what was skipped.
    """
    s = summary
    said = {k: v for k, v in s["law"].items() if k != "type" and v is not None}
    law = ", ".join(f"{k} = {_plain(v)}" for k, v in said.items())
    head = f"{s['name']}: {s['status'].replace('_', ' ')}"
    lines = [
        head + (_verified(s) if s["verified"] else f"\n  {s['message']}"),
        *(f"  note: {what}" for what in (*s["given_up"], *s["fell_back"])),
        f"  law {s['law']['type']}{f' ({law})' if law else ''}, {s['formulation']} formulation, "
        f"{s['states']} states",
        f"  {s['transcription']}, {s['scheme']} {s['degree']} on {s['intervals']} intervals, "
        f"{s['unknowns']} unknowns",
        "",
    ]
    errors = s["error_estimate"]
    lines += [
        _row("force n(0), lab frame", s["n0"], errors["n0"]),
        _row("moment m(0), lab frame", s["m0"], errors["m0"]),
        _row("strains u(0), directors", s["u0"], errors["u0"]),
        *(["  (force and moment recovered from the costates)"] * (s["loads_from"] == "costates")),
        _row("energy", s["energy"], errors["energy"]),
        *_potential(s),
        _row("H(0)" if _varies(s) else "invariant H(0)", s["H0"], errors["H0"]),
        *(_row(name, value, s["recorded_error"][name]) for name, value in s["recorded"].items()),
        *_symmetry(s),
        *_acting(s),
        *_phases(s),
        "",
        f"  drift along the ribbon   {_drifts(s['invariant_drift'])}",
        f"  conditions hold to {_short(s['worst_condition'])}, equations between the stages to "
        f"{_short(s['residual_between_nodes'])} (relative), "
        f"the law to {_short(s['law_residual'])}",
        *([f"  {_steps(s['path'])}", f"  {_times(s['timings'])}"] if steps else []),
        *_others(s["equilibria"]),
        f"  units {s['units']}",
        *(f"  warning: {text}" for text in s["warnings"]),
        *(["  skipped:", *(f"    {reason}" for reason in s["skipped"])] if steps else []),
    ]
    return "\n".join(lines)


def _symmetry(summary: Mapping[str, Any]) -> list[str]:
    """Lines on all of the ribbon, where a piece of it is solved."""
    all_of, bar = summary.get("symmetry"), summary["error_estimate"]["energy"]
    if all_of is None:
        return []
    count, length = all_of["pieces"], f"{all_of['length']:.6g}"
    words = f"1/{count} of the {all_of['of']} is solved, symmetry gives the rest"
    energy = _row("energy of all of it", all_of["energy"], None if bar is None else count * bar)
    return [f"  {words} (length {length} in all)", energy]


def _varies(summary: Mapping[str, Any]) -> bool:
    """Whether H is no invariant: loads or a law that varies change it."""
    drift = summary["invariant_drift"]
    return drift["orthonormality"] is not None and drift["H"] is None


def _potential(summary: Mapping[str, Any]) -> list[str]:
    """Lines on the potential and on what loads along the ribbon leave constant."""
    s, bar = summary, summary["error_estimate"]["potential"]
    lines = []
    if s["potential"] not in (None, s["energy"]):
        lines.append(_row("potential", s["potential"], bar))
    names = [name for name in s["conserved"] if name != "H"]
    return lines + [f"  {'invariant ' + name:<25}{s['conserved'][name]:.10g}" for name in names]


def _phases(s: Mapping[str, Any]) -> list[str]:
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


def _acting(s: Mapping[str, Any]) -> list[str]:
    """Lines on loads and on what supports and ends carry, where n(0) does not say all of it."""
    between = [r for r in s["reactions"] if not r["path"].startswith("boundary.")]
    if not s["loads"] and not between:
        return []
    unit = "N, N m, " if s["units"].startswith("SI") else ""
    lines = [f"  on the ribbon ({unit}lab frame):"]
    for load in s["loads"]:
        where = "in all" if load["at"] is None else f"at s = {load['at']:.6g}"
        lines.append(f"    {load['path']:<22} {_load(load)} {where}")
    for held in s["reactions"]:
        where = held["path"].removeprefix("boundary.")
        label = f"  carried at {where}" if where == held["path"] else f"  at the {where}"
        lines.append(_row(label, held["force"], held["error"]))
    return lines


def _load(load: Mapping[str, Any]) -> str:
    """Write the force and the moment of a load, but for one that is zero."""
    both = [(word, load[word]) for word in ("force", "moment") if any(load[word])]
    texts = []
    for word, vector in both or [("force", load["force"])]:
        numbers = ", ".join(digits(v, None, small=False) for v in vector)
        texts.append(f"({numbers})" if word == "force" else f"moment ({numbers})")
    return " and ".join(texts)


def _verified(s: Mapping[str, Any]) -> str:
    """Return the words of a verified answer: also that its bars could be known and are not."""
    unknown = None in s["error_estimate"].values() and s["loads_from"] != "costates"
    return ", verified" + (", its errors not known (see the warnings)" if unknown else "")


def _others(equilibria: Sequence[Mapping[str, Any]]) -> list[str]:
    """Lines on all equilibria found, where there are several."""
    if len(equilibria) == 1:
        return []
    told = [found.get("potential") for found in equilibria]
    worked = None not in told and told != [found["energy"] for found in equilibria]
    name = "potential" if worked else "energy"
    lines = [f"  {len(equilibria)} equilibria, by {name}; the first is the one above:"]
    for i, found in enumerate(equilibria, start=1):
        n = ", ".join(f"{v:.6g}" for v in found["n0"])
        m = ", ".join(f"{v:.6g}" for v in found["m0"])
        lines.append(
            f"    {i}: {name} {found[name]:.8g}, n(0) = ({n}), m(0) = ({m}), "
            f"from {found['starts']} starts"
        )
    return lines


def _row(label: str, value: float | Sequence[float] | None, error: float | None) -> str:
    values = value if isinstance(value, Sequence) else [value]
    small = 0 < max(abs(v or 0.0) for v in values) < SMALL
    numbers = ", ".join(digits(v, error, small) for v in values)
    text = f"({numbers})" if isinstance(value, Sequence) else numbers
    bar = "  +- not known" if error is None else f"  +- {upwards(error)}"
    return f"  {label:<25}{text}{bar}"


def _drifts(drift: Mapping[str, float | None]) -> str:
    words = {"n": "n", "n_dot_m": "n.m", "H": "H", "orthonormality": "orthonormality"}
    # Under loads less is conserved; without convergence nothing is known.
    known = {k: v for k, v in drift.items() if v is not None} or drift
    return ", ".join(f"{words.get(k, k)} {_short(v)}" for k, v in known.items())


def _plain(value: float | Sequence[float]) -> str:
    """Write a number of the scene, or a vector of them."""
    if isinstance(value, Sequence):
        return f"({', '.join(map(_plain, value))})"
    return f"{value:g}"


def _steps(path: Sequence[Mapping[str, Any]]) -> str:
    texts = []
    for step in path:
        count = f", {step['iterations']} iterations" if "iterations" in step else ""
        texts.append(f"{step['step']}{count} ({1e3 * step['seconds']:.1f} ms)")
    return "; ".join(texts)


def _times(timings: Mapping[str, float]) -> str:
    names = [k for k in timings if k != "total"]
    parts = ", ".join(f"{k} {1e3 * timings[k]:.1f}" for k in names)
    return f"time in ms: {parts}; total {1e3 * timings['total']:.1f}"


def _short(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.1e}"
