"""Tables of the page of results, in Markdown: what `results_page.py` puts together."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from peer_contenders import OURS
from peer_settings import COLNEW
from results_quoted import QUOTED, QUOTED_BRANCH

ERRORS = (1e-4, 1e-6, 1e-9, 1e-12)
BEST = "ribbonopt, fixed mesh, no bar"
STATES = {"reduced": 13, "full": 18}
TO_BEAT = f"{COLNEW}, 13 states"
Row = dict[str, Any]


def conditions(found: dict[str, Any]) -> str:
    """Return machine, versions, load and date of every file, and who was missing."""
    rows = []
    for name, study in found.items():
        if "machine" not in study:
            continue
        timing = study.get("timing", {})
        before = timing.get("load_before", (study.get("load_before") or [None])[0])
        after = timing.get("load_after", (study.get("load_after") or [None])[0])
        loads = " to ".join(f"{load:.1f}" for load in (before, after) if load is not None)
        rounds = study.get("repeat") or study.get("turns") or study.get("seeds") or ""
        tools = ", ".join(f"{tool} {version}" for tool, version in study.get("tools", {}).items())
        machine = study["machine"]
        where = f"{study.get('model') or machine['processor']}, {machine['cpus']} cores"
        missing = ", ".join(study.get("missing", {})) or "nobody"
        versions = study.get("versions", {})
        python = versions.get("python") or versions.get("with kernel", {}).get("python", "")
        rows.append((name, study.get("date", ""), where, f"Python {python}, {tools}"))
        rows[-1] += (loads, str(rounds), missing)
    head = ("part", "date", "machine", "versions", "load", "rounds", "missing")
    return table(head, rows)


def leader(studies: dict[str, Any]) -> str:
    """Say who is the one to beat, what was told of it and what is measured here."""
    lines = [
        f"{TO_BEAT}, compiled, with analytic Jacobians and settings tuned to the answer; it gives"
        " no bar. ms of CPU (error)."
    ]
    rows = []
    for k, (name, study) in enumerate(studies.items()):
        for label, quotes in QUOTED.items():
            measured = [cell(best(measured_rows(study, label), error)) for error in ERRORS[1:]]
            told = ", ".join(f"{ms:g} ({error:.0e})" for ms, error in quotes[k])
            if told or label == TO_BEAT:
                rows.append((name, label, *measured, told))
    head = ("ribbon", "who", *(f"to {error:.0e}" for error in ERRORS[1:]))
    lines.append(table((*head, "quoted: another machine, quiet"), rows))
    lines += [verdict(name, study) for name, study in studies.items()]
    return "\n\n".join(lines)


def verdict(name: str, study: Any) -> str:
    """Return how ours with its bar compares with the one to beat, error by error."""
    said = []
    for error in ERRORS[1:]:
        ours, other = (
            best(measured_rows(study, w), error) for w in (f"{OURS}, 13 states", TO_BEAT)
        )
        if ours and other:
            ratio = ours["solve"] / other["solve"]
            said.append(f"to {error:.0e} {ratio:.1f} times as long")
    return f"{name}: ours with its bar takes " + ", ".join(said) + "." if said else ""


def ladder(study: Any) -> str:
    """Return the least CPU of every contender within each error."""
    names = list(dict.fromkeys(peer["name"] for peer in study["peers"]))
    ours = [f"{BEST}, {states} states" for states in STATES.values()]
    rows = []
    for name in [*ours, *sorted(names, key=lambda name: name.split(", ")[0] != OURS)]:
        cells = [cell(best(measured_rows(study, name), error)) for error in ERRORS]
        if any(cells):
            who, _, states = name.rpartition(", ")
            rows.append((who, states.split()[0], *cells))
    failures = [
        f"{p['name']} ({p['detail']}): {p['message']}" for p in study["peers"] if p["message"]
    ]
    lines = [
        f"Least CPU of one answer, ms (its error, against {study['truth']}). Empty: not reached by"
        " the settings tried.",
        table(("who", "states", *(f"to {error:.0e}" for error in ERRORS)), rows),
    ]
    if failures:
        lines.append("No answer: " + "; ".join(failures) + ".")
    return "\n\n".join(lines)


def orders(study: Any) -> str:
    """Return what the study itself says, as it says it."""
    return "\n".join(f"- {sentence}" for sentence in study["sentences"])


def steps(bars: dict[str, Row]) -> str:
    """Return what the parts of an answer cost."""
    rows = [
        (
            name,
            *(figures(row[key]) for key in ("ms", "minimum_ms", "build_ms")),
            f"{row['estimate']:.0e}",
            ", ".join(f"{what} {1e3 * seconds:.2f}" for what, seconds in row["steps"]),
        )
        for name, row in bars.items()
    ]
    return table(("case", "ms", "least", "build", "bar", "steps of the median run"), rows)


def compiled(study: Any) -> str:
    """Return ours and peers, case by case."""
    rows = []
    for name, row in study["rows"].items():
        for label, one in row["contenders"].items():
            told = QUOTED_BRANCH.get("ribbonopt" if label == "with kernel" else label)
            quoted = f"{told[0]} s ({told[1]:.0e})" if told and name == "branch" else ""
            error = f"{one['error']:.0e}" if "error" in one else ""
            bar = f"{one['bar']:.0e}" if "bar" in one else ""
            rows.append((name, label, figures(one["ms"]), error, bar, quoted))
    return table(("case", "who", "ms", "error", "bar", "quoted: another machine"), rows)


def noise(study: Any) -> str:
    """Return what came of starts with noise."""
    rows = []
    for row in study["noise"]:
        other = ", ".join(f"{count} {what}" for what, count in row["not_found"].items())
        gap = "" if row["gap_max"] is None else f"{row['gap_max']:.0e}"
        times = figures(row["ms_median"]), figures(row["ms_max"])
        level, found = f"{row['level']:.0%}", f"{row['found']} of {row['seeds']}"
        rows.append((row["scene"], row["method"], level, found, other, *times, gap))
    lines = [
        "Every number of the start changed by up to a share of itself. `gap`: largest mismatch of"
        " the answers and an independent integration of them.",
        table(("ribbon", "method", "noise", "found", "else", "median ms", "most", "gap"), rows),
    ]
    return "\n\n".join(lines)


def measured_rows(study: Any, name: str) -> list[Row]:
    """Return the rows of a contender that have an answer: a peer's, or the best pairs of ours."""
    if name.startswith(BEST):
        pairs = [row | {"detail": f"{row['pair']}"} for row in study["rows"] if row["verified"]]
        found = [row for row in pairs if name.endswith(f"{STATES[row['states']]} states")]
    else:
        found = [row for row in study["peers"] if row["name"] == name]
    return [row for row in found if row["solve"] is not None and row["error"] is not None]


def best(rows: Iterable[Row], error: float) -> Row | None:
    """Return the quickest row within an error."""
    return min((r for r in rows if r["error"] <= error), key=lambda r: r["solve"], default=None)


def cell(row: Row | None) -> str:
    """Return milliseconds and error of a row."""
    return "" if row is None else f"{figures(1e3 * row['solve'])} ({row['error']:.0e})"


def figures(ms: float) -> str:
    """Return milliseconds with as many digits as mean something."""
    return f"{ms:.0f}" if ms >= 10 else f"{ms:.2g}"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)
