"""Where the time of a solve went, and what it was spared: text only, for `solve --verbose`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

UNSAID = {
    "drawn": "pictures, and the import of what draws them (no --plot)",
    "written": "files (no --out)",
}


def steps_of(
    summary: Mapping[str, Any], *, drawn: bool, written: bool, judged: float | None = None
) -> str:
    """Return a table of the steps of a summary, one a line, and what was skipped.

    `drawn` and `written` say whether there are pictures and files. Steps on the way have their own
    seconds; what no step has is verification, bars and all between them. `judged` are the seconds
    that stability took once the answer was there, if that was asked.
    """
    timings, path = summary["timings"], summary["path"]
    build, total = timings.get("build", 0.0), timings["total"]
    between = total - build - sum(step["seconds"] for step in path)
    rows: list[tuple[str, int | None, float]] = []
    if "import" in timings:
        rows.append(("imports", None, timings["import"]))
    rows.append(("equations and functions, built before the first step", None, build))
    rows += [(step["step"], step.get("iterations"), step["seconds"]) for step in path]
    rows.append(("verification, bars, functions built on the way, and all else", None, between))
    if judged is not None:
        rows.append(("stability of the answer: second derivatives, elimination", None, judged))
    rows.append(("in all", None, total + timings.get("import", 0.0) + (judged or 0.0)))
    width = max(len(name) for name, _, _ in rows)
    lines = [f"  {'steps':<{width}}  iterations         ms"]
    for name, count, seconds in rows:
        times = "" if count is None else str(count)
        lines.append(f"  {name:<{width}}  {times:>10} {1e3 * max(seconds, 0.0):10.2f}")
    lines.append("  skipped, and why:")
    lines += [f"    {reason}" for reason in summary["skipped"]]
    done = {"drawn": drawn, "written": written}
    lines += [f"    {words}" for name, words in UNSAID.items() if not done[name]]
    return "\n".join(lines)
