"""The long report of a solve, from its summary: text only, printed by `solve --verbose`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from .lines import (
    acting,
    head,
    law,
    loads_and_strains,
    others,
    phases,
    recorded,
    row,
    stability,
    symmetry,
)


def report(summary: Mapping[str, Any], *, steps: bool = True, verdict: str = "") -> str:
    """Return the report of a summary; digits beyond the estimated error are left out.

    Without `steps` where they are told apart, and what was skipped. `verdict` is on stability.
    """
    s, bars = summary, summary["error_estimate"]
    lines = [
        *head(s),
        f"  {law(s)}, {s['formulation']} formulation, {s['states']} states",
        f"  {s['transcription']}, {s['scheme']} {s['degree']} on {s['intervals']} intervals, "
        f"{s['unknowns']} unknowns",
        "",
        *loads_and_strains(s),
        row("energy", s["energy"], bars["energy"]),
        *_potential(s),
        row("H(0)" if _varies(s) else "invariant H(0)", s["H0"], bars["H0"]),
        *recorded(s),
        *symmetry(s),
        *acting(s),
        *phases(s),
        *stability(verdict),
        "",
        f"  drift along the ribbon   {_drifts(s['invariant_drift'])}",
        f"  conditions hold to {_short(s['worst_condition'])}, equations between the stages to "
        f"{_short(s['residual_between_nodes'])} (relative), "
        f"the law to {_short(s['law_residual'])}",
        *([f"  {_steps(s['path'])}", f"  {_times(s['timings'])}"] if steps else []),
        *others(s["equilibria"], s.get("search")),
        f"  units {s['units']}",
        *(f"  warning: {text}" for text in s["warnings"]),
        *(["  skipped:", *(f"    {reason}" for reason in s["skipped"])] if steps else []),
    ]
    return "\n".join(lines)


def _varies(summary: Mapping[str, Any]) -> bool:
    """Whether H is no invariant: loads or a law that varies change it."""
    drift = summary["invariant_drift"]
    return drift["orthonormality"] is not None and drift["H"] is None


def _potential(summary: Mapping[str, Any]) -> list[str]:
    """Lines on the potential and on what loads along the ribbon leave constant."""
    s, bar = summary, summary["error_estimate"]["potential"]
    lines = []
    if s["potential"] not in (None, s["energy"]):
        lines.append(row("potential", s["potential"], bar))
    names = [name for name in s["conserved"] if name != "H"]
    return lines + [f"  {'invariant ' + name:<25}{s['conserved'][name]:.10g}" for name in names]


def _drifts(drift: Mapping[str, float | None]) -> str:
    words = {"n": "n", "n_dot_m": "n.m", "H": "H", "orthonormality": "orthonormality"}
    # Under loads less is conserved; without convergence nothing is known.
    known = {k: v for k, v in drift.items() if v is not None} or drift
    return ", ".join(f"{words.get(k, k)} {_short(v)}" for k, v in known.items())


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
